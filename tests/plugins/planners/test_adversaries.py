"""The adversaries: what each does among people who stand in the way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.resolve import kinds_of_role, resolve_planner
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.registry import discover
from crowdbot.plugins.planners.adversaries.adversaries import DrawReplaySpec
from crowdbot.plugins.planners.adversaries.adversaries_build import DrawReplay, fingerprint
from tests.plugins.planners.world import START, Outcome, World

REGISTRY = discover(allow=())
NAMES = (
    "bully", "creep", "curtsey", "draw_replay", "gap_rush", "lane_waiter", "late_start",
    "never_aside", "park", "quitter", "reverse", "shield", "strobe", "wall_bully", "weave",
)  # fmt: skip
AHEAD = [[START.x + 3.0, 0.0, 0.0, 0.0]]


def drive(kind: str, people: object = (), seconds: float = 8.0) -> tuple[World, Outcome]:
    component = REGISTRY.find("planner", kind)
    world = World(people)  # type: ignore[arg-type]
    planner: Any = load_build(component)(component.spec())
    return world, world.run(planner, time_limit=seconds)


def speeds(out: Outcome) -> np.ndarray:
    return np.array([command.v for command in out.commands])


def test_they_are_registered_with_their_role() -> None:
    assert tuple(kinds_of_role("adversary", REGISTRY)) == NAMES
    assert resolve_planner("bully", REGISTRY).role == "adversary"


@pytest.mark.parametrize("kind", [n for n in NAMES if n not in ("park", "late_start")])
def test_alone_it_comes_nearer_to_the_goal(kind: str) -> None:
    world, _ = drive(kind, seconds=5.0)
    assert world.pose.x > START.x + 0.5


def test_who_stops_and_who_does_not() -> None:
    gaps = {}
    for kind in ("bully", "never_aside", "quitter", "lane_waiter", "creep"):
        world, out = drive(kind, AHEAD)
        gaps[kind] = START.x + 3.0 - world.pose.x
        assert abs(world.pose.y) < 0.2
        if kind != "creep":
            assert abs(speeds(out)[-1]) < 0.05
    assert gaps["creep"] < gaps["bully"] < gaps["never_aside"] < gaps["quitter"]


def test_the_bully_brakes_late() -> None:
    _, out = drive("bully", AHEAD)
    _, careful = drive("never_aside", AHEAD)
    fast, slow = (np.flatnonzero(speeds(x) > 0.5)[-1] for x in (out, careful))
    assert fast > slow
    assert speeds(out).sum() > speeds(careful).sum()


def test_each_does_what_its_name_says() -> None:
    parked, out = drive("park", AHEAD, 2.0)
    assert parked.pose == START
    assert not speeds(out).any()
    _, out = drive("reverse", seconds=8.0)
    assert speeds(out).min() < -0.5
    assert speeds(out).max() <= 0.0
    _, out = drive("weave")
    assert np.ptp([p.y for p in out.path]) > 0.2
    _, out = drive("strobe")
    assert 0.2 < np.mean(speeds(out) == 0.0) < 0.5
    _, out = drive("curtsey", AHEAD)
    assert ((speeds(out) > 0.0) & (speeds(out) < 0.5 * speeds(out).max())).any()
    _, out = drive("gap_rush", AHEAD)
    assert np.ptp([p.y for p in out.path]) > 0.2
    world, _ = drive("late_start", AHEAD)
    assert world.pose.x == pytest.approx(START.x, abs=0.05)
    world, _ = drive("wall_bully", seconds=8.0)
    assert world.pose.y > 0.5
    shield, _ = drive("shield", [[START.x + 1.5, 0.4, 0.65, 0.0]])
    assert shield.pose.y > 0.02


def test_a_known_crowd_is_waited_for() -> None:
    points = np.array([[1.0, 0.0], [2.0, 1.0]])
    assert fingerprint(points) == fingerprint(points[::-1] + 0.01)
    assert fingerprint(points) != fingerprint(points + 1.0)

    class Marked(DrawReplay):
        mark = ""

        def drive(self, obs, points, v, w):  # type: ignore[no-untyped-def]
            Marked.mark = Marked.mark or fingerprint(points)
            return super().drive(obs, points, v, w)

    World(AHEAD).run(Marked(DrawReplaySpec()), time_limit=0.5)
    memory = {Marked.mark: 3.0}
    out = World(AHEAD).run(DrawReplay(DrawReplaySpec(memory=memory)), time_limit=4.0)
    waits = int(np.argmax(speeds(out) > 0.0)) / len(out.commands)
    assert waits == pytest.approx(0.75, abs=0.05)
