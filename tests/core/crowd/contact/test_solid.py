"""No one comes into walls, blocks and pillars, in any packaged crowd and any crush."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.crowd.contact.solid import MOST_OVERLAP
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.named_crowds import crowd_parts, open_crowd
from crowdbot.core.types.arrays import Array

TICKS = 128
registry: Registry = discover()
NAMES = sorted(crowd_parts(registry))
#: A hall of 6 m x 5 m with a door of 0.7 m, two pillars and a block before it.
BLOCK = np.array([(4.0, 1.0), (5.0, 1.0), (5.0, 2.0), (4.0, 2.0)])
SIDES = np.column_stack([BLOCK, np.roll(BLOCK, -1, axis=0)])
HALL = np.array(
    [(0, 0, 6, 0), (6, 0, 6, 2.2), (6, 2.9, 6, 5), (6, 5, 0, 5), (0, 5, 0, 0)], np.float64
)
WALLS = np.concatenate([HALL, SIDES])
PILLARS = np.array([(5.3, 2.9, 0.1), (4.8, 3.8, 0.4)])


@cache
def _engine(name: str, people: int, firm: bool) -> CrowdEngine:
    """A crowd in the hall, in a regular crush at the start, on its way out."""
    crowd = open_crowd(name, registry)
    j, i = np.divmod(np.arange(people), 7)
    x, y = 0.4 + 0.5 * j, 0.45 + 0.65 * i
    agents = Agents.of(x=x, y=y, radius=0.25, preferred_speed=1.4, routes=[[(12.0, 2.55)]] * people)
    costs = [build_cost(registry, cost) for cost in crowd.costs.values()]
    world = CrowdWorld(walls=WALLS, pillars=PILLARS, solids=(BLOCK,), firm=firm)
    return CrowdEngine(
        agents, world, lambda agents: build_policy(registry, crowd.policy, costs, agents)
    )


def _gap(at: Array) -> float:
    """Return the smallest distance of points from walls and pillars, m; negative inside."""
    points = shapely.points(at)
    lines = shapely.MultiLineString(list(WALLS.reshape(-1, 2, 2)))
    gaps = [shapely.distance(points, lines)]
    gaps += [np.hypot(at[:, 0] - x, at[:, 1] - y) - r for x, y, r in PILLARS.tolist()]
    assert not shapely.contains(shapely.Polygon(BLOCK), points).any()
    return float(np.min(gaps))


@pytest.mark.parametrize("name", NAMES)
def test_bodies_stay_out_of_what_is_solid(name: str) -> None:
    engine = _engine(name, 42, True)
    flat = engine.initial_state()
    worst = np.inf
    for tick in range(5 * TICKS):
        engine.advance(flat)
        _, rows = s.view(flat)
        if tick % 4 == 0:
            worst = min(worst, _gap(rows[:, s.X : s.Y + 1]))
    assert worst >= 0.25 - MOST_OVERLAP - 1e-6
    _, rows = s.view(flat)
    out = rows[:, s.X] > 6.0
    through = rows[out, s.Y]
    assert np.all((rows[:, s.Y] > 0.0) & (rows[:, s.Y] < 5.0) | out), through
    assert np.isfinite(flat).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_parked_robot_on_the_way_is_not_struck(name: str) -> None:
    """Peak forces stay below 300 N, near the limits of ISO/TS 15066 for the trunk."""
    engine = _engine(name, 14, True)
    flat = engine.initial_state()
    robot = np.array([[3.0, 2.4, 0.0, 0.0, 0.178, 0.428, 0.0, 0.0]])
    felt, _ = s.contact_with(flat)
    hardest = 0.0
    for _ in range(4 * TICKS):
        engine.advance(flat, robot)
        hardest = max(hardest, float(np.hypot(felt[s.ROBOT_FX], felt[s.ROBOT_FY])))
    assert np.any(s.view(flat)[1][:, s.X] > 3.0)
    assert hardest < 300.0


class _Driven:
    """A policy that wants given accelerations, whatever stands there."""

    contact_stiffness = 62.5

    def __init__(self, wanted: Array) -> None:
        self._wanted = wanted

    def accelerations(self, view: CrowdView) -> Array:
        """Return them."""
        del view
        return self._wanted


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32), st.booleans(), st.floats(1.0, 40.0))
def test_no_force_drives_a_centre_into_a_wall(seed: int, firm: bool, hard: float) -> None:
    """At any speed, in corners, between walls at any angle; and none gets out of a closed room."""
    rng = np.random.default_rng(seed)
    ring = np.array([(0.0, 0.0), (4.0, 0.5), (5.0, 3.0), (2.5, 2.6), (0.5, 4.0)])
    room = shapely.Polygon(ring)
    bars = rng.uniform(0.0, 4.0, (14, 2))
    ends = bars + rng.uniform(-1.0, 1.0, (14, 2))
    walls = np.concatenate(
        [np.column_stack([ring, np.roll(ring, -1, axis=0)]), np.column_stack([bars, ends])]
    )
    lines = shapely.MultiLineString(list(walls.reshape(-1, 2, 2)))
    at = rng.uniform(0.0, 4.0, (400, 2))
    free = shapely.distance(shapely.points(at), lines) > 0.25
    at = at[free & shapely.contains_xy(room, at)][:12]
    if not len(at):
        return
    wanted = hard * rng.standard_normal((len(at), 2))
    agents = Agents.of(x=at[:, 0], y=at[:, 1], radius=0.25, max_speed=20.0, routes=[[]] * len(at))
    engine = CrowdEngine(agents, CrowdWorld(walls=walls, firm=firm), _Driven(wanted))
    flat = engine.initial_state()
    before = at
    limit = 0.25 - MOST_OVERLAP if firm else 0.0
    for _ in range(TICKS):
        engine.advance(flat)
        now = s.view(flat)[1][:, s.X : s.Y + 1].copy()
        steps = shapely.linestrings(np.stack([before, now], axis=1))
        assert not shapely.intersects(steps, lines).any()
        assert shapely.distance(shapely.points(now), lines).min() >= limit - 1e-7
        before = now


def test_who_starts_too_close_is_not_thrown() -> None:
    agents = Agents.of(x=[0.1], y=[0.0], radius=0.25, routes=[[(5.0, 0.0)]])
    walls = np.array([[0.0, -3.0, 0.0, 3.0]])
    engine = CrowdEngine(agents, CrowdWorld(walls=walls, firm=True), _Driven(np.zeros((1, 2))))
    flat = engine.initial_state()
    _, rows = s.view(flat)
    rows[0, s.VX : s.VY + 1] = 0.0
    engine.advance(flat)
    assert rows[0, s.X] == pytest.approx(0.1, abs=0.01)


def test_people_of_records_walk_through_walls_of_a_plan_that_does_not_fit() -> None:
    def free(agents: Agents) -> _Driven:
        policy = _Driven(np.tile([3.0, 0.0], (len(agents), 1)))
        policy.walks_through_walls = True  # type: ignore[attr-defined]
        return policy

    agents = Agents.of(x=[0.0], y=[0.0], radius=0.25, routes=[[(5.0, 0.0)]])
    engine = CrowdEngine(agents, CrowdWorld(walls=np.array([[1.0, -3.0, 1.0, 3.0]])), free)
    flat = engine.initial_state()
    for _ in range(3 * TICKS):
        engine.advance(flat)
    assert s.view(flat)[1][0, s.X] > 2.0
