"""Every packaged crowd where people once came into solids, or circled for good."""

from __future__ import annotations

import math
from functools import cache
from typing import Literal

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import ONWARD, REMOVE
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.crowd.contact.solid import MOST_OVERLAP
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.named_crowds import crowd_parts, open_crowd
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import Crowd

REGISTRY: Registry = discover(allow=())
NAMES = sorted(crowd_parts(REGISTRY))
TICKS, RADIUS = 128, 0.2
WIDE, DEEP = 8.0, 6.0
#: On the floor's border and across it.
BLOCK = np.array([(4.0, 0.0), (6.0, 0.0), (6.0, 1.0), (4.0, 1.0)])
PILLARS = np.array([(0.1, 3.0, 0.5), (7.6, 4.5, 0.4), (2.0, 5.8, 0.6)])
#: A hall of pillars.
GRID = np.array([(x, y, 0.3) for x in (2.0, 3.6, 5.2, 6.8) for y in (0.8, 2.4, 4.0, 5.6)])


@cache
def _named(name: str) -> Crowd:
    return open_crowd(name, REGISTRY)


def _engine(name: str, agents: Agents, world: CrowdWorld) -> CrowdEngine:
    crowd = _named(name)
    costs = [build_cost(REGISTRY, cost) for cost in crowd.costs.values()]
    return CrowdEngine(agents, world, lambda own: build_policy(REGISTRY, crowd.policy, costs, own))


def _sides(outline: Array) -> Array:
    return np.column_stack([outline, np.roll(outline, -1, axis=0)])


def _gap(at: Array, world: CrowdWorld) -> float:
    """Return the smallest distance of points from what is solid, m; 0 or less inside."""
    points, gap = shapely.points(at), np.full(len(at), math.inf)
    for x, y, radius in world.pillars.tolist():
        gap = np.minimum(gap, np.hypot(at[:, 0] - x, at[:, 1] - y) - radius)
    for outline in world.solids:
        gap = np.minimum(gap, shapely.distance(points, shapely.Polygon(outline)))
    return float(gap.min(initial=math.inf))


def _stay_out(engine: CrowdEngine, seconds: float) -> Array:
    """Assert that no one is in a solid at any tick; return all people's rows at the end.

    That is when all have gone, if they do.
    """
    flat = engine.initial_state()
    _, rows = s.view(flat)
    for _ in range(round(seconds * TICKS)):
        engine.advance(flat)
        if np.all(rows[:, s.WAITING] == s.GONE):
            break
        at = rows[rows[:, s.WAITING] == s.PRESENT][:, [s.X, s.Y]]
        assert _gap(at, engine.world) >= RADIUS - MOST_OVERLAP - 1e-6
    return rows


def _free(count: int, world: CrowdWorld, within: tuple[float, float, float, float]) -> Array:
    """Return places (K, 2) for bodies in a box x0, x1, y0, y1 that touch nothing."""
    rng, found = np.random.default_rng(5), np.zeros((0, 2))
    while len(found) < count:
        at = rng.uniform([within[0], within[2]], [within[1], within[3]], (1, 2))
        apart = np.hypot(*(found - at).T)
        if np.all(apart > 2.0 * RADIUS) and _gap(at, world) > RADIUS:
            found = np.concatenate([found, at])
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_no_one_wraps_into_a_solid_at_the_border_of_a_torus(name: str) -> None:
    world = CrowdWorld(
        walls=_sides(BLOCK), solids=(BLOCK,), pillars=PILLARS, firm=True,
        periodic_boundary=(0.0, WIDE, 0.0, DEEP),
    )  # fmt: skip
    at = _free(30, world, (0.7, WIDE - 0.7, 1.3, DEEP - 0.9))
    way = np.linspace(0.0, math.tau, len(at))
    ahead = at + 6.0 * np.column_stack([np.cos(way), np.sin(way)])
    routes = [[tuple(a), tuple(b)] for a, b in zip(at.tolist(), ahead.tolist(), strict=True)]
    agents = Agents.of(x=at[:, 0], y=at[:, 1], radius=RADIUS, routes=routes, at_goal=ONWARD)
    rows = _stay_out(_engine(name, agents, world), 5.0)
    assert rows[:, s.JUMPS].sum() > 0.0  # some did wrap


@pytest.mark.parametrize("exit_point", ["random", "offset"])
def test_no_one_comes_back_in_a_solid_that_stands_in_a_portal(
    exit_point: Literal["random", "offset"],
) -> None:
    block = np.array([(-0.5, 2.0), (1.5, 2.0), (1.5, 4.0), (-0.5, 4.0)])
    boxes = np.array([[0.0, 2.0, 0.0, DEEP]]), np.array([[WIDE - 1.0, WIDE, 0.0, DEEP]])
    world = CrowdWorld(
        walls=_sides(block), solids=(block,), pillars=np.array([(1.0, 5.0, 0.6)]), firm=True,
        entrance=boxes[0], out=boxes[1], exit_point=exit_point,
    )  # fmt: skip
    at = _free(24, world, (4.0, WIDE - 1.2, 0.5, DEEP - 0.5))
    agents = Agents.of(x=at[:, 0], y=at[:, 1], radius=RADIUS)
    rows = _stay_out(_engine("orca_corrected", agents, world), 12.0)
    assert np.all(rows[:, s.TRIP] > 0.0)  # all came back


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_goal_close_to_a_pillar_is_reached_around_it(name: str) -> None:
    """Nearer than a body's margin, on the side that no corner of ways sees."""
    walls = _sides(np.array([(0.0, 0.0), (0.0, 6.4), (9.0, 6.4), (9.0, 0.0)]))
    world = CrowdWorld(walls=walls, pillars=GRID, firm=True, routing=WayFinding(key=2))
    chosen, way = GRID[[5, 6, 9]], np.radians([0.0, 70.0, -60.0])
    goals = chosen[:, :2] + 0.45 * np.column_stack([np.cos(way), np.sin(way)])
    starts = np.array([(0.5, 3.2), (0.6, 1.5), (0.5, 4.6)])
    agents = Agents.of(
        x=starts[:, 0], y=starts[:, 1], radius=RADIUS, preferred_speed=1.3, at_goal=REMOVE,
        routes=[[tuple(goal)] for goal in goals.tolist()],
    )  # fmt: skip
    rows = _stay_out(_engine(name, agents, world), 60.0)
    assert np.all(rows[:, s.WAITING] == s.GONE)
