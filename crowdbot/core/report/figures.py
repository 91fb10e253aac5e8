"""Statistics that a page shows but cannot compute itself.

Intervals cover all runs and each label of each axis; comparisons cover all runs only, because every
further selection would increase the risk of a false finding.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.report.series import Series
from crowdbot.core.results.results import Results
from crowdbot.core.results.score_columns import different
from crowdbot.core.statistics.axes import REALISED_DENSITY
from crowdbot.core.statistics.comparison import Comparison
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.sample_size import draws_needed
from crowdbot.core.statistics.summary import Summary, headline_names, summarise
from crowdbot.core.statistics.summary_estimator import planner_mean
from crowdbot.core.statistics.table import Name, Table

#: Fields of a comparison that the page gets, in this order.
FIELDS = (
    "difference", "low", "high", "effect", "effect_low", "effect_high", "improvement",
    "improvement_low", "improvement_high", "detectable", "p_holm", "pairs", "draws", "undecided",
    "verdict", "why", "needed",
)  # fmt: skip
VERDICTS = ("better", "worse", "not distinguishable", "not ranked")

_NO_LABELS: Mapping[str, str] = {}
_Triple = tuple[float, float, float]
_Numbers = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Figures:
    """Statistics of a report.

    Attributes:
        headline: of the metrics' headline scores: the four main ones are one family of tests, the
            others a second; all other variants are a third.
        selections: ``""`` for all runs, ``axis=label`` for a part.
        intervals: (selection, series, planner, 3): mean, share or rate, and its interval.
        pairs: (series, pair, field).
        effects: (axis, series, planner): eta squared; the last axis is the realised density.
        whys: reasons of verdicts by number.
    """

    headline: Summary
    selections: tuple[str, ...]
    intervals: _Numbers
    pairs: _Numbers
    effects: _Numbers
    whys: tuple[str, ...]

    @property
    def planners(self) -> tuple[str, ...]:
        """Return the labels of all planners, sorted."""
        return self.headline.planners


def figures(
    results: Results,
    table: Table,
    series: Sequence[Series],
    axes: Sequence[Mapping[str, Any]],
) -> Figures:
    """Compute all figures.

    Args:
        results: comparable runs.
        table: table of the runs.
        series: series that the page shows.
        axes: ``name`` and ``labels`` of each axis of the suite.
    """
    chosen = headline_names(table)
    rest = [s.name for s in series if s.name not in chosen and _has_values(table, s.name)]
    headline = summarise(results, chosen, table=table)
    both = [headline, summarise(results, rest, table=table)] if rest else [headline]
    whys = tuple(dict.fromkeys(["", *(c.reason for s in both for c in s.comparisons)]))
    selections = ("", *(f"{axis['name']}={label}" for axis in axes for label in axis["labels"]))
    return Figures(
        headline=headline,
        selections=selections,
        intervals=_intervals(table, both, series, selections),
        pairs=_pairs(both, series, table.planners, whys),
        effects=_effects(both, series, table.planners, axes),
        whys=whys,
    )


def _has_values(table: Table, name: Name) -> bool:
    return any(table.column(name, planner).known.any() for planner in table.planners)


def _intervals(
    table: Table, summaries: Sequence[Summary], series: Sequence[Series], selections: Sequence[str]
) -> _Numbers:
    place = {s.name: i for i, s in enumerate(series)}
    intervals = np.full((len(selections), len(series), len(table.planners), 3), np.nan)
    for score in (score for summary in summaries for score in summary.scores):
        row = place[score.metric, score.variant], table.planners.index(score.planner)
        intervals[0][row] = _numbers(score.mean)
    inside = [_inside(table, planner, selections) for planner in table.planners]
    for s, one in enumerate(series):
        for p, planner in enumerate(table.planners):
            for k, numbers in _by_label(table, one, planner, inside[p]):
                intervals[k, s, p] = numbers
    return intervals


def _inside(table: Table, planner: str, selections: Sequence[str]) -> NDArray[np.bool_]:
    """Return a mask (selection, row) of the table's rows in each selection."""
    runs = [table.runs.get((planner, key)) for key in table.keys]
    named, which = different([run.axes if run else _NO_LABELS for run in runs])
    labels = [{f"{a}={x}" for a, x in axes.items()} for axes in named]
    found = [[selection in some for some in labels] for selection in selections]
    return np.array(found, np.bool_)[:, which]


def _by_label(
    table: Table, one: Series, planner: str, inside: NDArray[np.bool_]
) -> Iterator[tuple[int, _Triple]]:
    """Yield the summary of the runs with each label of each axis."""
    column = table.column(one.name, planner)
    for k in range(1, len(inside)):
        if (column.known & inside[k]).any():
            yield k, _numbers(planner_mean(table, one.name, planner, rows=inside[k]))


def _pairs(
    summaries: Sequence[Summary],
    series: Sequence[Series],
    planners: Sequence[str],
    whys: Sequence[str],
) -> _Numbers:
    place = {s.name: i for i, s in enumerate(series)}
    pairs = list(combinations(planners, 2))
    found = np.full((len(series), len(pairs), len(FIELDS)), np.nan)
    needed = {
        id(c): draws_needed(c, max(1, summary.tests), summary.alpha, summary.level)
        for summary in summaries
        for c in summary.comparisons
    }
    for comparison in (c for summary in summaries for c in summary.comparisons):
        row = (
            place[comparison.metric, comparison.variant],
            pairs.index((comparison.a, comparison.b)),
        )
        found[row] = _fields(comparison, whys, needed[id(comparison)])
    return found


def _fields(comparison: Comparison, whys: Sequence[str], needed: int | None) -> list[float]:
    estimates = (comparison.difference, comparison.standardised, comparison.improvement)
    numbers = [x for estimate in estimates for x in _numbers(estimate)]
    return [
        *numbers,
        *(_number(x) for x in (comparison.detectable, comparison.p_holm)),
        *(comparison.pairs, comparison.draws, comparison.undecided),
        VERDICTS.index(comparison.verdict),
        whys.index(comparison.reason),
        _number(needed),
    ]


def _effects(
    summaries: Sequence[Summary],
    series: Sequence[Series],
    planners: Sequence[str],
    axes: Sequence[Mapping[str, Any]],
) -> _Numbers:
    names = [*(axis["name"] for axis in axes), REALISED_DENSITY]
    place = {s.name: i for i, s in enumerate(series)}
    effects = np.full((len(names), len(series), len(planners)), np.nan)
    for effect in (e for summary in summaries for e in summary.axes):
        row = place[effect.metric, effect.variant], planners.index(effect.planner)
        effects[names.index(effect.axis)][row] = _number(effect.eta_squared)
    return effects


def _numbers(estimate: Estimate) -> _Triple:
    return _number(estimate.value), _number(estimate.low), _number(estimate.high)


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)
