"""Effect of each axis of a suite on a score, and the realised crowd densities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.table import Name, Table

#: Name of an extra axis: the realised density, as a linear effect.
REALISED_DENSITY = "realised density"


@dataclass(frozen=True, slots=True, kw_only=True)
class Level:
    """The runs with one label of an axis; ``mean`` of those with a value, or None."""

    label: str
    runs: int
    mean: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisEffect:
    """Share of a score's variance that one axis explains, for one planner.

    Attributes:
        levels: in the order of the suite; empty for `REALISED_DENSITY`.
        eta_squared: between-label over total sum of squares, 0 to 1; None without spread. For
            `REALISED_DENSITY`, the squared correlation.
        omega_squared: the same, corrected for chance (Hays 1963), not below 0.
        reason: why there is no value.
    """

    planner: str
    metric: str
    variant: str
    axis: str
    levels: tuple[Level, ...] = ()
    eta_squared: float | None = None
    omega_squared: float | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class DensityLevel:
    """Realised density of the runs with one label of the axis ``density``, 1/m².

    ``label`` is empty where the suite has no such axis.
    """

    label: str
    runs: int
    mean: float
    least: float
    most: float


def axis_effects(table: Table, name: Name, planner: str) -> list[AxisEffect]:
    """Return the effects of all axes on one score of one planner; missing values are counted."""
    column, labels = table.column(name, planner), table.axis_labels(planner)
    values = np.where(column.known[labels.rows], column.low[labels.rows], np.nan)
    found = [(axis, *_effect(*of_axis, values)) for axis, of_axis in labels.axes.items()]
    found.append((REALISED_DENSITY, (), *_line(labels.density, values)))
    return [
        AxisEffect(
            planner=planner, metric=name[0], variant=name[1], axis=axis, levels=levels,
            eta_squared=eta, omega_squared=omega, reason=reason,
        )
        for axis, levels, eta, omega, reason in found
    ]  # fmt: skip


def densities(table: Table) -> tuple[DensityLevel, ...]:
    """Return realised densities of all runs with people, by label of the axis ``density``."""
    by_label: dict[str, list[float]] = {}
    for run in table.runs.values():
        if run.density is not None:
            by_label.setdefault(run.axes.get("density", ""), []).append(run.density)
    return tuple(
        DensityLevel(
            label=label, runs=len(found), mean=float(np.mean(found)),
            least=min(found), most=max(found),
        )
        for label, found in by_label.items()
    )  # fmt: skip


_Effect = tuple[tuple[Level, ...], float | None, float | None, str]


def _effect(order: Sequence[str], index: NDArray[np.intp], values: Floats) -> _Effect:
    known = np.isfinite(values)
    runs = np.bincount(index, minlength=len(order))
    index, values = index[known], values[known]
    count = np.bincount(index, minlength=len(order))
    total = np.bincount(index, weights=values, minlength=len(order))
    levels = tuple(
        Level(label=label, runs=int(runs[i]),
              mean=float(total[i] / count[i]) if count[i] else None)
        for i, label in enumerate(order)
    )  # fmt: skip
    return levels, *_shares(values, index, count)


def _shares(
    values: Floats, index: NDArray[np.intp], count: NDArray[np.intp]
) -> tuple[float | None, float | None, str]:
    """Return eta squared and omega squared of a one-way layout; ``count``: values by label."""
    used = int(np.count_nonzero(count))
    if used < 2:
        return None, None, "fewer than two labels have a value"
    scale = float(np.abs(values).max())
    if np.ptp(values) <= 1e-12 * scale:
        return None, None, "all values are equal"
    values = values / scale  # squares of large numbers overflow
    total = float(((values - values.mean()) ** 2).sum())
    means = np.bincount(index, weights=values, minlength=len(count)) / np.maximum(count, 1)
    within = float(((values - means[index]) ** 2).sum())
    eta = 1 - within / total
    freedom = len(values) - used
    if freedom < 1:
        return eta, None, "one value a label: chance cannot be told from the axis"
    noise = within / freedom
    omega = (total - within - (used - 1) * noise) / (total + noise)
    return eta, max(omega, 0.0), ""


def _line(x: Floats, y: Floats) -> tuple[float | None, float | None, str]:
    """Return the squared correlation, raw and adjusted."""
    known = np.isfinite(x) & np.isfinite(y)
    x, y, n = x[known], y[known], int(known.sum())
    if n < 2 or np.ptp(x) == 0 or np.ptp(y) <= 1e-12 * float(np.abs(y).max()):
        return None, None, "no spread of densities or values"
    squared = float(np.corrcoef(x, y / np.abs(y).max())[0, 1] ** 2)
    if n < 3:
        return squared, None, "two values lie on a line"
    return squared, max(0.0, 1 - (1 - squared) * (n - 1) / (n - 2)), ""
