"""Scores by groups of runs: by planner, suite axis or outcome."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.results.tables import axes_of
from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.estimate import Counts, Estimate
from crowdbot.core.statistics.summary import bounds_of_mean, headline_names
from crowdbot.core.statistics.summary_estimator import mean_of_rows
from crowdbot.core.statistics.table import MISSING, OK, Name, Table, counts_of, key_of
from crowdbot.core.types.ending import has_failed
from crowdbot.errors import InputError, UnknownNameError, did_you_mean, nearest

#: Labels of a group; and planner -> (n,) its rows of the table.
_Rows = Mapping[str, NDArray[np.bool_]]
_Group = tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GroupSummary:
    """Scores of one metric and variant in one group of runs.

    Attributes:
        group: axis -> label.
        counts: outcomes of the group's runs for this score.
        unscored: undefined ones among them that were not scored, or whose score was not kept.
        failed: runs whose planner failed, which may have values, and attempts that left no run.
        mean: mean of the existing values, or the rate of all these runs together, with its
            interval, as in report and leaderboard.
        bounds: bounds of the mean of all runs, with missing values anywhere within their bounds;
            None if unbounded.
        median: median of the existing values.
    """

    group: Mapping[str, str]
    metric: str
    variant: str
    unit: str
    better: str
    counts: Counts
    unscored: int
    failed: int
    mean: Estimate
    bounds: tuple[float | None, float | None]
    median: float | None


class Grouped:
    """Results in groups of runs, for questions about several metrics.

    Args:
        results: the results.
        by: axes, or ``planner``, ``suite``, ``scenario``, ``seed``, ``status``.

    Raises:
        UnknownNameError: no such axis.
    """

    def __init__(self, results: Results, by: Sequence[str]) -> None:
        known = [*axes_of(results.runs), "planner", "suite", "scenario", "seed", "status"]
        for name in by:
            if name not in known:
                raise UnknownNameError("axis", name, known)
        self._by = by
        self._table = Table(results)
        self._groups = _groups(self._table, results, by)
        self._failed = Counter(
            tuple(_label(one, axis) for axis in by)
            for one in _tried(self._table, results)
            if isinstance(one, Failure) or has_failed(one.status)
        )

    def summaries(self, metric: str, variant: str | None = None) -> list[GroupSummary]:
        """Return scores by groups.

        Args:
            metric: pattern of names.
            variant: None: the metric's headline variant (`headline_names`).

        Raises:
            InputError: no run was scored by the metric.
        """
        check_scored({name[0] for name in self._table.names}, metric)
        return [
            _summary(
                self._table, name, dict(zip(self._by, group, strict=True)), rows,
                self._failed[group],
            )
            for name in self._names(metric, variant)
            for group, rows in self._groups.items()
        ]  # fmt: skip

    @cached_property
    def _usual(self) -> Mapping[str, Name]:
        """Return metric -> its headline variant."""
        first = {name[0]: name for name in reversed(self._table.names)}
        return {**first, **{name[0]: name for name in headline_names(self._table)}}

    def _names(self, metric: str, variant: str | None) -> Iterator[Name]:
        for name in self._table.names:
            usual = self._usual[name[0]][1]
            if fnmatchcase(name[0], metric) and name == (name[0], variant or usual):
                yield name


def by_group(
    results: Results, metric: str, by: Sequence[str], variant: str | None = None
) -> list[GroupSummary]:
    """Return scores of one metric by groups of runs; arguments and errors as in `Grouped`."""
    return Grouped(results, by).summaries(metric, variant)


def _groups(table: Table, results: Results, by: Sequence[str]) -> Mapping[_Group, _Rows]:
    """Return labels -> rows, in the order of the runs."""
    places = {key: i for i, key in enumerate(table.keys)}
    groups: dict[_Group, dict[str, NDArray[np.bool_]]] = {}
    for one in _tried(table, results):
        group = groups.setdefault(tuple(_label(one, name) for name in by), {})
        rows = group.setdefault(one.planner, np.zeros(len(places), np.bool_))
        rows[places[key_of(one)]] = True
    return groups


def _tried(table: Table, results: Results) -> list[RunRow | Failure]:
    """Return the runs, and failed attempts that no later run replaced."""
    lost = [f for f in results.failures if (f.planner, key_of(f)) in table.failures]
    return [*results.runs, *lost]


def _summary(
    table: Table, name: Name, group: Mapping[str, str], rows: _Rows, failed: int
) -> GroupSummary:
    label, mean = table.label(name), mean_of_rows(table, name, rows)
    low, high, outcome = _gathered(table, name, rows)
    values, tried = low[outcome == OK], outcome != MISSING
    bounds = bounds_of_mean(low[tried], high[tried])
    if table.exposure_name(name) is not None:
        bounds = (mean.value, mean.value) if len(values) == tried.sum() else (None, None)
    return GroupSummary(
        group=group, metric=name[0], variant=name[1], unit=label.unit, better=label.better,
        counts=counts_of(outcome),
        unscored=sum(int(table.column(name, p).unscored[r].sum()) for p, r in rows.items()),
        failed=failed, mean=mean, bounds=bounds,
        median=float(np.median(values)) if len(values) else None,
    )  # fmt: skip


def _gathered(table: Table, name: Name, rows: _Rows) -> tuple[Floats, Floats, NDArray[np.int8]]:
    """Return least and greatest value, and outcome, of each run of a group, (runs,)."""
    columns = [(table.column(name, planner), chosen) for planner, chosen in rows.items()]
    parts = [(column.low[r], column.high[r], column.outcome[r]) for column, r in columns]
    low, high, outcome = zip(*parts, strict=True)
    return np.concatenate(low), np.concatenate(high), np.concatenate(outcome)


def _label(run: RunRow | Failure, name: str) -> str:
    if name == "status" and isinstance(run, Failure):
        return "failed"
    return run.axes[name] if name in run.axes else str(getattr(run, name, ""))


def check_scored(metrics: Collection[str], metric: str) -> None:
    """Check that a pattern fits one of the metrics by which runs were scored, if there are any.

    Raises:
        InputError: it fits none.
    """
    if metrics and not any(fnmatchcase(m, metric) for m in metrics):
        near = did_you_mean(nearest(metric, metrics))
        raise InputError(
            f"metric '{metric}' was not scored in these runs{near}; 'crowdbot evaluate RUNS "
            f"--metrics {metric}' shows it, and a suite's field metrics lets new runs be scored"
        )
