"""Runs that are not there gain nothing: missing, stuck, undefined and censored ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.scoring.score_scale import ScoreScale
from crowdbot.core.statistics.comparison import Comparison
from crowdbot.core.statistics.floors import check_floors
from crowdbot.core.statistics.summary import summarise
from tests.core.results.made_up_record import changed
from tests.core.statistics.made_up_results import censored, pairs, run, score

RNG = np.random.default_rng(31)
VALUES = RNG.uniform(0.5, 0.9, size=30)
UNIT = {("m", "corrected"): ScoreScale(minimum=0.0, maximum=1.0)}


def only(results: Results) -> Comparison:
    (found,) = summarise(results, [("m", "corrected")]).comparisons
    return found


def kept(results: Results, planner: str, *scenarios: int) -> Results:
    """The same without some runs of one planner."""
    gone = {f"{planner}/s{i}/0" for i in scenarios}
    return replace(
        results,
        runs=tuple(r for r in results.runs if r.run_id not in gone),
        scores=tuple(s for s in results.scores if s.run_id not in gone),
    )


def as_floor(results: Results, label: str) -> Results:
    """The same with one planner as a floor."""
    runs = [changed(r, role="floor") if r.planner == label else r for r in results.runs]
    return replace(results, runs=tuple(runs))


@pytest.mark.parametrize("scales", [UNIT, {}])
def test_deleting_bad_runs_gains_nothing(scales: dict[tuple[str, str], ScoreScale]) -> None:
    a = VALUES + 0.05
    a[:8] = 0.0
    whole = replace(pairs(a.tolist(), VALUES.tolist()), scales=scales)
    assert only(whole).verdict != "better"
    without = only(kept(whole, "a", *range(8)))
    assert without.difference.value == pytest.approx(0.05)
    assert without.verdict == "not distinguishable"
    assert without.reason == "8 runs of a without a value count as the worst: no gain is left"
    assert without.counts_a.missing == 8


def test_missing_runs_are_no_evidence_for_the_other_planner() -> None:
    results = replace(pairs(VALUES.tolist(), VALUES.tolist()), scales=UNIT)
    found = only(kept(results, "a", *range(12)))
    assert (found.verdict, found.p) == ("not distinguishable", 1.0)
    better = replace(pairs((VALUES + 0.05).tolist(), VALUES.tolist()), scales=UNIT)
    assert only(kept(better, "b", 3)).verdict == "better"


def test_other_seeds_and_floors_are_not_missing() -> None:
    a = (VALUES + 0.05).tolist()
    results = replace(pairs(a, VALUES.tolist()), scales=UNIT)
    again = [changed(r, seed=1, run_id=f"{r.run_id}/again") for r in results.runs[30:]]
    scores = [score(r, 0.0) for r in again]
    more = replace(
        results, runs=(*results.runs, *again), scores=(*results.scores, *scores)
    )  # b was run with two seeds
    assert only(more).verdict == "better"
    assert only(kept(as_floor(results, "a"), "a", *range(8))).verdict == "better"


def test_a_planner_with_missing_runs_is_not_ahead_of_a_floor() -> None:
    results = pairs((VALUES + 0.05).tolist(), VALUES.tolist(), metric="safe_efficiency")
    results = as_floor(results, "b")
    assert [c.beats_all for c in check_floors(results)] == [True]
    (found,) = check_floors(kept(results, "a", 4))
    assert (found.beats_all, found.leads[0].reason) == (False, "1 run of the planner missing")


def rates(parked: int, cost: float = 0.0) -> Results:
    """Planner a parks in some runs and has no cost in the others; b has little cost."""
    runs, scores = [], []
    for planner in "ab":
        for i in range(20):
            stuck = planner == "a" and i < parked
            found = run(planner, f"s{i}", f"d{i}", status="timeout" if stuck else "arrived")
            value = None if stuck else 0.0 if planner == "a" else cost + 0.01 * (i % 5)
            more = {"metric": "push_work", "better": "lower"}
            runs.append(found)
            scores.append(score(found, value, variant="rate", reason="no_progress", **more))
            way = score(found, 40.0, variant="way", **{**more, "better": "none"})
            scores.append(way)
    scale = ScoreScale(minimum=0.0, rate_over="way")
    return Results(runs=tuple(runs), scores=tuple(scores), scales={("push_work", "rate"): scale})


@pytest.mark.parametrize(("parked", "verdict"), [(0, "better"), (20, "worse"), (10, "not dist")])
def test_a_robot_without_progress_is_last_in_rates(parked: int, verdict: str) -> None:
    (found,) = summarise(rates(parked), [("push_work", "rate")]).comparisons
    assert found.verdict.startswith(verdict)


def test_a_robot_without_progress_is_behind_one_without_any_cost() -> None:
    found = rates(20)
    free = [
        replace(s, value=0.0) if s.value is not None and s.variant == "rate" else s
        for s in found.scores
    ]
    results = replace(found, scores=tuple(free))
    assert summarise(results, [("push_work", "rate")]).comparisons[0].verdict == "worse"


def test_values_that_do_not_exist_forbid_a_verdict_for_their_planner() -> None:
    results = pairs((VALUES + 0.05).tolist(), VALUES.tolist())
    nothing = score(run(), reason="no_neighbours")
    for planner, verdict in (("a", "not distinguishable"), ("b", "better")):
        scores = tuple(
            replace(nothing, run_id=s.run_id) if s.run_id == f"{planner}/s2/0" else s
            for s in results.scores
        )
        found = only(replace(results, scores=scores))
        assert found.verdict == verdict
    assert found.reason == ""
    scores = tuple(
        replace(nothing, run_id=s.run_id) if s.run_id == "a/s2/0" else s for s in results.scores
    )
    assert only(replace(results, scores=scores)).reason == "a has no value in 1 pair"


def test_bounds_count_on_the_side_that_is_worse_for_the_winner() -> None:
    results = pairs((VALUES + 0.05).tolist(), VALUES.tolist())
    for lower, verdict in ((0.7, "better"), (-50.0, "not distinguishable")):
        bound = censored(run(), lower=lower)
        scores = tuple(
            replace(bound, run_id=s.run_id) if s.run_id == "a/s2/0" else s for s in results.scores
        )
        assert only(replace(results, scores=scores)).verdict == verdict
