"""The file that was meant is among those beside the path."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.support.near_files import near_files


def test_the_nearest_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "planner.py").touch()
    (tmp_path / "planned").mkdir()
    assert near_files(tmp_path / "planer.py") == f"; did you mean '{tmp_path / 'planner.py'}'?"
    assert near_files(tmp_path / "other.yaml") == ""
    assert near_files(tmp_path / "nowhere" / "planner.py") == ""
