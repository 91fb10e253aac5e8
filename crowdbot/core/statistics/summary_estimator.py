"""The summary of a planner's score, and the difference of two planners: one estimator.

Report, leaderboard, ``results``, ranks by crowd, floors and audit all use it. Means of runs stay
within the bounds of the score. Rates are those of all runs together (sum of counts over sum of
exposure), not the mean of each run's quotient, which runs that barely move would dominate.
`data.js` of the report does the same for runs that a reader selects.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.statistics.clusters as c
from crowdbot.core.statistics.clusters import Bounds, Floats
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.table import Name, Table

#: The summary of a score: the share of yes, the rate of all runs together, or the mean.
Centre = Literal["share", "rate", "mean"]


def centre_of(table: Table, name: Name) -> Centre:
    """Return the summary of a score.

    It depends on the metric only, not on values or other planners.
    """
    scale = table.scale(name)
    if table.exposure_name(name) is not None:
        return "rate"
    return "share" if scale.integer and (scale.minimum, scale.maximum) == (0.0, 1.0) else "mean"


def planner_mean(
    table: Table,
    name: Name,
    planner: str,
    level: float = 0.95,
    rows: NDArray[np.bool_] | None = None,
) -> Estimate:
    """Return the mean of one planner's values, or its pooled rate, with its interval.

    Args:
        table: table of the runs.
        name: the score.
        level: confidence level of the interval.
        rows: (n,) mask of rows to use; default all.
    """
    whole = np.ones(len(table.keys), np.bool_)
    return mean_of_rows(table, name, {planner: whole if rows is None else rows}, level)


def mean_of_rows(
    table: Table, name: Name, rows: Mapping[str, NDArray[np.bool_]], level: float = 0.95
) -> Estimate:
    """Return the mean and interval of several planners: planner -> (n,) its rows."""
    scale = table.scale(name)
    bounds, step = (scale.minimum, scale.maximum), 1.0 if scale.integer else 0.0
    parts = [_values(table, name, planner, chosen) for planner, chosen in rows.items()]
    above, below, places = (np.concatenate(part) for part in zip(*parts, strict=True))
    return c.ratio(above, below, table.clusters.part(places), level, bounds, step)


def _values(
    table: Table, name: Name, planner: str, chosen: NDArray[np.bool_]
) -> tuple[Floats, Floats, NDArray[np.intp]]:
    """Return numerators, denominators and their rows."""
    column, exposure = table.column(name, planner), table.exposure(name, planner)
    known = column.known & chosen
    if exposure is None:
        return column.low[known], np.ones(int(known.sum())), np.flatnonzero(known)
    known &= np.isfinite(exposure)
    return column.low[known] * exposure[known], exposure[known], np.flatnonzero(known)


def rate_difference(
    table: Table, name: Name, pair: tuple[str, str], chosen: NDArray[np.bool_], level: float = 0.95
) -> tuple[Estimate, float | None] | None:
    """Return one planner's rate minus another's and its standard error; None for other scores.

    Linearised like `clusters.ratio`: each run's contribution to the difference, draw by draw.

    Args:
        table: table of the runs.
        name: the score.
        pair: the planners.
        chosen: (n,) rows in which both have a value.
        level: confidence level of the interval.
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
    """Return the rate of all runs, and each run's contribution to its deviation, times n."""
    whole = float(exposure.sum())
    rate = float((rates * exposure).sum()) / whole
    return rate, (rates - rate) * exposure * (len(rates) / whole)


def bounds_of_difference(table: Table, name: Name) -> Bounds:
    """Return the largest difference of two values of a score, if known."""
    scale = table.scale(name)
    width = scale.maximum - scale.minimum
    return (-width, width) if math.isfinite(width) else c.UNBOUNDED
