"""Suggestions of files beside a path that does not exist."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.support.text_files import suggest_files


def test_the_nearest_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "planner.py").touch()
    (tmp_path / "planned").mkdir()
    assert suggest_files(tmp_path / "planer.py") == f"; did you mean '{tmp_path / 'planner.py'}'?"
    assert suggest_files(tmp_path / "other.yaml") == ""
    assert suggest_files(tmp_path / "nowhere" / "planner.py") == ""
