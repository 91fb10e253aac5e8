"""Who is near whom, against a plain search."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd.velocity_search.cost import D2, NEAR_COLUMNS
from crowdbot.core.crowd.velocity_search.neighbours import (
    DISC_COLUMNS,
    DISC_RADIUS,
    INDEX,
    gather,
    sort_discs,
    strip_height,
)


@pytest.mark.parametrize("seed", range(6))
def test_neighbours_are_those_of_a_plain_search(seed: int) -> None:
    """In a crowd, in a column, in a row, around an outlier, at equal places."""
    rng = np.random.default_rng(seed)
    count = 150
    discs = np.zeros((count, DISC_COLUMNS))
    discs[:, :2] = rng.uniform(-15.0, 15.0, (count, 2)) * ((1, 1), (0, 1), (1, 0))[seed % 3]
    discs[:, DISC_RADIUS], discs[:, INDEX] = rng.uniform(0.2, 0.5, count), np.arange(count)
    discs[0, :2] = (1e6, -1e6) if seed > 2 else discs[1, :2]
    for distance in (0.5, 3.0, 1e7):
        table = np.zeros_like(discs)
        height = strip_height(discs, count, distance)
        low, starts = sort_discs(discs, count, height, table)
        assert np.array_equal(np.sort(table[:, INDEX]), np.arange(count))
        near = np.zeros((count, NEAR_COLUMNS))
        for me in range(0, count, 7):
            found = gather(table, starts, low, height, me, distance, near)
            offset = table[:, :2] - table[me, :2]
            expected = np.sum(offset * offset, axis=1) < distance * distance
            expected[me] = False
            assert found == np.count_nonzero(expected)
            assert np.allclose(
                sorted(near[:found, D2]), sorted(np.sum(offset * offset, axis=1)[expected])
            )
