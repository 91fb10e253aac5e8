"""An atlas of scores: what drives each metric, and which metrics are redundant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.axes import axis_effects
from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.comparison import compare
from crowdbot.core.statistics.summary import headline_names
from crowdbot.core.statistics.table import Name, Table
from crowdbot.errors import UnknownNameError

#: Scores with at least this rank correlation are redundant.
SAME = 0.8
#: Smallest number of runs for a meaningful correlation.
_LEAST_RUNS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class AtlasEntry:
    """A score in the atlas: what drives it, and which scores repeat it.

    Attributes:
        runs: number of runs with a value.
        moves: axis -> share of the variance between a planner's runs that it explains (omega
            squared, mean over planners), largest first.
        duration: rank correlation with the run's duration; None without spread.
        separation: least and greatest probability, over all pairs, that a planner does better than
            a floor: 0.5 means no separation; None without floors or direction.
        repeats: other scores with correlated ranks and the correlation, highest first.
    """

    metric: str
    variant: str
    unit: str
    better: str
    runs: int
    moves: tuple[tuple[str, float], ...]
    duration: float | None
    separation: tuple[float, float] | None
    repeats: tuple[tuple[Name, float], ...]


def atlas(results: Results, floors: Sequence[str] = ()) -> tuple[AtlasEntry, ...]:
    """Return one entry per headline score; the four main scores come first.

    Args:
        results: runs of one suite, of floors and of planners.
        floors: labels of planners that every other should beat; default: planners with that role.

    Raises:
        UnknownNameError: a floor is not among the planners.
    """
    table = Table(results)
    for name in floors:
        if name not in table.planners:
            raise UnknownNameError("planner", name, table.planners)
    roles = {run.planner: run.role for run in results.runs}
    chosen = tuple(floors) or tuple(p for p in table.planners if roles.get(p) == "floor")
    names = headline_names(table)
    values = {name: _values(table, name) for name in names}
    lasted = _durations(table)
    return tuple(
        AtlasEntry(
            metric=name[0],
            variant=name[1],
            unit=table.label(name).unit,
            better=table.label(name).better,
            runs=int(np.isfinite(values[name]).sum()),
            moves=_moves(table, name),
            duration=rank_correlation(values[name], lasted),
            separation=_separation(table, name, chosen),
            repeats=tuple(_repeats(name, values)),
        )
        for name in names
    )


def rank_correlation(a: Floats, b: Floats) -> float | None:
    """Return Spearman's correlation over common known values; None for few or constant values."""
    known = np.isfinite(a) & np.isfinite(b)
    if known.sum() < _LEAST_RUNS:
        return None
    one, two = _ranks(a[known]), _ranks(b[known])
    if np.ptp(one) == 0 or np.ptp(two) == 0:
        return None
    return float(np.corrcoef(one, two)[0, 1])


def _ranks(values: Floats) -> Floats:
    """Return ranks from 0; equal values share their mean rank."""
    _, group, count = np.unique(values, return_inverse=True, return_counts=True)
    first = np.cumsum(count) - count
    return np.asarray((first + (count - 1) / 2.0)[group])


def _values(table: Table, name: Name) -> Floats:
    """Return the values of all planners and keys in a row; NaN for missing values."""
    columns = [table.column(name, planner) for planner in table.planners]
    return np.concatenate([np.where(c.known, c.low, np.nan) for c in columns] or [np.empty(0)])


def _durations(table: Table) -> Floats:
    runs = (table.runs.get((p, key)) for p in table.planners for key in table.keys)
    return np.array([np.nan if run is None else run.sim_time for run in runs], dtype=float)


def _moves(table: Table, name: Name) -> tuple[tuple[str, float], ...]:
    found: dict[str, list[float]] = {}
    for planner in table.planners:
        for effect in axis_effects(table, name, planner):
            if effect.omega_squared is not None:
                found.setdefault(effect.axis, []).append(effect.omega_squared)
    means = [(axis, float(np.mean(shares))) for axis, shares in found.items()]
    return tuple(sorted(means, key=lambda item: -item[1]))


def _separation(table: Table, name: Name, floors: Sequence[str]) -> tuple[float, float] | None:
    pairs = [(p, f) for f in floors for p in table.planners if p not in floors]
    found = [compare(table, name, p, f)[0].improvement.value for p, f in pairs]
    known = [x for x in found if x is not None]
    return (min(known), max(known)) if known else None


def _repeats(name: Name, values: dict[Name, Floats]) -> Iterator[tuple[Name, float]]:
    found = [(n, rank_correlation(values[name], v)) for n, v in values.items() if n != name]
    close = [(n, rho) for n, rho in found if rho is not None and abs(rho) >= SAME]
    yield from sorted(close, key=lambda item: -abs(item[1]))
