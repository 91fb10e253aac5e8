"""What a score of a planner is in the mean, and how far two planners are apart: one estimator.

Report, leaderboard, floors and audit all call it. Means of runs stay within the bounds of the
score. Rates are those of all runs together: the sum of what was counted over the sum of what it is
a rate over, and not the mean of each run's quotient, which those runs rule that hardly got
anywhere.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Bounds, Floats
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.table import Name, Table


def planner_mean(table: Table, name: Name, planner: str, level: float = 0.95) -> Estimate:
    """Mean of one planner's values, or the rate of all its runs, with its interval."""
    column, scale = table.column(name, planner), table.scale(name)
    bounds = scale.minimum, scale.maximum
    step = 1.0 if scale.integer else 0.0
    exposure = table.exposure(name, planner)
    if exposure is None:
        values = column.low[column.known]
        return c.mean(values, table.clusters.part(column.known), level, bounds, step)
    known = column.known & np.isfinite(exposure)
    below = exposure[known]
    above = column.low[known] * below
    return c.ratio(above, below, table.clusters.part(known), level, bounds, step)


def rate_difference(
    table: Table, name: Name, pair: tuple[str, str], chosen: NDArray[np.bool_], level: float = 0.95
) -> tuple[Estimate, float | None] | None:
    """Rate of one planner minus that of another, and its standard error; None of other scores.

    Linearised as `clusters.ratio` is: what each run adds to the difference, draw by draw.

    Args:
        table: of the runs.
        name: the score.
        pair: the planners.
        chosen: (n,) rows in which both have a value.
        level: of the interval.
    """
    sides = []
    for planner in pair:
        exposure = table.exposure(name, planner)
        if exposure is None:
            return None
        sides.append((table.column(name, planner).low, exposure))
    both = chosen & np.all([np.isfinite(exposure) for _, exposure in sides], axis=0)
    groups = table.clusters.part(both)
    if not both.any():
        return Estimate(reason=c.NO_RUNS), None
    rates, parts = zip(*(_parts(v[both], y[both]) for v, y in sides), strict=True)
    value = rates[0] - rates[1]
    added = parts[0] - parts[1]
    error = c.ratio_error(added, np.ones_like(added), groups)
    if error is None:
        return Estimate(value=value, reason=c.ONE_DRAW), None
    half = error * c.quantile_t(0.5 + level / 2, groups.freedom)
    reason = "" if error > 0 else c.NO_SPREAD
    return Estimate(value=value, low=value - half, high=value + half, reason=reason), error


def _parts(rates: Floats, exposure: Floats) -> tuple[float, Floats]:
    """The rate of all runs, and what each adds to its deviation, times the number of runs."""
    whole = float(exposure.sum())
    rate = float((rates * exposure).sum()) / whole
    return rate, (rates - rate) * exposure * (len(rates) / whole)


def bounds_of_difference(table: Table, name: Name) -> Bounds:
    """How far two values of a score can be apart, where that is known."""
    scale = table.scale(name)
    width = scale.maximum - scale.minimum
    return (-width, width) if math.isfinite(width) else c.UNBOUNDED
