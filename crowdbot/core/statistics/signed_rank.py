"""Wilcoxon's signed-rank test with the crowd draw as the random unit.

Ranks are given to all pairs and signs are flipped for whole draws together: under "no difference",
exchanging the planners' names within a draw leaves the distribution as it is. This holds for any
correlation within a draw, so the test keeps its level with few and with unequal draws; Wilcoxon's
own table assumes independent pairs. With one pair per draw both tests are the same.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Clusters, Floats

_EXACT_DRAWS = 24  # 2**12 sums of either half
_EXACT_TOTAL = 200_000  # largest length of an exact distribution with more draws


def double_ranks(contrasts: Floats) -> NDArray[np.int64]:
    """Return twice the ranks of the absolute values, as integers; ties share their mean rank.

    Infinite contrasts tie at the top; zeros are ranked too, as in Pratt (1959).
    """
    _, inverse, counts = np.unique(np.abs(contrasts), return_inverse=True, return_counts=True)
    return np.asarray((2 * np.cumsum(counts) - counts + 1)[inverse], dtype=np.int64)


def signed_ranks(contrasts: Floats) -> NDArray[np.int64]:
    """`double_ranks` with the signs of the contrasts; those of zeros are 0."""
    return np.sign(contrasts).astype(np.int64) * double_ranks(contrasts)


def p_value(ranks: NDArray[np.int64], clusters: Clusters) -> float:
    """Return the two-sided p: how often flipped draws give a rank sum at least as far from zero.

    Exact for up to 24 draws, and for more while the sums are small; otherwise a normal
    approximation.
    """
    sums = np.rint(clusters.sums(ranks.astype(float))).astype(np.int64)
    seen, parts = abs(int(sums.sum())), np.abs(sums[sums != 0])
    if not seen:
        return 1.0
    if len(parts) <= _EXACT_DRAWS:
        return _by_halves(parts, seen)
    if parts.sum() <= _EXACT_TOTAL:
        return _by_sums(parts, seen)
    spread = float(np.sqrt(np.sum(parts.astype(float) ** 2)))
    return math.erfc(seen / spread / math.sqrt(2))


def _by_halves(parts: NDArray[np.int64], seen: int) -> float:
    """Compute p from all 2**G sums by meet-in-the-middle; twice the upper tail."""
    half = len(parts) // 2
    first, second = _all_sums(parts[:half]), np.sort(_all_sums(parts[half:]))
    reached = len(second) - np.searchsorted(second, seen - first, side="left")
    return min(1.0, float(reached.sum()) * 2.0 ** (1 - len(parts)))


def _all_sums(parts: NDArray[np.int64]) -> NDArray[np.int64]:
    found = np.zeros(1, dtype=np.int64)
    for part in parts:
        found = np.concatenate([found + part, found - part])
    return found


def _by_sums(parts: NDArray[np.int64], seen: int) -> float:
    """Compute p from the distribution of the positive sum, draw by draw."""
    total = int(parts.sum())
    chance = np.zeros(total + 1)
    chance[0] = 1.0
    for part in parts:
        moved = np.zeros_like(chance)
        moved[part:] = chance[: total + 1 - part]
        chance = (chance + moved) / 2
    least = -((-(seen + total)) // 2)  # S = 2 P - total >= seen
    return min(1.0, 2 * float(chance[least:].sum()))


def least_p(draws: int) -> float:
    """Return the smallest p that this many draws can give."""
    return float(2.0 ** (1 - draws))


def holm(p_values: Floats) -> Floats:
    """Return Holm's step-down adjustment (1979), which controls the family-wise error rate."""
    order = np.argsort(p_values, kind="stable")
    factors = len(p_values) - np.arange(len(p_values))
    adjusted = np.minimum(1.0, np.maximum.accumulate(p_values[order] * factors))
    result = np.empty_like(adjusted)
    result[order] = adjusted
    return result
