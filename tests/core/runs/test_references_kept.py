"""Recordings of calibration runs are read once, as long as they do not change."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.recording.recording import Recording
from crowdbot.core.runs import run as request
from crowdbot.core.runs.run import read_references
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import bits, random_run, write_run


def test_references_are_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, other, read = tmp_path / "a.mcap", tmp_path / "b.mcap", []
    write_run(path, random_run())
    write_run(other, random_run(n=20))

    def counted(file: Path) -> Recording:
        read.append(file)
        return Recording(file)

    monkeypatch.setattr(request, "Recording", counted)
    first = read_references({"robot_alone": path, "crowd_alone": other})
    again = read_references({"robot_alone": path})
    assert again.robot_alone is first.robot_alone
    assert again.crowd_alone is None
    assert len(read) == 2
    other.replace(path)
    changed = read_references({"robot_alone": path})
    assert bits(changed.robot_alone) == bits(first.crowd_alone)
    assert len(read) == 3


def test_a_reference_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"gone\.mcap"):
        read_references({"robot_alone": tmp_path / "gone.mcap"})
