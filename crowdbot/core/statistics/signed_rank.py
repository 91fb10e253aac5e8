"""Signed ranks of pairs, which describe how often and how clearly one planner is better."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Floats


def double_ranks(contrasts: Floats) -> NDArray[np.int64]:
    """Return twice the ranks of the absolute values, as integers; ties share their mean rank.

    Infinite contrasts tie at the top; zeros are ranked too, as in Pratt (1959).
    """
    _, inverse, counts = np.unique(np.abs(contrasts), return_inverse=True, return_counts=True)
    return np.asarray((2 * np.cumsum(counts) - counts + 1)[inverse], dtype=np.int64)


def signed_ranks(contrasts: Floats, ranks: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return `double_ranks` with the signs of the contrasts; those of zeros are 0."""
    return np.sign(contrasts).astype(np.int64) * ranks
