"""How much of a score's variance goes with conditions, with people, and with run seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.table import Name, Table

ONE_DRAW_EACH = "one crowd draw a condition: conditions and people cannot be told apart"


@dataclass(frozen=True, slots=True, kw_only=True)
class VarianceParts:
    """Variance components of one score of one planner, in the square of its unit.

    Estimates of components may be negative where the true one is near 0; they are given as 0.

    Attributes:
        condition: between the conditions of the suite, for infinitely many people each.
        draw: between crowd draws of one condition. Where nobody repeated a run with another seed
            it has the seed's part in it.
        seed: between run seeds with the same people; None without any repeated.
        reason: why there are none; empty if there are.
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
        """Of condition, draw and seed; zeros where nothing varies."""
        parts = np.array([self.condition or 0.0, self.draw or 0.0, self.seed or 0.0])
        whole = float(parts.sum())
        found = parts / whole if whole > 0.0 else parts
        return float(found[0]), float(found[1]), float(found[2])


def variance_parts(table: Table, name: Name, planner: str) -> VarianceParts:
    """Nested analysis of variance of unequal groups (Searle 1971, Linear Models, ch. 11)."""
    column = table.column(name, planner)
    known = np.flatnonzero(column.known)
    parts = partial(VarianceParts, planner=planner, metric=name[0], variant=name[1])
    if not len(known):
        return parts(reason="no run has a value")
    condition = _numbered([table.conditions[i] for i in known])
    draw = _numbered([f"{table.conditions[i]}\0{table.draws[i]}" for i in known])
    found = nested_variance(column.low[known], condition, draw)
    if found is None:
        return parts(reason=ONE_DRAW_EACH)
    between, within, rest = found
    return parts(condition=between, draw=within, seed=rest)


def nested_variance(
    values: Floats, condition: NDArray[np.intp], draw: NDArray[np.intp]
) -> tuple[float | None, float, float | None] | None:
    """Components by the method of moments: each mean square equals what is expected of it.

    Args:
        values: (n,).
        condition: (n,) number of the condition of each value.
        draw: (n,) number of its draw; a draw belongs to one condition.

    Returns:
        of conditions (None with a single one), draws and what is left (None without repeated
        runs); None where no condition has several draws.
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


def _numbered(names: Sequence[str]) -> NDArray[np.intp]:
    return np.unique(np.asarray(names), return_inverse=True)[1].astype(np.intp)
