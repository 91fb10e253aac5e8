"""The first collision is the same whatever was left out of the list, and however it is sorted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from numba import njit

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.collision import (
    first_collision,
    list_approaching,
    list_obstacles,
)
from crowdbot.core.crowd.velocity_search.cost import EXCESS, PREPARE, Pointer
from crowdbot.core.crowd.velocity_search.cost_calls import address_of, call_excess, call_prepare
from crowdbot.core.crowd.velocity_search.records import (
    AGENT,
    NEIGHBOUR,
    WALL,
    WORK_COLUMNS,
    AgentRecord,
    NeighbourRecord,
    WallRecord,
)
from crowdbot.core.support.records import Rows, rows_of
from crowdbot.core.types.arrays import Array

_FAR = 100.0  # m
_RADIUS = 0.3  # m


@njit(PREPARE, cache=True, error_model="numpy")
def _some(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    return list_approaching(
        agent, near, near_count, walls, wall_count, params, work,
        params[2], params[3], params[4], params[5],
    )  # fmt: skip


@njit(PREPARE, cache=True, error_model="numpy")
def _all(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    fastest = params[4] + math.hypot(params[2], params[3])
    return list_obstacles(agent, near, near_count, walls, wall_count, params, work, fastest)


@njit(EXCESS, cache=True, error_model="numpy")
def _time(
    ux: float, uy: float, until: float, agent: AgentRecord, work: Pointer, _params: Pointer
) -> float:
    return float(first_collision(ux, uy, until, agent, work))


@njit(cache=True)
def _ask(
    functions: Array,
    scene: Any,
    params: Array,
    work: Array,
    asked: Array,
    times: Array,
) -> None:
    agent, near, walls, wall_count, until = scene
    call_prepare(functions[0], agent[0], near, len(near), walls, wall_count, params, work)
    for k in range(len(asked)):
        ux, uy = asked[k, 0], asked[k, 1]
        times[k] = call_excess(functions[1], ux, uy, until, agent[0], work, params)


def first_collisions(prepare: object, near: Any, params: Array, asked: Array) -> tuple[Array, int]:
    """Times of the first collision at velocities (K, 2), s; and how many discs were listed."""
    agent, work = rows_of(1, AGENT), np.zeros((len(near) + 1, WORK_COLUMNS))
    agent["radius"][:] = _RADIUS
    times, walls = np.zeros(len(asked)), rows_of(1, WALL)
    functions = np.array([address_of(prepare, PREPARE), address_of(_time, EXCESS)])
    _ask(functions, (agent, near, walls, 0, 0.0), params, work, asked, times)
    return times, int(work[0, 0])


def first_walls(walls: Any, asked: Array, until: float = 0.0) -> Array:
    """Times of the first collision with walls at velocities (K, 2) of up to 10 m/s, s."""
    agent, work = rows_of(1, AGENT), np.zeros((len(walls) + 1, WORK_COLUMNS))
    agent["radius"][:] = _RADIUS
    times, params = np.zeros(len(asked)), np.array([_FAR, 0.0, 0.0, 0.0, 10.0, math.inf])
    functions = np.array([address_of(_all, PREPARE), address_of(_time, EXCESS)])
    scene = agent, rows_of(0, NEIGHBOUR), walls, len(walls), until
    _ask(functions, scene, params, work, asked, times)
    return times


def walls_around(rng: np.random.Generator, count: int) -> Any:
    """Walls at any angle of up to 12 m, every other one on from the one before; none is touched."""
    walls: Any = rows_of(count, WALL)
    distance, angle = rng.uniform(0.5, 15.0, count), rng.uniform(0.0, 2.0 * math.pi, count)
    ax, ay = distance * np.cos(angle), distance * np.sin(angle)
    turn, length = (
        rng.integers(0, 16, count) * (math.pi / 8.0),
        rng.choice([0.001, 1.0, 12.0], count),
    )
    bx, by = ax + length * np.cos(turn), ay + length * np.sin(turn)
    ax[1::2], ay[1::2] = bx[: len(bx[1::2]) * 2 : 2], by[: len(by[1::2]) * 2 : 2]
    ends = np.column_stack([ax, ay, bx, by])
    nx, ny = np.array([nearest_on_segment(0.0, 0.0, *each) for each in ends.tolist()]).T
    columns = (*ends.T, nx, ny, nx * nx + ny * ny)
    for name, column in zip(("ax", "ay", "bx", "by", "nx", "ny", "d2"), columns, strict=True):
        walls[name] = column
    return walls[walls["d2"] > _RADIUS**2]


def neighbours(rng: np.random.Generator, count: int) -> Any:
    """Discs at most 30 m away that touch nobody yet."""
    near: Any = rows_of(count, NEIGHBOUR)
    distance, angle = rng.uniform(1.0, 30.0, count), rng.uniform(0.0, 2.0 * math.pi, count)
    near["rx"], near["ry"] = distance * np.cos(angle), distance * np.sin(angle)
    near["nvx"], near["nvy"] = rng.normal(0.0, 1.0, (count, 2)).T
    near["d2"] = near["rx"] ** 2 + near["ry"] ** 2
    near["reach"] = 2.0 * _RADIUS
    return near


@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 150),
    spread=st.sampled_from([0.0, 0.2, 1.0, 3.0]),
    horizon=st.sampled_from([0.5, 5.0, 1e300]),
)
def test_what_is_left_out_is_not_met_before_the_horizon(
    seed: int, count: int, spread: float, horizon: float
) -> None:
    rng = np.random.default_rng(seed)
    near, (ux, uy) = neighbours(rng, count), rng.normal(0.0, 1.0, 2)
    angle, length = rng.uniform(0.0, 2.0 * math.pi, 40), spread * rng.uniform(0.0, 1.0, 40)
    asked = np.column_stack([ux + length * np.cos(angle), uy + length * np.sin(angle)])
    params = np.array([_FAR, 0.0, ux, uy, spread * (1.0 + 1e-9) + 1e-12, horizon])
    whole, listed = first_collisions(_all, near, params, asked)
    assert listed == count
    found, fewer = first_collisions(_some, near, params, asked)
    assert fewer <= count
    before = whole < horizon
    np.testing.assert_array_equal(found[before], whole[before])
    assert (found[~before] >= horizon).all()


def test_the_order_of_neighbours_changes_no_time() -> None:
    rng = np.random.default_rng(7)
    near, asked = neighbours(rng, 120), rng.normal(0.0, 1.0, (200, 2))
    params = np.array([_FAR, 0.0, 0.0, 0.0, 10.0, math.inf])
    times, _ = first_collisions(_all, near, params, asked)
    alone = [first_collisions(_all, one, params, asked)[0] for one in near.reshape(-1, 1)]
    np.testing.assert_array_equal(times, np.min(alone, axis=0))
    for _ in range(5):
        again, _ = first_collisions(_all, rng.permutation(near), params, asked)
        np.testing.assert_array_equal(again, times)


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 120))
def test_walls_behind_others_change_no_time(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    walls, asked = walls_around(rng, count), rng.normal(0.0, 1.0, (40, 2))
    asked[::4] = asked[::4] @ np.array([[1.0, 0.0], [0.0, 1e-7]])  # along the walls, nearly
    assume(len(walls))
    times = first_walls(walls, asked)
    alone = [first_walls(one, asked) for one in walls.reshape(-1, 1)]
    np.testing.assert_array_equal(times, np.min(alone, axis=0))
    until = float(np.median(times))
    soon = first_walls(walls, asked, until)
    np.testing.assert_array_equal(soon < until, times < until)
    np.testing.assert_array_equal(soon[times >= until], times[times >= until])


def test_a_narrow_disc_of_velocities_leaves_most_out() -> None:
    near = neighbours(np.random.default_rng(3), 150)
    near["nvx"], near["nvy"] = 1.3, 0.0  # all walk as the agent does
    params = np.array([_FAR, 0.0, 1.3, 0.0, 0.01, 100.0])
    _, listed = first_collisions(_some, near, params, np.array([[1.3, 0.0]]))
    assert 0 < listed < 15
