"""Verdicts: from pairs with values, without, and with nothing but bounds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.statistics.comparison import Comparison
from crowdbot.core.statistics.summary import summarise
from tests.core.results.made_up_record import changed
from tests.core.statistics.made_up_results import cells, censored, challenge, pairs, run, score

RNG = np.random.default_rng(11)
LOW = RNG.normal(size=20).tolist()
HIGH = [x + 2.0 + 0.1 * i for i, x in enumerate(LOW)]


def only(results: Results) -> Comparison:
    (found,) = summarise(results).comparisons
    return found


def without(results: Results, planner: str, *scenarios: str, by: ScoreRow | None = None) -> Results:
    """The same, with other scores of some runs of one planner."""
    gone = {f"{planner}/{s}/0" for s in scenarios}
    scores = [
        s if s.run_id not in gone else replace(by, run_id=s.run_id) if by else None
        for s in results.scores
    ]
    return replace(results, scores=tuple(s for s in scores if s is not None))


@pytest.mark.parametrize(("better", "verdict"), [("higher", "better"), ("lower", "worse")])
def test_a_clear_difference(better: str, verdict: str) -> None:
    found = only(pairs(HIGH, LOW, better=better))
    assert found.verdict == verdict
    assert found.difference.value == pytest.approx(np.mean(np.subtract(HIGH, LOW)))
    assert found.bounds[0] == pytest.approx(found.difference.value)
    assert found.bounds[1] == pytest.approx(found.difference.value)
    sign = 1 if better == "higher" else -1
    assert found.rank_biserial.value == pytest.approx(sign)
    assert found.improvement.value == (1.0 if better == "higher" else 0.0)
    assert np.sign(found.standardised.value or 0.0) == sign
    assert (found.wins, found.losses) == ((20, 0) if better == "higher" else (0, 20))


def test_exchanging_the_planners_turns_the_verdict() -> None:
    one, other = only(pairs(HIGH, LOW)), only(pairs(LOW, HIGH))
    assert (one.verdict, other.verdict) == ("better", "worse")
    assert one.p == other.p
    assert one.difference.value == pytest.approx(-(other.difference.value or 0.0))


def test_a_planner_and_itself() -> None:
    found = only(pairs(LOW, LOW))
    assert (found.verdict, found.p, found.ties) == ("not distinguishable", 1.0, 20)
    assert found.reason == "every pair is equal"
    assert found.improvement.value == 0.5
    assert found.standardised.reason == "all differences are equal"


def test_rounding_is_no_difference() -> None:
    found = only(pairs([x * (1 + 1e-15) for x in HIGH], HIGH))
    assert found.ties == 20


def test_the_same_pairs_of_few_draws_prove_nothing() -> None:
    found = only(pairs(HIGH, LOW, draws=["d0", "d1"] * 10))
    assert (found.verdict, found.draws) == ("not distinguishable", 2)
    assert found.reason == "too few crowd draws: 2; no difference could be told from chance"


def test_one_draw_and_one_pair() -> None:
    one_draw = only(pairs(HIGH, LOW, draws=["d0"] * 20))
    assert one_draw.difference.low is None
    assert one_draw.detectable is None
    one_pair = only(pairs(HIGH[:1], LOW[:1]))
    assert one_pair.standardised.reason == "one pair: no spread"
    assert one_pair.verdict == "not distinguishable"


def test_distance_to_the_reference_decides() -> None:
    near = [1.0 + 0.01 * x for x in LOW]
    far = [1.5 + 0.01 * x if i % 2 else 0.4 - 0.01 * x for i, x in enumerate(LOW)]
    found = only(pairs(near, far, better="reference"))
    assert found.verdict == "better"
    assert (found.difference.value or 0.0) < 0  # the distance is smaller


def test_metrics_without_direction_are_not_ranked() -> None:
    found = only(pairs(HIGH, LOW, better="none"))
    assert (found.verdict, found.p) == ("not ranked", None)
    assert found.difference.value is not None


def test_a_reference_that_is_not_among_the_scores() -> None:
    results = pairs(HIGH, LOW, better="reference")
    results = replace(
        results, scores=tuple(replace(s, metric="overtaking_count") for s in results.scores)
    )
    assert only(results).verdict == "not ranked"


def test_undefined_scores_are_counted_and_decide_nothing() -> None:
    results = without(pairs(HIGH, LOW), "a", "s0", "s1", by=score(run(), reason="no_agents"))
    found = only(results)
    assert (found.pairs, found.wins, found.undecided) == (20, 18, 2)
    assert found.counts_a.undefined == 2
    assert found.improvement.value == pytest.approx(0.95)
    assert found.improvement_bounds[0] == pytest.approx(0.9)
    assert found.improvement_bounds[1] == pytest.approx(1.0)
    assert found.bounds == (None, None)


def test_everything_undefined() -> None:
    results = pairs(HIGH, LOW)
    results = replace(results, scores=tuple(
        replace(s, value=None, status="undefined", reason="no_agents") for s in results.scores
    ))  # fmt: skip
    found = only(results)
    assert found.difference.reason == "no pair in which both have a value"
    assert (found.verdict, found.reason) == ("not distinguishable", "no pair is decided")
    assert found.improvement_bounds == (0.0, 1.0)


def test_failed_runs_lose() -> None:
    results = pairs(HIGH, LOW)
    runs = [changed(r, status="planner_failed") if r.planner == "a" else r for r in results.runs]
    found = only(replace(results, runs=tuple(runs)))
    assert (found.verdict, found.losses) == ("worse", 20)  # though its values are the better ones
    assert (found.counts_a.ok, found.counts_a.failed) == (20, 0)
    assert found.difference.value == pytest.approx(only(results).difference.value)


def test_nobody_gains_by_failing() -> None:
    """b drives better; a fails in each run, at once or when it is about to lose."""
    results = pairs(LOW, HIGH)
    assert only(results).verdict == "worse"
    for failing in (20, 10):
        runs = [
            changed(r, status="planner_failed")
            if r.planner == "a" and int(r.scenario[1:]) < failing
            else r
            for r in results.runs
        ]
        early = tuple(
            replace(s, value=1e3) if s.run_id in {r.run_id for r in runs if _failed(r)} else s
            for s in results.scores
        )
        found = only(replace(results, runs=tuple(runs), scores=early))
        assert found.verdict == "worse"
        assert found.difference.value is not None
        assert found.difference.value > 0  # the mean is honest about what the values are


def _failed(run: RunRow) -> bool:
    return run.status == "planner_failed"


def test_what_left_no_run_is_no_success() -> None:
    results = pairs([1.0] * 20, [1.0] * 20, metric="success", unit="1")
    failure = Failure(suite="suite", scenario="s0", planner="a", seed=0, error="boom", traceback="")
    kept = tuple(r for r in results.runs if r.run_id != "a/s0/0")
    found = only(replace(results, runs=kept, failures=(failure,)))
    assert (found.counts_a.ok, found.losses) == (20, 1)
    assert found.difference.value == pytest.approx(-1 / 20)


def test_runs_that_could_not_be_made_lose_and_both_failing_is_a_tie() -> None:
    results = pairs(HIGH, LOW)
    kept = tuple(r for r in results.runs if r.run_id not in ("a/s0/0", "b/s1/0", "a/s1/0"))
    failures = tuple(
        Failure(suite="suite", scenario=s, planner=p, seed=0, error="boom", traceback="")
        for p, s in (("a", "s0"), ("a", "s1"), ("b", "s1"))
    )
    found = only(replace(results, runs=kept, failures=failures))
    assert (found.pairs, found.wins, found.losses, found.ties) == (20, 18, 1, 1)
    assert found.draws == 20


def test_a_failure_that_was_repaired_is_none() -> None:
    failure = Failure(suite="suite", scenario="s0", planner="a", seed=0, error="", traceback="")
    assert only(replace(pairs(HIGH, LOW), failures=(failure,))).wins == 20


def test_censored_scores_decide_as_far_as_their_bounds_do() -> None:
    sure = without(pairs(HIGH, LOW), "a", "s0", by=censored(run(), lower=1e6))
    assert (only(sure).wins, only(sure).undecided) == (20, 0)
    assert only(sure).bounds[1] is None
    assert (only(sure).bounds[0] or 0.0) > 1e4
    open_ = without(pairs(HIGH, LOW), "a", "s0", by=censored(run(), upper=1e6))
    assert (only(open_).wins, only(open_).undecided) == (19, 1)
    lost = without(pairs(HIGH, LOW), "a", "s0", by=censored(run(), upper=-1e6))
    assert (only(lost).losses, only(lost).undecided) == (1, 0)
    assert only(lost).counts_a.censored == 1


def test_runs_of_one_planner_alone_are_missing_not_lost() -> None:
    results = pairs(HIGH, LOW)
    results = replace(results, runs=tuple(r for r in results.runs if r.run_id != "b/s3/0"))
    found = only(results)
    assert (found.pairs, found.counts_b.missing, found.wins) == (19, 1, 19)


def test_planners_that_share_nothing() -> None:
    results = pairs(HIGH, LOW)
    runs = [changed(r, seed=1) if r.planner == "a" else r for r in results.runs]
    found = only(replace(results, runs=tuple(runs)))
    assert (found.pairs, found.reason) == (0, "no scenario and seed was run with both")


def test_numbers_that_are_none_are_undefined() -> None:
    results = pairs([*HIGH[:-2], float("inf"), float("nan")], LOW)
    found = only(results)
    assert (found.counts_a.undefined, found.undecided) == (2, 2)


def test_a_verdict_needs_means_that_do_not_contradict() -> None:
    # wins most pairs by a little, loses a few by very much: ranks say better, means say worse
    a = [0.01 + 0.0001 * i for i in range(40)]
    b = [0.0] * 36 + [1e3 + i for i in range(4)]
    found = only(pairs(a, b))
    assert found.verdict in ("not distinguishable", "better")
    low, high = found.difference.low, found.difference.high
    assert low is not None
    assert high is not None
    assert found.verdict != "better" or high >= 0


def test_detectable_difference_is_found_four_times_in_five() -> None:
    rng, size, count = np.random.default_rng(4), 18, 400
    found = only(pairs(rng.normal(size=size).tolist(), [0.0] * size))
    assert found.detectable is not None
    # by the noncentral t of the same spread
    from scipy import stats

    error = found.detectable / (stats.t.ppf(0.975, 17) + stats.t.ppf(0.8, 17))
    data = rng.normal(found.detectable, error * size**0.5, size=(count, size))
    power = np.mean(stats.ttest_1samp(data, 0.0, axis=1).pvalue < 0.05)
    assert 0.74 < power < 0.88


def test_people_that_nobody_meets_are_draws_of_their_own() -> None:
    results = pairs(HIGH, LOW, draws=["nobody"] * 20)
    runs = tuple(changed(r, density=None) for r in results.runs)
    assert only(replace(results, runs=runs)).draws == 20


def test_the_challenge_has_eighteen_draws() -> None:
    assert len({draw for _, draw, _ in cells()}) == 18
    summary = summarise(challenge(["a", "b"], 1, np.random.default_rng(0)))
    assert summary.comparisons[0].draws == 18
    assert summary.comparisons[0].pairs == 162
