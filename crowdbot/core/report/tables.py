"""The report's table: every score as tidy CSV."""

from __future__ import annotations

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

    Texts that many lines share are quoted once. NaN, a value that is not there, is an empty cell.
    """
    axes = [axis["name"] for axis in contents.axes]
    scores = ScoreColumns.of(contents.results.scores)
    order = np.argsort(scores.run, kind="stable")
    ends = np.searchsorted(scores.run[order], np.arange(len(scores.run_ids) + 1))
    place_of = {name: i for i, name in enumerate(scores.run_ids)}
    labels_texts = [(csv_cells(x[:4]), csv_cells(x[4:])) for x in scores.labels]
    states = [csv_cells(state) for state in scores.states]
    columns = (scores.label, scores.value, scores.state, scores.lower, scores.upper)
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)) + _END
    for attempt in contents.attempts:
        labels = [attempt.axes.get(name, "") for name in axes]
        head = csv_cells((*_run_cells(attempt), *labels))
        place = place_of.get(attempt.run_id) if isinstance(attempt, RunRow) else None
        found = order[:0] if place is None else order[ends[place] : ends[place + 1]]
        if not len(found):
            yield f"{head},{csv_cells(_without_scores(attempt))}{_END}"
            continue
        rows = zip(*(column[found].tolist() for column in columns), strict=True)
        yield from [
            f"{head},{labels_texts[label][0]},{'' if value != value else repr(value)},"
            f"{labels_texts[label][1]},{states[state]},{'' if low != low else repr(low)},"
            f"{'' if high != high else repr(high)}{_END}"
            for label, value, state, low, high in rows
        ]


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
