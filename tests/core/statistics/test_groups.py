"""Groups of results: what a mean over some of the runs is worth."""

from __future__ import annotations

import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.groups import by_group
from crowdbot.errors import InputError
from tests.core.statistics.made_up_results import censored, run, score


def test_the_mean_of_those_who_arrived_and_that_of_all() -> None:
    runs = tuple(run("a", f"s{i}") for i in range(4))
    scores = (score(runs[0], 1.0), *(censored(r, lower=0.0, upper=0.4) for r in runs[1:]))
    (found,) = by_group(Results(runs=runs, scores=scores), "m", ["planner"])
    assert (found.mean.value, found.counts.ok, found.counts.censored) == (1.0, 1, 3)
    assert found.bounds == pytest.approx((0.25, 0.55))


def test_an_undefined_score_may_be_anything() -> None:
    runs = (run("a", "s0"), run("a", "s1"))
    scores = (score(runs[0], 1.0), score(runs[1], reason="no_agents"))
    (found,) = by_group(Results(runs=runs, scores=scores), "m", ["planner"])
    assert (found.mean.value, found.bounds) == (1.0, (None, None))


def test_the_rate_is_what_is_usually_asked_for() -> None:
    one = run("a", "s0")
    scores = tuple(score(one, v, variant=n) for n, v in (("corrected", 9.0), ("rate", 0.1)))
    results = Results(runs=(one,), scores=scores)
    assert by_group(results, "m", ["planner"])[0].mean.value == 0.1
    assert by_group(results, "m", ["planner"], "corrected")[0].mean.value == 9.0


def test_a_metric_that_was_not_scored_is_told_with_what_scores_it() -> None:
    one = run("a", "s0")
    results = Results(runs=(one,), scores=(score(one, 1.0),))
    expected = (
        "metric 'speed' was not scored in these runs; 'crowdbot evaluate RUNS --metrics speed'"
    )
    with pytest.raises(InputError, match=expected):
        by_group(results, "speed", ["planner"])
