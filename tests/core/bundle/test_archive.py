"""The archive: deterministic when it is written, suspicious when it is read."""

from __future__ import annotations

import stat
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.bundle import archive as a
from crowdbot.core.bundle.archive import open_archive
from crowdbot.core.bundle.manifest import MANIFEST
from crowdbot.errors import InputError
from tests.core.bundle.made_up_runs import make_bundle, rewrite


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_bundle(tmp_path_factory.mktemp("bundle"))


@pytest.mark.slow
def test_the_same_runs_give_the_same_bytes(tmp_path: Path) -> None:
    one = make_bundle(tmp_path, name="one.cbz").read_bytes()
    assert make_bundle(tmp_path, name="two.cbz").read_bytes() == one
    assert not list(tmp_path.glob("*.part"))


def test_every_member_is_read_back(bundle: Path) -> None:
    with open_archive(bundle) as archive:
        assert archive.names == set(archive.manifest.members)
        for name in archive.names:
            archive.check(name)
        assert len([n for n in archive.names if n.endswith("scores.csv")]) == 6


def test_a_changed_member_is_noticed(bundle: Path) -> None:
    name = next(n for n in zipfile.ZipFile(bundle).namelist() if n.endswith("scores.csv"))
    with open_archive(rewrite(bundle, {name: lambda c: c.replace(b"1.0", b"9.0", 1) + b"x"})) as x:
        with pytest.raises(InputError, match="not what the manifest says; it was changed"):
            x.read(name)
        with pytest.raises(InputError, match="it was changed"):
            x.check(name)


@pytest.mark.parametrize(("name", "why"), [
    ("../evil.json", "it leads out of the folder"),
    ("/etc/evil.json", "it leads out of the folder"),
    ("runs/../../evil.json", "it leads out of the folder"),
    ("runs/./evil.json", "it leads out of the folder"),
    ("runs\\evil.json", "it leads out of the folder"),
    ("runs/evil.py", "only .json, .yaml, .csv, .mcap, .weights belong into a bundle"),
    ("runs/e vil\n.json", "other characters"),
])  # fmt: skip
def test_names_that_lead_elsewhere_are_refused(bundle: Path, name: str, why: str) -> None:
    with pytest.raises(InputError, match=why), open_archive(rewrite(bundle, {}, {name: b"{}"})):
        pass


def test_links_are_refused(bundle: Path, tmp_path: Path) -> None:
    path = tmp_path / "link.cbz"
    path.write_bytes(bundle.read_bytes())
    info = zipfile.ZipInfo("link.json")
    info.create_system, info.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(path, "a") as file:
        file.writestr(info, "/etc/passwd")
    with pytest.raises(InputError, match="not a plain file"), open_archive(path):
        pass


def test_members_that_are_there_twice_are_refused(bundle: Path, tmp_path: Path) -> None:
    path = tmp_path / "twice.cbz"
    path.write_bytes(bundle.read_bytes())
    with warnings.catch_warnings(), zipfile.ZipFile(path, "a") as file:
        warnings.simplefilter("ignore")
        file.writestr("suite.lock.json", "{}")
    with pytest.raises(InputError, match="there twice"), open_archive(path):
        pass


def test_bombs_are_refused_unread(bundle: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bomb = rewrite(bundle, {}, {"bomb.csv": b"0" * (65 << 20)})
    assert bomb.stat().st_size < 1 << 20
    with pytest.raises(InputError, match=r"bomb.csv.*\.csv may have"), open_archive(bomb):
        pass
    monkeypatch.setattr(a, "_ALL_TEXTS", 10_000)
    with pytest.raises(InputError, match="when unpacked"), open_archive(bundle):
        pass
    monkeypatch.setattr(a, "_MOST", 3)
    with pytest.raises(InputError, match="at most 3"), open_archive(bundle):
        pass


def test_recordings_are_not_compressed_twice(bundle: Path) -> None:
    with (
        pytest.raises(InputError, match="not compressed again"),
        open_archive(rewrite(bundle, {}, {"runs/run.mcap": b"0" * 1000})),
    ):
        pass


@pytest.mark.parametrize(("change", "why"), [
    (lambda c: b"#!/bin/sh\n" + c, "10 bytes stand before the archive"),
    (lambda c: c + c, "bytes stand before the archive"),
    (lambda c: c + b"<html>", "something after the archive"),
    (lambda c: c[:-2] + b"\5\0hello", "something after the archive"),
])  # fmt: skip
def test_an_archive_that_is_another_file_too_is_refused(
    bundle: Path, tmp_path: Path, change: Callable[[bytes], bytes], why: str
) -> None:
    path = tmp_path / "both.cbz"
    path.write_bytes(change(bundle.read_bytes()))
    with pytest.raises(InputError, match=why), open_archive(path):
        pass


def test_a_bundle_in_place_of_runs_is_said_to_be_one(
    bundle: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is packed and checked, not checked."""
    before = bundle.read_bytes()
    assert cli.main(["bundle", "--check", str(bundle)]) == 2
    assert f"ROOT is a folder of runs. To check a bundle that is there: crowdbot verify {bundle}" \
        in capsys.readouterr().err  # fmt: skip
    assert bundle.read_bytes() == before


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04 but broken"])
def test_what_is_no_archive_is_said_to_be_none(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.cbz"
    path.write_bytes(content)
    with pytest.raises(InputError, match="is not a bundle"), open_archive(path):
        pass
    with pytest.raises(InputError, match="cannot be read"), open_archive(tmp_path / "none.cbz"):
        pass


@pytest.mark.parametrize(("text", "why"), [
    (b"[]", "not a manifest"), (b"{", "not a manifest"), (b"{}", "not a manifest: bundle"),
    (b'{"bundle": 99}', "format 99; this release reads 1: upgrade"),
    (b"\xff", "is damaged"), (b"[" * 100_000, "not a manifest"),
])  # fmt: skip
def test_manifests_that_are_none(bundle: Path, text: bytes, why: str) -> None:
    changed = rewrite(bundle, {MANIFEST: lambda _: text})
    with pytest.raises(InputError, match=why), open_archive(changed):
        pass


def test_an_archive_without_manifest(bundle: Path) -> None:
    with (
        pytest.raises(InputError, match=r"bundle\.json is missing"),
        open_archive(rewrite(bundle, {MANIFEST: lambda _: None})),
    ):
        pass


def test_a_flipped_byte_is_noticed(bundle: Path, tmp_path: Path) -> None:
    content = bytearray(bundle.read_bytes())
    content[len(content) // 2] ^= 0xFF
    path = tmp_path / "flipped.cbz"
    path.write_bytes(content)
    with pytest.raises(InputError):
        _check_all(path)


def _check_all(path: Path) -> None:
    with open_archive(path) as archive:
        for name in archive.names:
            archive.check(name)
