"""The shortest time to the goal among people whose ways are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugin import Array
from crowdbot.plugins.planners.oracle import time_to_go_build as grid
from crowdbot.plugins.planners.people_mpc.plan_world_build import (
    STEP,
    PlanWorld,
    TimeToGo,
    way_left,
)
from crowdbot.plugins.planners.shared.distance_field_build import DistanceField

SPEED, HORIZON, RADIUS, PERSON = 0.65, 8.0, 0.23, 0.25
LAYERS = round(HORIZON / STEP)


def _world(
    places: Array, cost: float, way: float = 0.0, away: float = 20.0, walls: Array | None = None
) -> PlanWorld:
    """A robot at the origin whose goal is in a direction; places (L, N, 2) of people."""
    c, s = math.cos(way), math.sin(way)
    goal, (values, costs, cell) = (away * c, away * s), grid.blank(HORIZON, SPEED)
    corner, field = grid.corner_of(0.0, 0.0, (c, s), cell), DistanceField()
    field.fill(np.full((1, 2), 100.0) if walls is None else walls, 0.0, 0.0)
    people = np.tile([PERSON, cost], (places.shape[1], 1))
    grid.fill(
        values, costs, places, people, (*corner, c, s, cell), goal, (RADIUS, SPEED),
        (field.values, field.corner),
    )  # fmt: skip
    known = TimeToGo(values, corner, (c, s), cell, grid.LAYER * STEP, 0.0)
    none = np.zeros((0, 5))
    return PlanWorld(
        none, np.zeros((0, 0, 2)), field.values, field.corner, np.zeros((1, 3)), goal,
        np.zeros(0), none, known,
    )  # fmt: skip


def _time(world: PlanWorld, x: float = 0.0, y: float = 0.0, t: float = 0.0) -> float:
    return way_left(world, x, y, t, SPEED) / SPEED


NOBODY = np.zeros((LAYERS, 0, 2))


@pytest.mark.parametrize("way", [0.0, 0.7, -2.5])
def test_among_nobody_the_straight_way_counts(way: float) -> None:
    world = _world(NOBODY, 10.0, way)
    c, s = math.cos(way), math.sin(way)
    assert _time(world) == pytest.approx(20.0 / SPEED, rel=1e-3)
    assert _time(world, 1.2 * c, 1.2 * s, 2.0) == pytest.approx(18.8 / SPEED, rel=1e-3)


def test_it_ends_at_the_goal() -> None:
    world = _world(NOBODY, 10.0, away=2.0)
    assert _time(world) == pytest.approx(2.0 / SPEED, abs=grid.LAYER * STEP)
    assert _time(world, 2.0, 0.0) == 0.0


def test_a_row_that_comes_is_gone_round() -> None:
    """People side by side, 3 m wide: the way round costs more, and costs nothing once past."""
    y = np.arange(-1.2, 1.3, 0.4)
    at = 4.0 - 0.5 * STEP * np.arange(1, LAYERS + 1)
    places = np.stack(np.broadcast_arrays(at[:, None], y[None]), axis=-1)
    world, free = _world(np.ascontiguousarray(places), 10.0), _world(NOBODY, 10.0)
    late = _time(world) - _time(free)
    aside = 1.2 + PERSON + RADIUS
    straight = 4.0 * SPEED / (SPEED + 0.5)
    least = (math.hypot(straight, aside) - straight) / SPEED
    assert 0.8 * least < late < least + 2.5
    assert _time(world, 0.0, aside) - _time(free, 0.0, aside) < 0.3 * late
    assert _time(world, 2.5, 0.0, 4.8) == pytest.approx(_time(free, 2.5, 0.0, 4.8), abs=0.05)


def test_who_gives_way_costs_less() -> None:
    places = np.tile([[[1.0, 0.0]]], (LAYERS, 1, 1))
    times = [_time(_world(places, cost)) for cost in (0.0, 0.1, 10.0)]
    assert times[0] == pytest.approx(20.0 / SPEED, rel=1e-3)
    assert times[0] < times[1] < times[2]


def test_walls_are_gone_round() -> None:
    wall = np.column_stack([np.full(60, 1.5), np.linspace(-1.5, 1.5, 60)])
    blocked, free = _world(NOBODY, 10.0, walls=wall), _world(NOBODY, 10.0)
    assert _time(blocked) > _time(free) + 0.5


def test_beyond_the_grid_the_distance_counts() -> None:
    world = _world(NOBODY, 10.0)
    assert _time(world, -3.0, 0.0) == pytest.approx(23.0 / SPEED)
    assert _time(world, 0.0, 0.0, 50.0) == pytest.approx(20.0 / SPEED)
