"""Lines about responses to a robot in the head of a report."""

from __future__ import annotations

from crowdbot.core.realism.near_robots.known import known, response_lines
from crowdbot.core.realism.near_robots.responses import KINDS


def test_all_kinds_are_known_and_lie_between_floor_and_ceiling() -> None:
    assert sorted(known()) == sorted(KINDS)
    assert all(row["floor"] < row["score"] < row["ceiling"] for row in known().values())


def test_a_line_for_each_kind() -> None:
    lines = response_lines(
        ["giving_way, late_fraction 0, yield, velocity visible"] * 2
        + ["giving_way, ignore, velocity visible", "acme.kind, yield, velocity visible", ""]
    )
    assert len(lines) == 2
    assert lines[0].startswith("giving_way, realism 0.75 with its usual values (real 0.81, people")
    assert lines[0].endswith("; in 1 of 3 runs people ignore the robot")
    assert "acme.kind, whose realism was not measured" in lines[1]
