"""Variance components of a score: conditions, people, and run seeds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.table import Name, Table

ONE_DRAW_EACH = "one crowd draw a condition: conditions and people cannot be told apart"


@dataclass(frozen=True, slots=True, kw_only=True)
class VarianceParts:
    """Variance components of one score of one planner, in its squared unit.

    Negative estimates, which occur if the true component is near 0, are given as 0.

    Attributes:
        condition: variance between conditions of the suite, for infinitely many people each.
        draw: variance between crowd draws of one condition. Without repeated seeds it includes
            their part.
        seed: variance between run seeds with the same people; None without repeated runs.
        reason: why there are none, or empty.
    """

    planner: str
    metric: str
    variant: str
    condition: float | None = None
    draw: float | None = None
    seed: float | None = None
    reason: str = ""

    @property
    def shares(self) -> tuple[float, float, float]:
        """Return the shares of condition, draw and seed; zeros without variation."""
        parts = np.array([self.condition or 0.0, self.draw or 0.0, self.seed or 0.0])
        whole = float(parts.sum())
        found = parts / whole if whole > 0.0 else parts
        return float(found[0]), float(found[1]), float(found[2])


def variance_parts(table: Table, name: Name, planner: str) -> VarianceParts:
    """Return a nested analysis of variance for unequal groups (Searle 1971, Linear Models, 11)."""
    column = table.column(name, planner)
    known = np.flatnonzero(column.known)
    parts = partial(VarianceParts, planner=planner, metric=name[0], variant=name[1])
    if not len(known):
        return parts(reason="no run has a value")
    condition, draw = (_numbered(places[known]) for places in table.places)
    found = nested_variance(column.low[known], condition, draw)
    if found is None:
        return parts(reason=ONE_DRAW_EACH)
    between, within, rest = found
    return parts(condition=between, draw=within, seed=rest)


def nested_variance(
    values: Floats, condition: NDArray[np.intp], draw: NDArray[np.intp]
) -> tuple[float | None, float, float | None] | None:
    """Return components by the method of moments: each mean square equals its expectation.

    Args:
        values: (n,).
        condition: (n,) index of each value's condition.
        draw: (n,) index of each value's draw; a draw belongs to one condition.

    Returns:
        components of conditions (None with one condition), draws and the remainder (None without
        repeated runs); None if no condition has several draws.
    """
    n = len(values)
    of_draw = np.zeros(int(draw.max()) + 1, np.intp)
    of_draw[draw] = condition
    n_draw, n_condition = np.bincount(draw), np.bincount(condition)
    draws, conditions = len(n_draw), len(n_condition)
    if draws == conditions:
        return None
    mean_draw = np.bincount(draw, values) / n_draw
    mean_condition = np.bincount(condition, values) / n_condition
    error = None
    if n > draws:
        error = float(((values - mean_draw[draw]) ** 2).sum()) / (n - draws)
    noise = error or 0.0
    square = float((n_draw * (mean_draw - mean_condition[of_draw]) ** 2).sum())
    inner = float((n_draw**2 / n_condition[of_draw]).sum())
    within = square / (draws - conditions) - noise
    within /= (n - inner) / (draws - conditions)
    between = None
    if conditions > 1:
        off = float((n_condition * (mean_condition - values.mean()) ** 2).sum())
        of_draws = (inner - float((n_draw**2).sum()) / n) / (conditions - 1)
        of_conditions = (n - float((n_condition**2).sum()) / n) / (conditions - 1)
        between = off / (conditions - 1) - noise - of_draws * max(0.0, within)
        between = max(0.0, between / of_conditions)
    return between, max(0.0, within), error


def _numbered(places: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return place numbers renumbered from 0 without gaps, in the same order."""
    there = np.bincount(places) > 0
    return (np.cumsum(there) - 1)[places]
