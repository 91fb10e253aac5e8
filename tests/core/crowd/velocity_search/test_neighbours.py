"""Neighbours, against a plain search."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd.velocity_search.neighbours import (
    DISC,
    START_ROWS,
    gather,
    sort_discs,
    strip_height,
)
from crowdbot.core.crowd.velocity_search.records import NEIGHBOUR
from crowdbot.core.support.records import rows_of


@pytest.mark.parametrize("seed", range(6))
def test_neighbours_are_those_of_a_plain_search(seed: int) -> None:
    """In a crowd, in a column, in a row, around an outlier, at equal places."""
    rng = np.random.default_rng(seed)
    count = 150
    discs: Any = rows_of(count, DISC)
    at = rng.uniform(-15.0, 15.0, (count, 2)) * ((1, 1), (0, 1), (1, 0))[seed % 3]
    discs["radius"], discs["index"] = rng.uniform(0.2, 0.5, count), np.arange(count)
    at[0] = (1e6, -1e6) if seed > 2 else at[1]
    discs["x"], discs["y"] = at.T
    for distance in (0.5, 3.0, 1e7):
        table = rows_of(count, DISC)
        height = strip_height(discs, count, distance)
        rows, order = np.zeros((START_ROWS, 2), np.int64), np.zeros((2, count), np.int64)
        low, strips = sort_discs(discs, count, height, table, rows, order)
        starts = rows[: strips + 1]
        assert np.array_equal(np.sort(table["index"]), np.arange(count))
        near = rows_of(count, NEIGHBOUR)
        placed = np.column_stack([table["x"], table["y"]])
        for me in range(0, count, 7):
            found = gather(table, starts, low, height, me, distance, near)
            offset = placed - placed[me]
            expected = np.sum(offset * offset, axis=1) < distance * distance
            expected[me] = False
            assert found == np.count_nonzero(expected)
            assert np.allclose(
                sorted(near["d2"][:found]), sorted(np.sum(offset * offset, axis=1)[expected])
            )
