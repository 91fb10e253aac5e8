"""Intervals for runs that share crowd draws: the sample unit is the draw, not the run.

The 162 scenarios of the challenge use 18 drawn crowds. Runs with the same crowd are correlated, so
the sample has only 18 independent parts; docs/decisions/0014-statistics.md compares methods and
their coverage.

If each condition of a suite was run with several draws, conditions are strata: they are fixed by
the suite, and only people are random. An interval then shows the variation between people.
Otherwise conditions and people cannot be separated, and both count as random.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.estimate import Estimate

Floats = NDArray[np.float64]
#: Smallest and largest possible value.
Bounds = tuple[float, float]
UNBOUNDED: Bounds = (-math.inf, math.inf)

_ROUNDING = 1e-12
#: Rows of all remembered parts together, about 20 MB.
_REMEMBERED = 2_000_000

ONE_DRAW = "one crowd draw: its chance cannot be told from a difference"
NO_RUNS = "no run has a value"
NO_SPREAD = "no variation between crowd draws: the interval has no width"


@dataclass(frozen=True, eq=False)
class Clusters:
    """The crowd draw of each run.

    Attributes:
        index: (n,) index of the draw in ``names``.
        names: names of the draws, sorted.
        stratum: (count,) index of each draw's stratum: conditions linked by draws in which all of
            them were run.
    """

    index: NDArray[np.intp]
    names: tuple[str, ...]
    stratum: NDArray[np.intp]

    @staticmethod
    def of(names: Sequence[str], conditions: Sequence[str] | None = None) -> Clusters:
        """Build clusters from the draw and the condition of each run.

        Without conditions, or if a stratum has only one draw, all draws form one stratum.
        """
        different, index = np.unique(np.asarray(names, dtype=str), return_inverse=True)
        return Clusters(index, tuple(different.tolist()), _strata(index, conditions))

    @property
    def count(self) -> int:
        """Return the number of draws."""
        return len(self.names)

    @cached_property
    def strata(self) -> int:
        """Return the number of strata."""
        return int(np.count_nonzero(np.bincount(self.stratum)))

    @property
    def freedom(self) -> int:
        """Return the degrees of freedom: the number of draws minus the number of strata."""
        return self.count - self.strata

    @cached_property
    def alike(self) -> NDArray[np.float64]:
        """Return, for each draw, the number of draws in its stratum (count,)."""
        return np.bincount(self.stratum)[self.stratum].astype(np.float64)

    def part(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Clusters:
        """Return the clusters of some runs, by mask or index; draws without runs are removed.

        Many scores have values in the same runs: their part is computed once.
        """
        key = chosen.dtype.char.encode() + chosen.tobytes()
        found = self._parts.get(key)
        if found is None:
            if len(self._parts) * (1 + len(self.index)) > _REMEMBERED:
                self._parts.clear()
            found = self._parts[key] = self._part(chosen)
        return found

    @cached_property
    def _parts(self) -> dict[bytes, Clusters]:
        return {}

    def _part(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Clusters:
        index = self.index[chosen]
        there = np.bincount(index, minlength=self.count) > 0
        left = np.flatnonzero(there)
        kept = self.stratum[left]
        if len(kept) and np.bincount(kept)[kept].min() < 2:  # one draw gives no variance
            kept = np.zeros_like(kept)
        if len(left) == self.count:
            return Clusters(index, self.names, kept)
        return Clusters((np.cumsum(there) - 1)[index], tuple(compress(self.names, there)), kept)

    def sums(self, values: Floats) -> Floats:
        """Return the sum of each draw's values, (count,)."""
        found = np.bincount(self.index, weights=values, minlength=self.count)
        return found.astype(np.float64, copy=False)


def _strata(index: NDArray[np.intp], conditions: Sequence[str] | None) -> NDArray[np.intp]:
    """Return each draw's stratum (draws,); zeros if a stratum has a single draw."""
    draws = int(index.max()) + 1 if len(index) else 0
    together = np.zeros(draws, np.intp)
    if conditions is None or not draws:
        return together
    found, condition = np.unique(np.asarray(conditions, dtype=str), return_inverse=True)
    if len(np.unique(condition * draws + index)) == len(found):  # no condition has two draws
        return together
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    ties = coo_array(
        (np.ones(len(index)), (index, draws + condition)), shape=(draws + len(found),) * 2
    )
    stratum = connected_components(ties, directed=False)[1][:draws].astype(np.intp)
    return stratum if np.bincount(stratum)[stratum].min() > 1 else together


# ------------------------------------------------------------------------- means
def mean(
    values: Floats,
    clusters: Clusters,
    level: float = 0.95,
    bounds: Bounds = UNBOUNDED,
    step: float = 0.0,
) -> Estimate:
    """Return the mean of all runs, with Student's t over the draws, within bounds.

    Args:
        values: (n,).
        clusters: clusters of the same runs.
        level: confidence level of the interval.
        bounds: smallest and largest possible value.
        step: 1 for counts.
    """
    return ratio(values, np.ones_like(values), clusters, level, bounds, step)


def ratio(
    above: Floats,
    below: Floats,
    clusters: Clusters,
    level: float = 0.95,
    bounds: Bounds = UNBOUNDED,
    step: float = 0.0,
) -> Estimate:
    """Return sum over sum, with the linearised variance between draws and t of ``count`` - 1.

    With equal draws and ``below`` = 1 it is the t interval of the draws' means (Cochran, Sampling
    Techniques, 3rd ed., 6.3 and 9A). Within strata, the common part of a stratum's draws is not
    random (5A). The interval stays within ``bounds`` of the quotient, see `interval`.
    """
    if not len(above) or not below.sum():
        return Estimate(reason=NO_RUNS)
    value = float(above.sum() / below.sum())
    error = ratio_error(above, below, clusters)
    if error is None:
        return Estimate(value=value, reason=ONE_DRAW)
    t = quantile_t(0.5 + level / 2, clusters.freedom)
    if error > 0.0:
        low, high = interval(value, error, t, bounds)
        return Estimate(value=value, low=low, high=high)
    one = t**2 / clusters.count
    width = min((bounds[1] - bounds[0]) * one / (1.0 + one), _of_counts(one, below, step))
    low, high = _at_a_bound(value, bounds, width)
    return Estimate(value=value, low=low, high=high, reason=NO_SPREAD if low == high else "")


def _of_counts(one: float, below: Floats, step: float) -> float:
    return one * step * len(below) / float(below.sum()) if step else math.inf


def _at_a_bound(value: float, bounds: Bounds, width: float) -> tuple[float, float]:
    """Return the interval if all runs are equal; it has zero width unless at a bound."""
    least, most = bounds
    near = _ROUNDING * max(1.0, abs(value))
    if math.isfinite(width) and value <= least + near:
        return least, least + width
    if math.isfinite(width) and value >= most - near:
        return most - width, most
    return value, value


def interval(value: float, error: float, t: float, bounds: Bounds) -> tuple[float, float]:
    """Return the ends of an interval within the bounds.

    The means m for which ``(value - m)**2 <= t**2 V(m)``, where V is the sample's variance scaled
    to go to 0 linearly towards each bound, as for proportions and counts. Between 0 and 1 it is
    Wilson's score interval (1927) with the effective number of independent runs given by the
    variance between draws (Korn & Graubard 1998, Survey Methodology 24:193), above 0 the score
    interval of a Poisson rate with the dispersion of the sample; far from the bounds it is
    Student's.

    Args:
        value: the mean.
        error: its standard error, above 0.
        t: quantile.
        bounds: bounds of the mean.
    """
    below, above = value - bounds[0], bounds[1] - value
    if below <= 0.0 or above <= 0.0:  # the bounds do not apply
        return value - t * error, value + t * error
    one, other = error / below, error / above
    tilt, damping = t**2 * (one - other), 1.0 + t**2 * one * other
    root = math.hypot(tilt, 2.0 * t * math.sqrt(damping))
    low, high = (value + error * (tilt + sign * root) / (2.0 * damping) for sign in (-1.0, 1.0))
    return max(low, bounds[0]), min(high, bounds[1])


def ratio_error(above: Floats, below: Floats, clusters: Clusters) -> float | None:
    """Return the standard error of `ratio`; None with fewer than two draws."""
    total = float(below.sum())
    if clusters.count < 2:
        return None
    rest = clusters.sums(above - above.sum() / total * below)
    if clusters.strata > 1:
        common = np.bincount(clusters.stratum, weights=rest)[clusters.stratum]
        rest = rest - common / clusters.alike
    rest = rest * np.sqrt(clusters.alike / (clusters.alike - 1.0))
    scale = float(np.abs(above).sum())
    error = math.hypot(*rest.tolist()) / total  # no overflow
    return error if error > 1e-13 * scale / total else 0.0  # equal up to rounding


@lru_cache(maxsize=4096)
def quantile_t(p: float, freedom: float) -> float:
    """Return a quantile of Student's t."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, p))
