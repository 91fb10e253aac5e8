"""Robots of examples and how-tos can arrive in time, and not at once."""

from __future__ import annotations

import math

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.scenarios.library import open_spec
from crowdbot.errors import SpecError
from tests.paths import ROOT

FILES = sorted(
    path.relative_to(ROOT)
    for folder in ("scenario_specs/examples", "docs/howto/files", "docs/tutorial/files")
    for path in (ROOT / folder).glob("*.yaml")
    if "goal: {zone" in path.read_text(encoding="utf-8")
)


@pytest.mark.slow
def test_goals_are_neither_at_the_start_nor_out_of_reach() -> None:
    """By the straight way at full speed: more than a second, and less than the time there is."""
    registry, seen = discover(allow=()), 0
    for file in FILES:
        try:
            opened = open_spec(str(ROOT / file), registry)
        except SpecError:  # a part, a study, a planner, or kinds of a plugin
            continue
        scenario = opened.scenarios[0]
        for name, robot in scenario.robots.items():
            if robot.task.zone is None:
                continue
            zone = scenario.environment.zones[robot.task.zone]
            pairs = zip(robot.task.start, (zone.x, zone.y), strict=False)
            away = [max(low - at, 0.0, at - high) for at, (low, high) in pairs]
            least = math.hypot(*away) / build_model(registry, robot.model).limits.v_max
            assert 1.0 < least < robot.task.time_limit, f"{file}: {name} needs {least:.1f} s"
            seen += 1
    assert seen > 20
