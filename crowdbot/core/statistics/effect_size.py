"""Cohen's d of paired differences, with an interval that stays finite with few crowd draws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import crowdbot.core.statistics.clusters as c
from crowdbot.core.statistics.clusters import Clusters, Floats
from crowdbot.core.statistics.estimate import Estimate

ONE_PAIR = "one pair: no spread"
ALL_EQUAL = "all differences are equal"
_LARGE_T = 1000.0  # beyond, quantiles of the noncentrality are proportional to t


def effect_size(gains: Floats, groups: Clusters, level: float = 0.95) -> Estimate:
    """Return the mean of differences in units of their standard deviation.

    The interval inverts the noncentral t distribution (Steiger & Fouladi 1997, in "What if there
    were no significance tests?", 9) with the degrees of freedom of the draws; the standard error
    between draws converts the noncentrality to d. It contains 0 exactly if Student's interval of
    the mean does. A bootstrap would be unbounded with few draws, since resamples repeat a draw and
    have almost no spread.

    Args:
        gains: (n,) differences of pairs.
        groups: clusters of the same pairs.
        level: confidence level of the interval.
    """
    if len(gains) < 2:
        return Estimate(reason=ONE_PAIR)
    if np.ptp(gains) <= 1e-12 * float(np.abs(gains).max()):
        return Estimate(reason=ALL_EQUAL)
    gains = gains / float(np.abs(gains).max())  # squares of large numbers overflow
    centre, spread = float(gains.mean()), float(gains.std(ddof=1))
    estimate = Estimate(value=centre / spread)
    error = c.ratio_error(gains, np.ones_like(gains), groups)
    if error is None:
        return replace(estimate, reason=c.ONE_DRAW)
    if error == 0.0:
        return replace(estimate, reason=c.NO_SPREAD)
    low, high = _noncentrality(centre / error, groups.freedom, level)
    return replace(estimate, low=low * error / spread, high=high * error / spread)


def _noncentrality(t: float, freedom: int, level: float) -> tuple[float, float]:
    """Return the noncentralities for which a noncentral t is as low, or as high, as this one."""
    from scipy.special import nctdtrinc

    scale = max(1.0, abs(t) / _LARGE_T)
    low, high = (
        float(nctdtrinc(freedom, p, t / scale)) for p in (0.5 + level / 2, 0.5 - level / 2)
    )
    return low * scale, high * scale
