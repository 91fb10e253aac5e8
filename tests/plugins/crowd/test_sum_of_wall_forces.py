"""Social forces add all walls in turn: what is left out as lost in rounding changes no bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of
from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.types.arrays import Array
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.wall_points_build import SAME

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


def _plain_sum(walls: Array) -> tuple[float, float]:
    """Return the sum of the forces on a person at the origin, with all walls."""
    x, y, radius = PILLAR
    centre = math.sqrt(x * x + y * y)
    scale = (centre - radius) / centre
    fx, fy = _force(scale * x, scale * y, centre - radius)
    seen = list[tuple[float, float]]()
    for wall in walls.tolist():
        nx, ny = nearest_on_segment(0.0, 0.0, *wall)
        known = any(abs(nx - a) <= SAME and abs(ny - b) <= SAME for a, b in seen)
        seen.append((nx, ny))
        if not known:
            px, py = _force(nx, ny, math.sqrt(nx * nx + ny * ny))
            fx, fy = fx + px, fy + py
    return fx, fy


def _sum(walls: Array) -> tuple[float, float]:
    """Return the sum of the forces on a person at the origin as a crowd decides by it."""
    agents = Agents.of(x=[0.0], y=[0.0], radius=0.2, max_acceleration=1e9, routes=[[(5.0, 0.0)]])
    world = CrowdWorld(walls=walls, pillars=np.array([PILLAR]))
    engine = CrowdEngine(agents, world, policy_of(POLICY, {"avoid": SPEC.model_dump()}))
    still, present = np.zeros((1, 2)), np.ones(1, np.bool_)
    ((x, y),) = engine.decide(still, still, np.array([[5.0, 0.0]]), present).tolist()
    return x, y


@pytest.mark.parametrize("seed", range(12))
def test_the_sum_is_that_of_all_walls_to_the_last_bit(seed: int) -> None:
    walls = _walls(np.random.default_rng(seed))
    assert len(walls) > 40
    assert _sum(walls) == _plain_sum(walls)


def test_a_corner_that_was_lost_in_a_large_sum_does_not_count_later_in_a_small_one() -> None:
    near, opposite = [0.3, 0.3, 9.0, 9.0], [-0.3, -0.3, -9.0, -9.0]
    far = [[6.0, -6.0, 6.0 + k, -7.0] for k in (0.0, 1.0)]
    walls = np.array([near, far[0], opposite, far[1]])
    assert _sum(walls) == _plain_sum(walls)
    assert _plain_sum(walls) != _plain_sum(walls[[0, 2, 3]])
