"""Walls that cannot matter are left out of a decision: no bit of a choice depends on them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.api import registry
from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.build import build_cost
from crowdbot.core.crowd.policy import CrowdPolicy
from crowdbot.core.crowd.velocity_search.cost import CompiledCost
from crowdbot.core.crowd.velocity_search.records import WALL, WORK_COLUMNS
from crowdbot.core.support.records import rows_of
from crowdbot.core.types.arrays import Array
from crowdbot.plugin import Pointer
from crowdbot.plugin.for_crowds import SAME_POINT
from crowdbot.plugins.crowd.cost_functions.orca_build import change, is_out_of_the_way
from crowdbot.plugins.crowd.cost_functions.wall_points_build import (
    choose,
    chosen,
    leave_out_repeated,
)
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace

FAR = {"range": {"value": 100.0, "measure": "surface"}}
BOUNDED = [
    "foe_avoidance", "goal_reaching_force", "karamouzas", "moussaid", "orca", "paris",
    "pledestrians", "power_law", "random_function", "rvo", "social_forces_avoidance", "ttca_dca",
    "van_toll",
]  # fmt: skip
ALL_GIVEN: dict[str, Any] = {
    "wall_reach": None, "looks_farther": False, "walls_on_the_way": False,
    "optimum_by_nearby_walls": False,
}  # fmt: skip
METHODS = {
    "orca": "global", "foe_avoidance": "gradient", "power_law": "gradient",
    "social_forces_avoidance": "gradient",
}  # fmt: skip


def _rooms(rng: np.random.Generator) -> Array:
    """Walls (180, 4) of random boxes in a square of 60 m."""
    low = rng.uniform(-30.0, 29.0, (45, 2))
    high = low + rng.uniform(0.1, 4.0, (45, 2))
    corners = [
        np.stack([low[:, 0], low[:, 1], high[:, 0], low[:, 1]], axis=1),
        np.stack([high[:, 0], low[:, 1], high[:, 0], high[:, 1]], axis=1),
        np.stack([high[:, 0], high[:, 1], low[:, 0], high[:, 1]], axis=1),
        np.stack([low[:, 0], high[:, 1], low[:, 0], low[:, 1]], axis=1),
    ]
    return np.concatenate(corners)


def _choices(kind: str, whole: bool) -> Array:
    """States after 0.3 s with the wall reach of a function, or with all walls."""
    rng, count = np.random.default_rng(4), 40
    walls, at = _rooms(rng), rng.uniform(-25.0, 25.0, (2, count))
    return _states(kind, whole, walls, (at[0], at[1]), rng.normal(0.0, 1.5, (count, 2)))


def _states(
    kind: str, whole: bool, walls: Array, at: tuple[Array, Array], velocity: Array, **options: float
) -> Array:
    known, rng, count = registry(), np.random.default_rng(5), len(velocity)
    function: Any = build_cost(
        known, known.find("cost function", kind).spec.model_validate({"kind": kind} | FAR | options)
    )
    assert isinstance(function, CompiledCost)
    assert function.wall_reach is not None
    shown = replace(function, **ALL_GIVEN) if whole else function
    spec = VelocitySpaceSpec.model_validate(
        {"kind": "velocity_space", "relaxation_time": 0.4, "method": METHODS.get(kind, "sampling")}
    )

    def make(agents: Agents) -> CrowdPolicy:
        return VelocitySpace(spec, [shown], agents)

    goals = rng.uniform(-25.0, 25.0, (count, 2))
    agents = Agents.of(
        x=at[0], y=at[1], radius=0.25, preferred_speed=rng.uniform(0.5, 1.6, count),
        routes=[[(float(a), float(b))] for a, b in goals],
    )  # fmt: skip
    engine = CrowdEngine(agents, CrowdWorld(walls=walls), make)
    flat = engine.initial_state()
    s.view(flat)[1][:, s.VX : s.VY + 1] = velocity
    for _ in range(24):
        engine.advance(flat)
    return flat


@pytest.mark.parametrize("kind", BOUNDED)
def test_walls_out_of_reach_change_no_bit(kind: str) -> None:
    assert np.array_equal(_choices(kind, whole=False), _choices(kind, whole=True))


def test_walls_are_points_that_count_once() -> None:
    rng = np.random.default_rng(2)
    walls = rows_of(300, WALL)
    x, y = rng.choice([-2.0, -1e-6, 0.0, 1e-6, 0.75, 3.0], (2, 300))
    walls["nx"][:] = x + SAME_POINT * rng.choice([0.0, -0.4, 0.4, 0.9, 3.0], 300)
    walls["ny"][:] = y + rng.choice([0.0, -0.7 * SAME_POINT], 300)
    walls["d2"][:] = walls["nx"] ** 2 + walls["ny"] ** 2
    point = np.stack([walls["nx"], walls["ny"]], axis=1)
    gap = np.abs(point[:, np.newaxis] - point[np.newaxis]).max(axis=2)
    expected = ~np.any(np.tril(gap <= SAME_POINT, -1), axis=1)
    assert 30 < np.count_nonzero(expected) < 200
    work = np.zeros(1 + 7 * WORK_COLUMNS * 300)
    for number in (300, 12):
        assert _left(walls, number, work) == list(np.flatnonzero(expected[:number]))


def _left(walls: Any, number: int, work: Pointer) -> list[int]:
    """Indices of the walls that are left of the first ones."""
    for k in range(number):
        choose(k, k, work)
    return [chosen(k, work) for k in range(leave_out_repeated(walls, number, work))]


@pytest.mark.parametrize("kind", ["moussaid", "rvo", "social_forces_avoidance"])
def test_walls_are_looked_up_by_someone_outside_of_their_box_and_by_someone_who_creeps(
    kind: str,
) -> None:
    walls = _rooms(np.random.default_rng(7))
    at = (np.array([-60.0, 0.2, 0.2]), np.array([3.0, 0.1, 55.0]))
    velocity = np.array([[1.2, 0.1], [1e-6, 2e-7], [0.0, -1.3]])
    given, whole = (_states(kind, whole, walls, at, velocity) for whole in (False, True))
    assert np.array_equal(given, whole)


@pytest.mark.parametrize("kind", ["moussaid", "van_toll"])
def test_walls_are_looked_up_on_ways_that_leave_their_box_and_that_come_into_it(kind: str) -> None:
    walls, rng = _rooms(np.random.default_rng(8)), np.random.default_rng(9)
    angle = rng.uniform(0.0, 2.0 * math.pi, 60)
    at = rng.uniform(28.0, 45.0, 60) * np.array([np.cos(angle), np.sin(angle)])
    velocity = rng.normal(0.0, 1.5, (60, 2)) * rng.choice([0.0, 1.0], (60, 2), p=[0.2, 0.8])
    given, whole = (
        _states(kind, whole, walls, (at[0], at[1]), velocity) for whole in (False, True)
    )
    assert np.array_equal(given, whole)


@pytest.mark.parametrize("horizon", [0.3, 2.0, 9.0])
def test_half_planes_of_far_walls_and_people_change_no_optimum_in_a_crowd(horizon: float) -> None:
    rng = np.random.default_rng(6)
    at, velocity = rng.uniform(-6.0, 6.0, (2, 60)), rng.normal(0.0, 1.2, (60, 2))
    walls = _rooms(rng)
    walls = walls[np.hypot(walls[:, 0], walls[:, 1]) < 22.0]
    given, whole = (
        _states("orca", whole, walls, (at[0], at[1]), velocity, time_horizon=horizon)
        for whole in (False, True)
    )
    assert np.array_equal(given, whole)


@given(
    distance=st.floats(0.3, 40.0), angle=st.floats(0.0, 6.3), vx=st.floats(-3.0, 3.0),
    vy=st.floats(-3.0, 3.0), radius=st.floats(0.1, 1.0), spread=st.floats(0.1, 4.0),
    horizon=st.floats(0.2, 10.0), share=st.sampled_from([0.0, 1.0]) | st.floats(-1.5, 1.5),
)  # fmt: skip
def test_half_planes_that_orca_leaves_out_hold_every_velocity(
    distance: float, angle: float, vx: float, vy: float, radius: float, spread: float,
    horizon: float, share: float,
) -> None:  # fmt: skip
    rx, ry = distance * math.cos(angle), distance * math.sin(angle)
    ax, ay, d2 = share * vx, share * vy, rx * rx + ry * ry
    if not is_out_of_the_way(rx, ry, d2, vx, vy, radius, horizon, ax, ay, spread):
        return
    assert distance > radius
    assert (radius - distance) / 0.5 < -(rx * ax + ry * ay) / distance - spread
    nx, ny, way = change(rx, ry, vx, vy, radius, horizon, 1.0, False)
    assert nx * vx + ny * vy + way < nx * ax + ny * ay - spread
