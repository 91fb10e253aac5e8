"""Walls that others hide from a whole square are hidden from each point of it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.sensing.hidden_walls import hidden_walls
from crowdbot.core.types.arrays import Array, Mask

NUMBER = st.floats(-6.0, 6.0)
WALL = st.tuples(NUMBER, NUMBER, NUMBER, NUMBER)
HALVES = st.integers(-12, 12).map(lambda n: 0.5 * n)
CORNERS = st.lists(st.tuples(HALVES, HALVES), min_size=2, max_size=7)


def _hidden(walls: Array, heights: Array, sensor: float = 0.5) -> Mask:
    hidden = np.zeros(len(walls), np.bool_)
    order = np.argsort(np.hypot(*(0.5 * (walls[:, :2] + walls[:, 2:])).T), kind="stable")
    hidden_walls((0.0, 0.0, 0.5), (sensor, sensor), walls, heights, order, hidden)
    return hidden


def _meets(a: Array, b: Array, wall: Array) -> bool:
    d, e, p = b - a, wall[2:] - wall[:2], wall[:2] - a
    across = d[0] * e[1] - d[1] * e[0]
    if across == 0.0:
        return False
    way, along = (p[0] * e[1] - p[1] * e[0]) / across, (p[0] * d[1] - p[1] * d[0]) / across
    return bool(0.0 <= way < 1.0 and -1e-9 <= along <= 1.0 + 1e-9)


def _check_that_each_way_is_crossed(walls: Array, seed: int) -> None:
    rng = np.random.default_rng(seed)
    hidden = _hidden(walls, np.tile([0.0, 2.0], (len(walls), 1)))
    for far in np.flatnonzero(hidden):
        for _ in range(20):
            a, share = rng.uniform(-0.5, 0.5, 2), rng.uniform()
            b = walls[far, :2] + share * (walls[far, 2:] - walls[far, :2])
            assert any(_meets(a, b, wall) for i, wall in enumerate(walls) if i != far)


@given(st.lists(WALL, min_size=2, max_size=8), st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_no_point_sees_a_hidden_wall(walls: list[tuple[float, ...]], seed: int) -> None:
    _check_that_each_way_is_crossed(np.array(walls), seed)


@given(st.lists(CORNERS, min_size=1, max_size=6), st.integers(0, 2**32 - 1))
@settings(max_examples=100)
def test_no_point_sees_what_joined_walls_hide(
    lines: list[list[tuple[float, float]]], seed: int
) -> None:
    walls = [[*a, *b] for line in lines for a, b in pairwise(line)]
    _check_that_each_way_is_crossed(np.array(walls), seed)


def test_a_corner_hides_what_neither_of_its_walls_hides() -> None:
    far = [5.0, 2.5, 2.5, 5.0]
    corner = np.array([[4.0, -1.0, 3.0, 3.0], [3.0, 3.0, -1.0, 4.0], far])
    heights = np.tile([0.0, 2.0], (3, 1))
    assert _hidden(corner, heights).tolist() == [False, False, True]
    longer = np.array([[0.0, 0.0, -0.1, 0.4], [0.4, -0.1, 0.0, 0.0], [0.0] * 4])
    assert _hidden(corner + longer, heights).tolist() == [False, False, True]
    for index in (0, 1):
        assert not _hidden(np.delete(corner, index, 0), heights[:2]).any()
    opened = corner.copy()
    opened[0, 3] -= 1e-3  # a gap in the corner
    assert not _hidden(opened, heights).any()


def test_a_low_wall_does_not_hide_a_high_one_nor_what_is_beside_it() -> None:
    walls = np.array([[2.0, -2.0, 2.0, 2.0], [3.0, -1.0, 3.0, 1.0], [3.0, 1.0, 3.0, 9.0]])
    heights = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]])
    assert _hidden(walls, heights).tolist() == [False, True, False]
    assert not _hidden(walls, heights, sensor=1.1).any()
    heights[1, 1] = 1.5
    assert not _hidden(walls, heights).any()
