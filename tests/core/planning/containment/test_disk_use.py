"""Limits of a planner's folder."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from crowdbot.core.planning.containment import disk_use
from crowdbot.core.planning.containment.disk_use import DiskUse
from crowdbot.core.planning.containment.scratch import remove_scratch


@pytest.fixture
def shrinks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Free bytes and files of the file system become less with each look."""
    left = iter(range(100, 0, -1))
    monkeypatch.setattr(disk_use, "_free", lambda _: (next(left) << 40,) * 2)
    monkeypatch.setattr(disk_use, "MOST_BYTES", 1 << 20)
    monkeypatch.setattr(disk_use, "MOST_FILES", 20)


@pytest.mark.usefixtures("shrinks")
def test_what_others_write_is_not_its_fault(tmp_path: Path) -> None:
    (tmp_path / "some").write_bytes(bytes(1000))
    use = DiskUse(str(tmp_path))
    assert use.excess() == use.excess() == ""


@pytest.mark.usefixtures("shrinks")
def test_large_folders_are_named(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "large").write_bytes(os.urandom(2 << 20))
    assert "it wrote more than 0 GiB to its folder" in DiskUse(str(tmp_path)).excess()


@pytest.mark.usefixtures("shrinks")
def test_many_files_are_named(tmp_path: Path) -> None:
    for number in range(30):
        (tmp_path / str(number)).touch()
    assert "it made more than 20 files" in DiskUse(str(tmp_path)).excess()


@pytest.mark.usefixtures("shrinks")
def test_folders_below_the_longest_path_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(disk_use, "_LONGEST", len(str(tmp_path)) + 10)
    (tmp_path / "x" / ("y" * 20)).mkdir(parents=True)
    assert "cannot be looked into" in DiskUse(str(tmp_path)).excess()


def test_a_small_change_is_not_looked_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    use = DiskUse(str(tmp_path))
    monkeypatch.setattr(disk_use, "_too_much", lambda _: "looked")
    assert use.excess() == ""


def test_folders_without_rights_are_deleted(tmp_path: Path) -> None:
    closed = tmp_path / "scratch" / "closed"
    closed.mkdir(parents=True)
    (closed / "file").touch()
    closed.chmod(0o300)
    remove_scratch(str(tmp_path / "scratch"))
    assert not closed.parent.exists()
