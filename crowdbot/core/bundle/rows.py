"""A bundle as rows of results, so that statistics and linter read it like a campaign."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.bundle.pack import is_privileged
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.types.score import Score


def results_of(runs: Iterable[tuple[str, ClaimedRun]]) -> Results:
    """Rows of several bundles' runs.

    Args:
        runs: name to give the planner, which tells entries apart; the run.
    """
    rows, scores = [], []
    for planner, run in runs:
        run_id = f"{planner}\0{run.entry.run_id}"
        rows.append(_run_row(planner, run_id, run))
        scores += [_score_row(run_id, s) for s in run.scores]
    return Results(runs=tuple(rows), scores=tuple(scores))


def _run_row(planner: str, run_id: str, run: ClaimedRun) -> RunRow:
    record, hashes = run.record, _map(run.record, "hashes")
    density = record.get("density")
    return RunRow(
        run_id=run_id,
        suite=str(record.get("suite", "")),
        scenario=run.entry.scenario,
        planner=planner,
        seed=run.entry.seed,
        axes={str(k): str(v) for k, v in _map(record, "axes").items()},
        status=str(record.get("status", "")),
        reason=str(record.get("reason", "")),
        goal_time=_number(record.get("goal_time")),
        sim_time=_number(record.get("sim_time")) or 0.0,
        wall_time=_number(record.get("wall_time")) or 0.0,
        privileged=is_privileged(record),
        pinned=bool(record.get("pinned")),
        spec_hash=str(hashes.get("spec", "")),
        realisation_hash=str(hashes.get("realisation", "")),
        trajectory_hash=str(hashes.get("trajectory", "")),
        density=_number(density),
        directory=f"{planner}: {run.entry.directory}",
        conditions={str(k): str(v) for k, v in _map(record, "conditions").items()},
        record=record,
        role=str(record.get("role", "candidate")),
    )


def _score_row(run_id: str, score: Score) -> ScoreRow:
    return ScoreRow(
        run_id=run_id,
        category=score.category,
        metric=score.metric,
        symbol=score.symbol,
        variant=score.variant,
        value=score.value,
        unit=score.unit,
        better=score.better,
        status=score.status,
        reason=score.reason,
        lower=score.lower,
        upper=score.upper,
    )


def _map(record: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = record.get(name)
    return value if isinstance(value, Mapping) else {}


def _number(value: Any) -> float | None:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number else None
