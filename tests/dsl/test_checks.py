"""What scenarios share is checked once, and nothing else is left out."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_suite
from crowdbot.dsl.checks import robots as semantics_robot_ways
from crowdbot.dsl.checks.reach import areas_connected
from crowdbot.dsl.spec.outlines import Point
from crowdbot.dsl.spec.place import Place
from crowdbot.errors import SpecError

SUITE = """\
crowdbot: 1
suite: {id: s, title: Rooms, seed: 1}
base:
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment:
    kind: corridor
    length: 20 m
    width: 4 m
    zones:
      all: {x: [0 m, 20 m], y: [-2 m, 2 m]}
      goal: {x: [18 m, 20 m], y: [-2 m, 2 m]}
  robots.robot.task: {start: [1 m, 0 m, 0 deg], goal: {zone: goal}, time_limit: 20 s}
  crowd:
    body: {radius: 0.25 m}
    speed: {mean: 1.3 m/s, std: 0 m/s}
    routing: {kind: mesh}
    policy: {kind: velocity_space}
    costs: {reflex: {kind: rvo}}
    agents: [{id: 1, x: 10 m, y: 0 m, goals: [[12 m, 0 m]]}]
matrix:
  start:
    near: {robots.robot.task.start: [1 m, 0 m, 0 deg]}
    far: {robots.robot.task.start: [FAR m, 0 m, 0 deg]}
  people:
    fast: {crowd.agents: [{id: 1, x: 10 m, y: 0 m, goals: [[12 m, 0 m]]}]}
    slow: {crowd.agents: [{id: 1, x: 9 m, y: WHERE m, goals: [[12 m, 0 m]]}]}
references:
  alone: {crowd: null}
"""
IN_THE_WALL = ("agent 1 stands in a wall", "no way leads agent 1 from (9, 1.9)")


def _open(tmp_path: Path, far: str = "2", where: str = "0") -> int:
    file = tmp_path / "s.yaml"
    file.write_text(SUITE.replace("FAR", far).replace("WHERE", where))
    return len(open_suite(str(file), discover())[0].scenarios)


def test_each_crowd_is_checked_once_beside_an_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[float, float]] = []
    original = Place.is_clear

    def is_clear(self: Place, start: Point, goal: Point, radius: float) -> bool:
        asked.append(start)
        return original(self, start, goal, radius)

    monkeypatch.setattr(Place, "is_clear", is_clear)
    areas_connected.cache_clear()
    monkeypatch.setattr(semantics_robot_ways, "areas_connected", areas_connected.__wrapped__)
    assert _open(tmp_path) == 4
    assert asked == [(1.0, 0.0), (2.0, 0.0)]  # of two crowds and a reference each


@pytest.mark.parametrize(
    ("far", "where", "messages"),
    [
        ("30", "0", ["the start (30, 0) of robot 'robot' lies outside"]),
        ("2", "1.9", [*IN_THE_WALL]),
        ("30", "1.9", ["the start (30, 0) of robot 'robot' lies outside", *IN_THE_WALL]),
        ("10", "0", ["agent 1 stands where robot 'robot' starts"]),
    ],
)
def test_what_only_some_scenarios_have_wrong_is_found(
    far: str, where: str, messages: list[str], tmp_path: Path
) -> None:
    with pytest.raises(SpecError) as caught:
        _open(tmp_path, far, where)
    found = [d.message for d in caught.value.diagnostics]
    for message in messages:
        assert any(one.startswith(message) for one in found), found
    assert len(found) == len(messages), found
