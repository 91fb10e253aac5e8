"""Tables of results: what a mean over some of the runs is worth."""

from __future__ import annotations

import pytest

from crowdbot.core.results.rows import Results
from crowdbot.core.results.tables import summarise
from tests.core.statistics.made_up_results import censored, run, score


def test_the_mean_of_those_who_arrived_and_that_of_all() -> None:
    runs = tuple(run("a", f"s{i}") for i in range(4))
    scores = (score(runs[0], 1.0), *(censored(r, lower=0.0, upper=0.4) for r in runs[1:]))
    (found,) = summarise(Results(runs=runs, scores=scores), "m", ["planner"])
    assert (found.mean, found.count, found.censored) == (1.0, 1, 3)
    assert found.low == pytest.approx(0.25)
    assert found.high == pytest.approx(0.55)


def test_an_undefined_score_may_be_anything() -> None:
    runs = (run("a", "s0"), run("a", "s1"))
    scores = (score(runs[0], 1.0), score(runs[1], reason="no_agents"))
    (found,) = summarise(Results(runs=runs, scores=scores), "m", ["planner"])
    assert (found.mean, found.low, found.high) == (1.0, None, None)


def test_the_rate_is_what_is_usually_asked_for() -> None:
    one = run("a", "s0")
    scores = tuple(score(one, v, variant=n) for n, v in (("corrected", 9.0), ("rate", 0.1)))
    results = Results(runs=(one,), scores=scores)
    assert summarise(results, "m", ["planner"])[0].mean == 0.1
    assert summarise(results, "m", ["planner"], "corrected")[0].mean == 9.0
