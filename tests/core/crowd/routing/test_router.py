"""People who find their way: through doors, around each other, and never through a wall."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import REMOVE
from crowdbot.core.crowd.from_spec import policy_of
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.crowd.routing.router import rounded
from tests.core.crowd.routing.floor_plans import SIZE, crossings, outline, rooms

Array = NDArray[np.float64]
COSTS: dict[str, dict[str, Any]] = {
    "avoid": {"kind": "ttca_dca", "weight": 20, "range": 5.0},
    "reflex": {"kind": "rvo", "range": {"value": 0.3, "measure": "surface"}},
}
#: A wall with a door of 1.2 m at y = 3, in a room of 12 m by 10 m.
ROOM = [[-6, -5, 6, -5], [6, -5, 6, 5], [6, 5, -6, 5], [-6, 5, -6, -5]]
DOOR = np.array([*ROOM, *outline(-0.1, -5, 0.1, 2.4), *outline(-0.1, 3.6, 0.1, 5)])


def _engine(
    walls: Array, starts: Array, goals: Array, routing: WayFinding | None = None
) -> CrowdEngine:
    agents = Agents.of(
        x=starts[:, 0], y=starts[:, 1], preferred_speed=1.3,
        routes=[[tuple(g)] for g in goals.tolist()], at_goal=REMOVE,
    )  # fmt: skip
    world = CrowdWorld(walls=walls, routing=routing or WayFinding(key=3))
    return CrowdEngine(agents, world, policy_of({"kind": "velocity_space"}, COSTS))


def _aims(engine: CrowdEngine) -> Array:
    _, rows = s.view(engine.initial_state())
    return rows[:, [s.WAYPOINT_X, s.WAYPOINT_Y]]


def test_they_aim_beside_the_corner_each_at_a_place_of_its_own() -> None:
    starts = np.stack([np.linspace(-5, -2, 20), np.full(20, -4.0)], axis=1)
    goals = np.tile([4.0, -4.0], (20, 1))
    aims = _aims(_engine(DOOR, starts, goals))
    assert np.all((aims[:, 0] > -1.0) & (aims[:, 0] < -0.4))  # off the first post of the door
    assert np.all((aims[:, 1] > 2.5) & (aims[:, 1] < 2.8))
    assert np.ptp(aims[:, 0]) > 0.2
    assert len(np.unique(aims[:, 1])) == 20
    again = _aims(_engine(DOOR, starts, goals))
    assert np.array_equal(aims, again)
    other = _aims(_engine(DOOR, starts, goals, WayFinding(key=4)))
    assert not np.array_equal(aims, other)
    together = _aims(_engine(DOOR, starts, goals, WayFinding(key=4, spread=0.0)))
    assert len(np.unique(together[:, 1])) <= 2


def test_who_sees_the_goal_aims_at_it() -> None:
    starts, goals = np.array([[-4.0, 3.0], [2.0, 0.0]]), np.array([[4.0, 3.0], [5.0, -4.0]])
    assert np.array_equal(_aims(_engine(DOOR, starts, goals)), goals)


def test_who_is_moved_finds_another_way() -> None:
    engine = _engine(DOOR, np.array([[-4.0, -4.0]]), np.array([[4.0, -4.0]]))
    flat = engine.initial_state()
    _, rows = s.view(flat)
    assert rows[0, s.WAYPOINT_Y] > 2.0
    rows[0, [s.X, s.Y]] = 3.0, 0.0  # pushed to the other side
    engine.advance(flat)
    assert rows[0, [s.WAYPOINT_X, s.WAYPOINT_Y]].tolist() == [4.0, -4.0]


def test_who_makes_no_headway_takes_the_other_door() -> None:
    walls = np.array(
        [
            *ROOM,
            *outline(-0.1, -5, 0.1, -2.6),
            *outline(-0.1, -1.4, 0.1, 2.0),
            *outline(-0.1, 3.2, 0.1, 5),
        ]
    )
    start, goal = np.array([[-4.0, 0.2]]), np.array([[4.0, -0.2]])
    engine = _engine(walls, start, goal, WayFinding(patience=1.0, detour=1.5))
    flat = engine.initial_state()
    _, rows = s.view(flat)
    assert rows[0, s.WAYPOINT_Y] < 0.0
    for _ in range(20):  # somebody holds it for 1.25 s
        rows[0, [s.X, s.Y, s.VX, s.VY]] = -4.0, 0.2, 0.0, 0.0
        for _ in range(8):
            engine.advance(flat)
    assert rows[0, s.WAYPOINT_Y] > 1.0
    assert rows[0, s.DETOURS] == 1.0
    stubborn = _engine(walls, start, goal, WayFinding(patience=1.0, detour=1.0))
    flat = stubborn.initial_state()
    _, rows = s.view(flat)
    for _ in range(20):
        rows[0, [s.X, s.Y, s.VX, s.VY]] = -4.0, 0.2, 0.0, 0.0
        for _ in range(8):
            stubborn.advance(flat)
    assert rows[0, s.CORNER] == -1.0  # no other way is short enough: it steps aside
    aim = rows[0, [s.WAYPOINT_X, s.WAYPOINT_Y]]
    assert np.hypot(*(aim - [-4.0, 0.2])) == pytest.approx(1.0)
    rows[0, [s.X, s.Y]] = aim
    for _ in range(32):
        stubborn.advance(flat)
    assert rows[0, s.CORNER] > 0.0  # there: on to a door


def test_straight_ways_are_what_they_were() -> None:
    starts, goals = np.array([[-4.0, 0.0], [3.0, 1.0]]), np.array([[-1.0, -4.0], [4.0, -4.0]])
    mesh = _engine(DOOR, starts, goals)
    straight = CrowdEngine(mesh.agents, replace(mesh.world, routing=None), mesh.groups[0].policy)
    one, two = mesh.run(2.0)[1], straight.run(2.0)[1]
    assert np.array_equal(one, two)  # nothing is in the way


def test_few_maps_for_many_radii() -> None:
    radius = np.random.default_rng(0).uniform(0.2, 0.35, 500)
    assert len(np.unique(rounded(radius))) <= 4
    assert np.all(rounded(radius) >= radius - 1e-9)
    assert rounded(np.full(3, 0.33)).tolist() == [0.33] * 3


def test_no_routing_on_a_torus() -> None:
    with pytest.raises(ValueError, match="periodic boundary"):
        CrowdWorld(routing=WayFinding(), periodic_boundary=(0.0, 1.0, 0.0, 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [11, 12])
def test_random_plans(seed: int) -> None:
    """Nobody passes a wall, everybody arrives, and hardly anybody walks farther than he has to."""
    rng = np.random.default_rng(seed)
    columns, rows_ = 3, 2
    walls = rooms(rng, columns, rows_)
    engine = _engine(walls, np.zeros((1, 2)) + 2.5, np.zeros((1, 2)) + 2.5)
    assert engine._router is not None
    space = engine._router._classes[0].routes.space
    centres = [(i + 0.5, j + 0.5) for i in range(columns) for j in range(rows_)]
    starts = SIZE * np.array(centres) + rng.uniform(-1.5, 1.5, (6, 2))
    goals = SIZE * np.array(centres)[rng.permutation(6)] + rng.uniform(-1.5, 1.5, (6, 2))
    ends = space.part_of(np.concatenate([starts, goals])).reshape(2, -1)
    can = ends[0] == ends[1]
    engine = _engine(walls, starts[can], goals[can])
    assert engine._router is not None
    shortest = np.array([
        np.hypot(*np.diff(engine._router.way(k, tuple(a), tuple(b)), axis=0).T).sum()
        for k, (a, b) in enumerate(zip(starts[can], goals[can], strict=True))
    ])  # fmt: skip
    flat = engine.initial_state()
    _, rows = s.view(flat)
    before = rows[:, [s.X, s.Y]].copy()
    for tick in range(40 * 128):
        engine.advance(flat)
        if tick % 8 == 0:
            after = rows[:, [s.X, s.Y]].copy()
            assert crossings(walls, before, after) == 0
            before = after
        if np.all(rows[:, s.WAITING] == s.GONE):
            break
    assert np.all(rows[:, s.WAITING] == s.GONE)
    assert rows[:, s.WALKED].sum() < 1.05 * shortest.sum()
