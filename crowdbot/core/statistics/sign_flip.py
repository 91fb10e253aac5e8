"""Sign-flip test of a mean difference, with the crowd draw as the random unit.

Under "no difference", exchanging the planners' names within a draw leaves the distribution as it
is: it turns the sign of all of the draw's differences at once. The test compares a statistic of the
differences with its values after exchanges, so it keeps its level for any correlation within a
draw, and with few and unequal draws.

The statistic is Student's t within strata, corrected for skewness by Hall's transformation (1992,
Journal of the Royal Statistical Society B 54:221). Studentised, the test also holds approximately
where means are equal but distributions are not (Janssen 1997, Statistics & Probability Letters
36:9), and conditions that favour different planners cost no power. The correction matters where a
planner is usually a little better and rarely worth nothing: without it such a planner is found to
be better too often. The skewness is that of the draws about zero, the mean under "no difference":
about its own mean, one bad draw of 36 would hide any gain, since Hall's transformation has a
horizontal tangent at t = -3 / skewness.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Clusters, Floats
from crowdbot.dsl.scenario.seeds import stream_seed

_EXACT = 13  # draws: all 2**12 flips up to the sign of the whole
#: Random flips in each step; a step follows if the p value so far is below the limit.
_STEPS = ((2_000, 1.0), (18_000, 0.2), (80_000, 0.005))
_AT_ONCE = 2_000
_ROUNDING = 1e-9  # statistics with a smaller relative difference are equal


def p_value(gains: Floats, clusters: Clusters) -> float:
    """Return the two-sided p: how often flipped draws give a statistic at least as far from zero.

    Exact for up to 13 draws, else by Monte Carlo with random numbers that depend on the draws'
    names only.

    Args:
        gains: (n,) differences of single pairs, or their contributions to one of rates.
        clusters: clusters of the same pairs.
    """
    sums = clusters.sums(gains)
    size = float(np.abs(sums).max(initial=0.0))
    if not abs(float(sums.sum())) > _ROUNDING * size or clusters.count < 2:
        return 1.0
    statistic = _Statistic(sums / size, clusters)  # squares of large numbers overflow
    if clusters.count <= _EXACT:
        return float(statistic.reached(_all_signs(clusters.count)).mean())
    return _by_chance(statistic, clusters)


class _Statistic:
    """Hall's transformed t of the sum of flipped draws."""

    def __init__(self, sums: Floats, clusters: Clusters) -> None:
        self._order = np.argsort(clusters.stratum, kind="stable")
        self._sums = sums[self._order]
        self._cubes = self._sums**3
        _, self._starts = np.unique(clusters.stratum[self._order], return_index=True)
        self._squares = np.add.reduceat(self._sums**2, self._starts)
        self._alike = clusters.alike[self._order][self._starts]
        self._seen = abs(float(self._of(np.ones((1, len(sums)), np.int8))[0]))

    def reached(self, signs: NDArray[np.int8]) -> NDArray[np.bool_]:
        """Return a mask of rows of signs whose statistic is at least as large as observed."""
        found = np.abs(self._of(signs[:, self._order]))
        return np.asarray(found >= self._seen * (1.0 - _ROUNDING))

    def _of(self, signs: NDArray[np.int8]) -> Floats:
        n = self._alike
        parts = np.add.reduceat(signs * self._sums, self._starts, axis=1)
        cubes = np.add.reduceat(signs * self._cubes, self._starts, axis=1)
        variance = (self._squares - parts**2 / n) @ (n / (n - 1.0))
        variance = np.maximum(variance, 0.0) + _ROUNDING * float(self._squares.sum())
        if n.min() < 3.0:  # a stratum of two has no third moment: that of all draws
            parts, cubes = (x.sum(axis=1, keepdims=True) for x in (parts, cubes))
            n, squares = n.sum(keepdims=True), self._squares.sum(keepdims=True)
        else:
            squares = self._squares
        third, count = _third(parts, squares, cubes, n), float(len(self._sums))
        return _hall(parts.sum(axis=1), variance, third, count)


def _third(parts: Floats, squares: Floats, cubes: Floats, n: Floats) -> Floats:
    """Return the third cumulant of the sum from power sums of each stratum (flips, strata)."""
    if n.min() < 3.0:
        return np.zeros(len(parts))
    mean = parts / n
    central = cubes - 3.0 * mean * squares + 2.0 * n * mean**3
    return np.asarray(central @ (n**2 / ((n - 1.0) * (n - 2.0))))


def _hall(total: Floats, variance: Floats, third: Floats, count: float) -> Floats:
    """Return t = total / error with its skewness removed; odd in the sign of the data."""
    t, skew = total / np.sqrt(variance), third / variance**1.5
    skew = _about_zero(skew, t, count)
    return np.asarray(t + skew * (t**2 / 3.0 + 1.0 / 6.0) + skew**2 * t**3 / 27.0)


def _about_zero(skew: Floats, t: Floats, count: float) -> Floats:
    """Return the skewness of a sum of ``count`` draws with moments about zero, not the mean."""
    return np.asarray((skew + 3.0 * t / count + t**3 / count**2) / (1.0 + t**2 / count) ** 1.5)


def _by_chance(statistic: _Statistic, clusters: Clusters) -> float:
    """Estimate p by random flips; small p values get more of them."""
    flips, reached, p = 0, 0, 0.0
    signs = _random_signs(clusters)
    for count, limit in _STEPS:
        if p > limit:
            break
        for start in range(0, count, _AT_ONCE):
            found = statistic.reached(next(signs)[: count - start])
            flips, reached = flips + len(found), reached + int(found.sum())
        p = (1 + reached) / (1 + flips)
    return p


def _random_signs(clusters: Clusters) -> Iterator[NDArray[np.int8]]:
    key = hashlib.sha256("\0".join(clusters.names).encode()).hexdigest()
    rng = np.random.Generator(np.random.PCG64(stream_seed(0, key, "statistics.sign_flip")))
    while True:
        drawn = rng.integers(0, 2, size=(_AT_ONCE, clusters.count), dtype=np.int8)
        yield 2 * drawn - np.int8(1)


def _all_signs(count: int) -> NDArray[np.int8]:
    """Return all rows of signs of this many draws; the last sign is always +, by symmetry."""
    bits = np.arange(2 ** (count - 1))[:, np.newaxis] >> np.arange(count) & 1
    return (1 - 2 * bits).astype(np.int8)


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
