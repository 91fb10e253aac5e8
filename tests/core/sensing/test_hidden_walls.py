"""A wall that hides another from a whole square hides it from each point of it."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.sensing.hidden_walls import hidden_walls
from crowdbot.core.types.arrays import Array, Mask

NUMBER = st.floats(-6.0, 6.0)
WALL = st.tuples(NUMBER, NUMBER, NUMBER, NUMBER)


def _hidden(walls: Array, heights: Array) -> tuple[Mask, tuple[float, float]]:
    hidden = np.zeros(len(walls), np.bool_)
    order = np.argsort(np.hypot(*(0.5 * (walls[:, :2] + walls[:, 2:])).T), kind="stable")
    return hidden, hidden_walls(0.0, 0.0, 0.5, walls, heights, order, hidden)


def _meets(a: Array, b: Array, wall: Array) -> bool:
    d, e, p = b - a, wall[2:] - wall[:2], wall[:2] - a
    across = d[0] * e[1] - d[1] * e[0]
    if across == 0.0:
        return False
    way, along = (p[0] * e[1] - p[1] * e[0]) / across, (p[0] * d[1] - p[1] * d[0]) / across
    return bool(0.0 <= way <= 1.0 and 0.0 <= along <= 1.0)


@given(st.lists(WALL, min_size=2, max_size=8), st.integers(0, 2**32 - 1))
def test_no_point_sees_a_hidden_wall(given_walls: list[tuple[float, ...]], seed: int) -> None:
    walls, rng = np.array(given_walls), np.random.default_rng(seed)
    hidden, _ = _hidden(walls, np.tile([0.0, 2.0], (len(walls), 1)))
    for far in np.flatnonzero(hidden):
        for _ in range(20):
            a, share = rng.uniform(-0.5, 0.5, 2), rng.uniform()
            b = walls[far, :2] + share * (walls[far, 2:] - walls[far, :2])
            assert any(_meets(a, b, wall) for i, wall in enumerate(walls) if i != far)


def test_a_low_wall_does_not_hide_a_high_one_nor_what_is_beside_it() -> None:
    walls = np.array([[2.0, -2.0, 2.0, 2.0], [3.0, -1.0, 3.0, 1.0], [3.0, 1.0, 3.0, 9.0]])
    heights = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]])
    hidden, heights_of_sensor = _hidden(walls, heights)
    assert hidden.tolist() == [False, True, False]
    assert heights_of_sensor == (0.0, 1.0)
    heights[1, 1] = 1.5
    assert not _hidden(walls, heights)[0].any()
