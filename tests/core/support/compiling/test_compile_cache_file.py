"""A stored function is read only if it is what was stored, by this user, under this name."""

from __future__ import annotations

import os
import pickle
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from numba.core import caching

from crowdbot.core.support.compiling import compile_cache_file, compile_cache_locator
from crowdbot.core.support.compiling.compile_cache_file import CheckedCacheFile

RAN: list[str] = []


@pytest.fixture(autouse=True)
def nothing_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compile_cache_file, "_REPORTED", set())


class Planted:
    def __reduce__(self) -> tuple[Any, ...]:
        return RAN.append, ("ran",)


def file_of(folder: Path, name: str, stamp: str = "new") -> CheckedCacheFile:
    return CheckedCacheFile(str(folder), name, stamp)  # type: ignore[no-untyped-call]


def replaced(path: Path, content: bytes) -> None:
    path.write_bytes(content)


def one_bit(path: Path) -> None:
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 2] ^= 1
    replaced(path, bytes(raw))


def fifo(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def of_the_other(path: Path) -> None:
    shutil.copy(path.with_name(path.name.replace("mine", "other")), path)


DAMAGES: list[Callable[[Path], None]] = [
    lambda path: replaced(path, b""),
    lambda path: replaced(path, path.read_bytes()[:4]),
    lambda path: os.truncate(path, 1 << 40),
    lambda path: path.chmod(0o666),
    lambda path: replaced(path, pickle.dumps(Planted())),
    one_bit, fifo, folder, of_the_other,
]  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("ending", ["nbi", "1.nbc"])
def test_what_was_not_stored_is_not_read(
    ending: str, damage: Callable[[Path], None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, other = file_of(tmp_path, "mine"), file_of(tmp_path, "other")
    mine.save("key", "mine")
    other.save("key", "other")
    assert mine.load("key") == "mine"
    path = tmp_path / f"mine.{ending}"
    damage(path)
    assert mine.load("key") is None
    assert RAN == []
    assert f"{path}: was cut or changed" in capsys.readouterr().err
    mine.save("key", "again")  # nothing is raised where it cannot be stored
    assert mine.load("key") == (None if path.is_dir() else "again")
    assert capsys.readouterr().err == ""


def test_data_of_an_earlier_time_are_not_read(tmp_path: Path) -> None:
    """A process that is ended between two files leaves such data."""
    file_of(tmp_path, "mine", "old").save("key", "old")
    shutil.copy(tmp_path / "mine.1.nbc", tmp_path / "kept")
    file_of(tmp_path, "mine").save("key", "new")
    assert file_of(tmp_path, "mine", "old").load("key") is None
    shutil.copy(tmp_path / "kept", tmp_path / "mine.1.nbc")
    assert file_of(tmp_path, "mine").load("key") is None


def test_the_index_is_written_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = file_of(tmp_path, "mine")
    mine.save("key", 1)
    monkeypatch.setattr(mine, "_save_index", lambda _: None)
    mine.save("second", 2)
    assert (mine.load("key"), mine.load("second")) == (1, None)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files to others")
def test_a_file_of_another_user_is_not_read(tmp_path: Path) -> None:
    mine = file_of(tmp_path, "mine")
    mine.save("key", 1)
    os.chown(tmp_path / "mine.1.nbc", 1234, 1234)
    assert mine.load("key") is None


def test_functions_of_plugins_are_checked_as_well() -> None:
    assert compile_cache_locator.__name__ in os.environ["NUMBA_CACHE_LOCATOR_CLASSES"]
    assert caching.IndexDataCacheFile is CheckedCacheFile
