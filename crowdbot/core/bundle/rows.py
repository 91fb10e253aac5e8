"""A bundle as result rows, for statistics and the linter, like a campaign."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields

from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.types.score import Score


def results_of(runs: Iterable[tuple[str, ClaimedRun]]) -> Results:
    """Return the rows of several bundles' runs.

    Args:
        runs: unique planner name of the entry; the run.
    """
    rows, scores = [], []
    for planner, run in runs:
        place = f"{planner}: {run.entry.directory}"
        rows.append(RunRow(record=run.record, directory=place, entry=planner))
        scores += [_score_row(rows[-1].run_id, s) for s in run.scores]
    return Results(runs=tuple(rows), scores=tuple(scores))


def _score_row(run_id: str, score: Score) -> ScoreRow:
    same = (field.name for field in fields(ScoreRow) if field.name != "run_id")
    return ScoreRow(run_id=run_id, **{name: getattr(score, name) for name in same})
