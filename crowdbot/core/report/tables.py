"""The report's table: every score as tidy CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.encode import Attempt, status_of
from crowdbot.core.report.provenance import short
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.rows import RunRow
from crowdbot.core.results.score_columns import ScoreColumns
from crowdbot.core.scoring.scores_csv import csv_cells

_RUN = ("suite", "scenario", "planner", "seed", "run_status", "run_id", "realisation", "density")
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_END = "\r\n"


def csv_lines(contents: Contents) -> Iterator[str]:
    """Yield the header, then one line per score; an attempt without scores has one line.

    Texts that many lines share are quoted once.
    """
    axes = [axis["name"] for axis in contents.axes]
    scores = ScoreColumns.of(contents.results.scores)
    order = np.argsort(scores.run, kind="stable")
    ends = np.searchsorted(scores.run[order], np.arange(len(scores.run_ids) + 1))
    place_of = {name: i for i, name in enumerate(scores.run_ids)}
    labels_texts = [(csv_cells(x[:4]), csv_cells(x[4:])) for x in scores.labels]
    states = [csv_cells(state) for state in scores.states]
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)) + _END
    for attempt in contents.attempts:
        labels = [attempt.axes.get(name, "") for name in axes]
        head = csv_cells((*_run_cells(attempt), *labels))
        place = place_of.get(attempt.run_id) if isinstance(attempt, RunRow) else None
        found = [] if place is None else order[ends[place] : ends[place + 1]].tolist()
        for i in found:
            (name, unit), state = labels_texts[scores.label[i]], states[scores.state[i]]
            value, low, high = (_plain(x[i]) for x in (scores.value, scores.lower, scores.upper))
            yield f"{head},{name},{value},{unit},{state},{low},{high}{_END}"
        if not found:
            yield f"{head},{csv_cells(_without_scores(attempt))}{_END}"


def _plain(number: float) -> str:
    return "" if math.isnan(number) else repr(float(number))


def _run_cells(attempt: Attempt) -> tuple[str, ...]:
    cells = (attempt.suite, attempt.scenario, attempt.planner, str(attempt.seed))
    if isinstance(attempt, Failure):
        return (*cells, status_of(attempt), "", "", "")
    more = (
        attempt.status,
        short(attempt.run_id),
        short(attempt.realisation_hash),
        _cell(attempt.density),
    )
    return (*cells, *more)


def _without_scores(attempt: Attempt) -> tuple[str, ...]:
    reason = attempt.error if isinstance(attempt, Failure) else "not_scored"
    cells = {"status": status_of(attempt), "reason": reason}
    return tuple(cells.get(name, "") for name in _SCORE)


def _cell(value: str | float | None) -> str:
    if isinstance(value, str):
        return value
    return "" if value is None else repr(float(value))
