"""The four scores come first and are a family of tests; means of censored runs are bounded."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import ScoreRow
from crowdbot.core.scoring.four_scores import MAIN_SCORES, PRIMARY, is_main, main_first
from crowdbot.core.statistics.sign_flip import holm
from crowdbot.core.statistics.summary import headline_names, summarise
from crowdbot.core.statistics.table import Table
from tests.built_in import built_in_metrics
from tests.core.statistics.made_up_results import censored, run, score

OTHERS = [f"a{i:02d}" for i in range(30)]
DRAWS = 12


def results(shift: float, others: float = 0.0) -> Results:
    """Two planners; ``b`` is better by ``shift`` in the four scores, by ``others`` in details."""
    rng = np.random.default_rng(5)
    runs, scores = [], list[ScoreRow]()
    for planner in ("a", "b"):
        for i in range(DRAWS):
            r = run(planner, f"s{i}", f"d{i}")
            runs.append(r)
            names = [(s.metric, s.variant) for s in MAIN_SCORES]
            for m, variant in names + [(m, "corrected") for m in OTHERS]:
                gain = others if m in OTHERS else shift
                value = rng.normal() + gain * (planner == "b")
                scores.append(score(r, value, metric=m, variant=variant))
    return Results(runs=tuple(runs), scores=tuple(scores))


def test_the_four_are_scored_by_metrics_that_exist() -> None:
    known = {c.kind: c for c in built_in_metrics()}
    for one in MAIN_SCORES:
        assert one.variant in known[one.metric].variants
        assert known[one.metric].variants[one.variant].better in ("higher", "lower")
        assert not known[one.metric].experimental
    assert MAIN_SCORES[0] is PRIMARY
    assert len({s.role for s in MAIN_SCORES}) == 4


def test_they_come_first() -> None:
    names = headline_names(Table(results(0.0)))
    assert [n[0] for n in names[:4]] == [s.metric for s in MAIN_SCORES]
    assert [n[0] for n in names[4:]] == OTHERS
    mixed = [("risk", "rate"), ("push_work", "total"), ("push_work", "rate")]
    assert main_first(mixed, lambda n: n) == [mixed[2], *mixed[:2]]
    assert is_main("push_work", "rate")
    assert not is_main("push_work", "total")


def test_the_correction_is_for_the_four_and_not_for_all() -> None:
    summary = summarise(results(1.0))
    assert summary.tests == 4
    main = [x for x in summary.comparisons if is_main(x.metric, x.variant)]
    rest = [x for x in summary.comparisons if not is_main(x.metric, x.variant)]
    for family in (main, rest):
        expected = holm(np.array([x.p for x in family], dtype=float))
        assert [x.p_holm for x in family] == pytest.approx(expected.tolist())
    assert min(x.p_holm or 0 for x in main) < min(x.p_holm or 0 for x in rest)


def test_details_do_not_take_the_power_of_the_four() -> None:
    """However many details there are, the verdict on the four is the same."""
    full = results(2.0)
    few = Results(
        runs=full.runs, scores=tuple(s for s in full.scores if is_main(s.metric, s.variant))
    )
    for metric in [s.metric for s in MAIN_SCORES]:
        one, other = (summarise(r).comparison(metric, "a", "b") for r in (full, few))
        assert one == other
        assert one is not None
        assert one.p_holm is not None


def test_without_the_four_all_are_one_family() -> None:
    full = results(0.0, 1.0)
    bare = Results(runs=full.runs, scores=tuple(s for s in full.scores if s.metric in OTHERS))
    assert summarise(bare).tests == len(OTHERS)


def test_a_rate_stands_for_its_metric() -> None:
    r = run("a", "s")
    scores = tuple(score(r, 1.0, metric="risk", variant=v) for v in ("corrected", "rate"))
    assert headline_names(Table(Results(runs=(r,), scores=scores))) == (("risk", "rate"),)


def test_who_arrives_seldom_has_a_mean_that_is_worth_little() -> None:
    """Nine of ten runs did not arrive: the mean of the other one is 1, that of all at most 0.55."""
    runs = tuple(run("a", f"s{i}", f"d{i}") for i in range(10))
    scores = (score(runs[0], 1.0), *(censored(r, lower=0.0, upper=0.5) for r in runs[1:]))
    (found,) = summarise(Results(runs=runs, scores=scores)).scores
    assert found.mean.value == 1.0
    assert list(found.bounds) == pytest.approx([0.1, 0.55])
    open_ended = (score(runs[0], 1.0), *(censored(r, upper=0.5) for r in runs[1:]))
    (found,) = summarise(Results(runs=runs, scores=open_ended)).scores
    assert found.bounds[0] is None
    assert found.bounds[1] == pytest.approx(0.55)
