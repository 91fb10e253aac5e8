"""One random campaign as a report and as bundles on a leaderboard."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.manifest import BundledRun, Edition, Manifest
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.scoring.score_factory import ScoreFactory
from crowdbot.core.types.ending import Ending
from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.metric_invariants import MetricInvariants
from crowdbot.plugin import MetricComponent
from tests.core.statistics.made_up_results import run

#: Fields that rows of results have of a score.
_FIELDS = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip


def random_results(seed: int, planners: int, scenarios: int, draws: int, missing: float) -> Results:
    """Every variant of every metric, with skewed and extreme values, and some without one.

    Args:
        seed: of everything.
        planners, scenarios: how many; each planner runs each scenario.
        draws: how many crowds the scenarios share.
        missing: share of scores that are undefined or censored, and of planners that fail.
    """
    rng = np.random.default_rng(seed)
    runs, scores = [], []
    for p in range(planners):
        for s in range(scenarios):
            failed = rng.random() < missing / 3
            status = Ending.PLANNER_FAILED if failed else rng.choice(["arrived", "timeout"])
            axes = {"half": "low" if s % 2 else "high", "part": "rest" if s > 3 else "first"}
            one = run(
                f"planner{p}", f"s{s}", f"d{s % draws}", status=str(status), axes=axes,
                sim_time=float(rng.uniform(1.0, 90.0)),
                role="candidate",
            )  # fmt: skip
            runs.append(one)
            scores += [_row(one, score) for score in _scores(rng, missing)]
    return Results(runs=tuple(runs), scores=tuple(scores))


def metrics() -> list[MetricComponent[Any]]:
    """All that are installed."""
    found = discover(allow=()).components("metric")
    return [c for _, c in sorted(found.items()) if isinstance(c, MetricComponent)]


def _scores(rng: np.random.Generator, missing: float) -> Iterator[Score]:
    for metric in metrics():
        factory = ScoreFactory(metric)
        for name, variant in metric.variants.items():
            chance = rng.random()
            value = _value(rng, variant.invariants)
            if chance < missing / 2:
                yield factory.undefined(name, "no_neighbours")
            elif chance < missing:
                yield factory.censored(name, "goal_not_reached", upper=value)
            else:
                yield factory.ok(name, value)


def _value(rng: np.random.Generator, known: MetricInvariants) -> float:
    """Of a lognormal with the heaviest tail that stays finite, often a bound or a round number."""
    value = float(np.exp(rng.normal(0.0, rng.choice([0.1, 1.0, 6.0]))))
    if known.minimum == -math.inf and rng.random() < 0.5:
        value = -value
    if rng.random() < 0.3:
        value = float(rng.choice([0.0, 1.0, 0.5, 12.25, 0.125]))
    value = min(max(value, known.minimum), known.maximum)
    return float(round(value)) if known.integer else value


def _row(one: RunRow, score: Score) -> ScoreRow:
    return ScoreRow(run_id=one.run_id, **{name: getattr(score, name) for name in _FIELDS})


def entries(results: Results) -> list[LeaderboardEntry]:
    """The same runs, each planner's as a bundle of a name of its own."""
    planners = sorted({r.planner for r in results.runs})
    return [_entry(planner, results) for planner in planners]


def _entry(planner: str, results: Results) -> LeaderboardEntry:
    mine = [r for r in results.runs if r.planner == planner]
    listed = [_listed(r) for r in mine]
    manifest = Manifest(
        bundle=1, crowdbot="0", team="", contact="",
        edition=Edition(suite="suite", title="", lock="", scenarios=len(mine), rules=1),
        planner={"label": planner}, classed="sensors only", pinned=True, versions={}, seeds=[0],
        missing=[], runs=listed, members={},
    )  # fmt: skip
    claimed = tuple(_claimed(r, e, results.scores) for r, e in zip(mine, listed, strict=True))
    return LeaderboardEntry(
        path=Path(f"{planner}.cbz"), name=planner, manifest=manifest, sha256="0" * 64,
        verification=None, runs=claimed,
    )  # fmt: skip


def _listed(row: RunRow) -> BundledRun:
    return BundledRun(
        scenario=row.scenario, seed=row.seed, directory=row.run_id, run_id=row.run_id,
        trajectory=row.trajectory_hash,
    )  # fmt: skip


def _claimed(row: RunRow, entry: BundledRun, scores: Sequence[ScoreRow]) -> ClaimedRun:
    mine = [s for s in scores if s.run_id == row.run_id]
    kept: list[Any] = [Score(**{name: getattr(s, name) for name in _FIELDS}) for s in mine]
    return ClaimedRun(entry=entry, record=row.record, scores=tuple(kept))
