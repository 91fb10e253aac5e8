"""Social forces add all walls in turn: what is left out as lost in rounding changes no bit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of
from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.floor import floor_of
from crowdbot.core.crowd.velocity_search.records import AGENT
from crowdbot.core.support.records import record_type, record_values, rows_of
from crowdbot.core.types.arrays import Array
from crowdbot.plugin.for_crowds import SAME_POINT
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.wall_forces_build import (
    WallParams,
    add_points,
    looked_up_to,
)

SPEC = SocialForcesAvoidanceSpec.model_validate(
    {"kind": "social_forces_avoidance", "range": "100 m"}
)
POLICY = {"kind": "velocity_space", "method": "gradient", "relaxation_time": 0.5}
PILLAR = (2.0, 1.2, 0.2)


def _walls(rng: np.random.Generator) -> Array:
    """Walls around, in any order, most of which share corners with others."""
    corners = rng.uniform(-14.0, 14.0, (60, 2))
    corners = corners[np.hypot(*corners.T) > 0.6]
    ends = rng.integers(0, len(corners), (150, 2))
    ends = ends[ends[:, 0] != ends[:, 1]]
    walls = np.hstack([corners[ends[:, 0]], corners[ends[:, 1]]])
    kept = [math.hypot(*nearest_on_segment(0.0, 0.0, *wall)) > 0.5 for wall in walls.tolist()]
    return np.asarray(walls[kept])


def _force(x: float, y: float, distance: float) -> tuple[float, float]:
    """Return the force of a point at (x, y), m/s^2."""
    size = SPEC.u0 / SPEC.r * math.exp(-distance / SPEC.r) / distance
    return size * -x, size * -y


def _pillar() -> tuple[float, float]:
    """Return the force of the pillar, m/s^2."""
    x, y, radius = PILLAR
    centre = math.sqrt(x * x + y * y)
    scale = (centre - radius) / centre
    return _force(scale * x, scale * y, centre - radius)


def _plain_sum(walls: Array, fx: float, fy: float) -> tuple[float, float]:
    """Return the sum of a force and those on a person at the origin by all walls."""
    seen = list[tuple[float, float]]()
    for wall in walls.tolist():
        nx, ny = nearest_on_segment(0.0, 0.0, *wall)
        known = any(abs(nx - a) <= SAME_POINT and abs(ny - b) <= SAME_POINT for a, b in seen)
        seen.append((nx, ny))
        if not known:
            px, py = _force(nx, ny, math.sqrt(nx * nx + ny * ny))
            fx, fy = fx + px, fy + py
    return fx, fy


def _sum(walls: Array, *costs: dict[str, Any]) -> tuple[float, float]:
    """Return the sum of the forces on a person at the origin as a crowd decides by it.

    Args:
        costs: functions; by default the one of `SPEC`.
    """
    functions = {str(k): cost for k, cost in enumerate(costs or [SPEC.model_dump()])}
    agents = Agents.of(x=[0.0], y=[0.0], radius=0.2, max_acceleration=1e9, routes=[[(5.0, 0.0)]])
    world = CrowdWorld(walls=walls, pillars=np.array([PILLAR]))
    engine = CrowdEngine(agents, world, policy_of(POLICY, functions))
    still, present = np.zeros((1, 2)), np.ones(1, np.bool_)
    ((x, y),) = engine.decide(still, still, np.array([[5.0, 0.0]]), present).tolist()
    return x, y


@pytest.mark.parametrize("seed", range(12))
def test_the_sum_is_that_of_all_walls_to_the_last_bit(seed: int) -> None:
    walls = _walls(np.random.default_rng(seed))
    assert len(walls) > 40
    assert _sum(walls) == _plain_sum(walls, *_pillar())


def test_a_corner_that_was_lost_in_a_large_sum_does_not_count_later_in_a_small_one() -> None:
    near, opposite = [0.3, 0.3, 9.0, 9.0], [-0.3, -0.3, -9.0, -9.0]
    far = [[6.0, -6.0, 6.0 + k, -7.0] for k in (0.0, 1.0)]
    walls = np.array([near, far[0], opposite, far[1]])
    assert _sum(walls) == _plain_sum(walls, *_pillar())
    assert _plain_sum(walls, *_pillar()) != _plain_sum(walls[[0, 2, 3]], *_pillar())


def test_a_short_range_is_kept_beside_a_function_that_looks_farther() -> None:
    walls = _walls(np.random.default_rng(1))
    near = np.hypot(*np.array([nearest_on_segment(0.0, 0.0, *wall) for wall in walls]).T) < 3.0
    assert 3 < np.count_nonzero(near) < 0.5 * len(walls)
    short, unweighted = {"range": 3.0}, {"weight": 0.0}
    found = _sum(walls, SPEC.model_dump() | short, SPEC.model_dump() | unweighted)
    assert found == _plain_sum(walls[near], *_pillar())
    assert found != _plain_sum(walls, *_pillar())


def _sum_by_points(
    walls: Array, x: float, y: float, fx: float, fy: float
) -> tuple[bool, float, float]:
    """Return what `add_points` does for a person at (x, y)."""
    params = record_values(
        record_type(WallParams), range=100.0, from_surface=0.0, u0=SPEC.u0, r=SPEC.r
    )
    kept, address = floor_of(walls, 0.3, (looked_up_to(SPEC.r, 100.0), SPEC.r))
    agent, work = rows_of(1, AGENT), np.zeros(16 * len(walls) + 72)
    agent["px"][:], agent["py"][:], agent["floor"][:] = x, y, address
    found = add_points(fx, fy, agent[0], params, work)
    del kept
    return found


@pytest.mark.parametrize("size", [1e-12, 1e-6, 1e-2, 1.0, 1e4])
def test_a_sum_whose_bounds_are_equal_is_that_of_all_walls_to_the_last_bit(size: float) -> None:
    rng, known, places = np.random.default_rng(3), 0, 12
    walls = np.concatenate([
        _walls(rng) + np.tile(rng.uniform(-12.0, 12.0, 2), 2) for _ in range(3)
    ])  # fmt: skip
    for x, y in rng.uniform(-15.0, 15.0, (places, 2)).tolist():
        fx, fy = (size * rng.normal(0.0, 1.0, 2)).tolist()
        is_known, *found = _sum_by_points(walls, x, y, fx, fy)
        if is_known:
            known += 1
            assert tuple(found) == _plain_sum(walls - np.array([x, y, x, y]), fx, fy)
    assert known > 0.5 * places


def test_a_small_sum_that_walls_farther_away_may_change_is_not_known() -> None:
    walls = np.array([[20.0 + k, 0.0, 20.5 + k, 1.0 + k] for k in range(20)])
    assert not _sum_by_points(walls, 0.0, 0.0, 1e-30, 1e-30)[0]
    assert _sum_by_points(walls, 0.0, 0.0, 1.0, -1.0) == (True, 1.0, -1.0)


def test_a_wall_that_is_touched_does_not_push() -> None:
    walls = np.array([[-1.0, 0.0, 1.0, 0.0], [-1.0, 2.0, 1.0, 2.0]])
    for away in (0.0, 0.0005):
        assert _sum_by_points(walls, 0.0, away, 1e15, 1e15) == (True, 1e15, 1e15)
