"""The report's table: every score as tidy CSV."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from operator import attrgetter

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.encode import Attempt, status_of
from crowdbot.core.report.provenance import short
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.rows import RunRow, ScoreRow

_RUN = ("suite", "scenario", "planner", "seed", "run_status", "run_id", "realisation", "density")
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_cells = attrgetter(*_SCORE)


def csv_rows(contents: Contents) -> Iterator[Sequence[str]]:
    """Yield the header, then one row per score; an attempt without scores has one row."""
    axes = [axis["name"] for axis in contents.axes]
    scores: dict[str, list[ScoreRow]] = {}
    for row in contents.results.scores:
        scores.setdefault(row.run_id, []).append(row)
    yield (*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)
    for attempt in contents.attempts:
        labels = [attempt.axes.get(name, "") for name in axes]
        head = (*_run_cells(attempt), *labels)
        found = scores.get(attempt.run_id, []) if isinstance(attempt, RunRow) else []
        for row in found:
            yield (*head, *map(_cell, _cells(row)))
        if not found:
            yield (*head, *_without_scores(attempt))


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
