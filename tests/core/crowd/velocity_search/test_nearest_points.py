"""The points that a cell lists are those of all walls around, each once."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.floor import floor_of
from crowdbot.core.crowd.velocity_search.nearest_points import write_nearest_points
from crowdbot.core.crowd.velocity_search.point_grid import SAME_POINT, point_grid
from crowdbot.core.crowd.velocity_search.records import AGENT
from crowdbot.core.support.records import rows_of
from crowdbot.core.types.arrays import Array

REACH, FADING = 3.0, 0.5


def rooms(rng: np.random.Generator) -> Array:
    """Walls that share corners, cross, lie on each other, and nearly meet."""
    corners = rng.integers(0, 13, (60, 2)) * 1.5
    ends = rng.integers(0, len(corners), (90, 2))
    beside = corners[rng.integers(0, len(corners), 40)] + rng.choice([0.0, 0.75, 1.5], (40, 2))
    walls = np.vstack([
        np.hstack([corners[ends[:, 0]], corners[ends[:, 1]]]),
        np.hstack([corners[:40], beside]),
        np.hstack([beside, corners[:40]])[::2],
    ])  # fmt: skip
    nearly = SAME_POINT * rng.choice([-3.0, -0.6, 0.6, 3.0], walls.shape)
    walls = walls + np.where(rng.random(walls.shape) < 0.2, nearly, 0.0)
    walls[: len(walls) // 2, 2:] = walls[: len(walls) // 2, :2] + 0.3 * (
        walls[: len(walls) // 2, 2:] - walls[: len(walls) // 2, :2]
    )
    return np.ascontiguousarray(rng.permutation(walls))


def points(walls: Array, x: float, y: float) -> Array:
    """The nearest points (S, 2) of all walls, m, relative to (x, y)."""
    ends = walls - np.array([x, y, x, y])
    return np.array([nearest_on_segment(0.0, 0.0, *wall) for wall in ends.tolist()])


def listed(walls: Array, x: float, y: float) -> tuple[Array, float, float]:
    """The points (P, 2) that count to someone at (x, y), and the two other results."""
    kept, address = floor_of(walls, 0.3, (REACH, FADING))
    agent, work = rows_of(1, AGENT), np.zeros(16 * len(walls) + 72)
    agent["px"][:], agent["py"][:], agent["floor"][:] = x, y, address
    count, within, others = write_nearest_points(agent[0], work)
    del kept
    found = work[: 3 * count].reshape(3, count)
    return found[:2, found[2] == 1.0].T, within, others


@pytest.mark.parametrize("seed", range(6))
def test_each_point_within_reach_is_listed_once_and_in_order(seed: int) -> None:
    rng = np.random.default_rng(seed)
    walls, short = rooms(rng), 0
    for x, y in [*rng.uniform(-2.0, 20.0, (40, 2)), *rng.integers(0, 13, (20, 2)) * 1.5]:
        every = points(walls, x, y)
        gap = np.abs(every[:, np.newaxis] - every[np.newaxis]).max(axis=2)
        once = every[~np.any(np.tril(gap <= SAME_POINT, -1), axis=1)]
        found, within, _ = listed(walls, x, y)
        assert within > REACH - 0.2
        assert np.array_equal(found[np.hypot(*found.T) < within], once[np.hypot(*once.T) < within])
        short += len(found) < len(every)
    assert short > 30


def test_walls_that_are_not_listed_count_as_many_as_they_weigh() -> None:
    rng = np.random.default_rng(3)
    walls = rooms(rng)
    for x, y in rng.uniform(-2.0, 20.0, (60, 2)):
        found, within, others = listed(walls, x, y)
        distances = np.hypot(*points(walls, x, y).T)
        there = np.isclose(distances[:, np.newaxis], np.hypot(*found.T), atol=1e-7).any(axis=1)
        weights = np.exp((within - distances[~there]) / FADING)
        assert weights.sum() <= others < 10.0 * weights.sum() + 1.0


def test_few_walls_are_all_listed_everywhere_and_none_far_outside() -> None:
    walls = rooms(np.random.default_rng(4))
    _, within, others = listed(walls[:5].copy(), 500.0, 500.0)
    assert (within, others) == (np.inf, 0.0)
    found, within, others = listed(walls, 500.0, 500.0)
    assert (len(found), within, others) == (0, REACH, len(walls))
    assert len(listed(np.zeros((0, 4)), 1.0, 1.0)[0]) == 0


def test_corners_that_are_nearest_everywhere_in_a_cell_are_listed_once() -> None:
    walls = rooms(np.random.default_rng(5))
    grid = point_grid(walls, REACH, FADING)
    assert len(grid.walls) < 0.8 * len(walls) * (len(grid.first) - 1)
    assert np.all(grid.pairs[:, 0] > grid.pairs[:, 1])
