"""A whole campaign: counts, headlines, ranks, axes, false findings, time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.statistics import clusters
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.effect_size import effect_size
from crowdbot.core.statistics.sign_flip import holm, p_value
from crowdbot.core.statistics.summary import headline_names, summarise
from crowdbot.core.statistics.table import Table
from tests.core.statistics.made_up_results import (
    AXES,
    cells,
    censored,
    challenge,
    pairs,
    run,
    score,
)


@pytest.mark.slow
def test_three_planners_times_162_times_60() -> None:
    results = challenge(["a", "b", "c"], 60, np.random.default_rng(1))
    summary = summarise(results)
    assert len(summary.comparisons) == summary.tests == 180
    assert len(summary.scores) == 180


def test_the_same_results_give_the_same_numbers() -> None:
    results = challenge(["a", "b"], 2, np.random.default_rng(1))
    mixed = replace(results, runs=results.runs[::-1], scores=results.scores[::-1])
    assert summarise(results).comparisons[0].p == summarise(mixed).comparisons[0].p
    one, other = (summarise(r).scores[0].mean for r in (results, mixed))
    assert one.low == pytest.approx(other.low, abs=1e-12)


@pytest.mark.slow
def test_no_difference_between_a_planner_and_itself() -> None:
    """Two sets of runs of one planner: any false finding in at most 5 % of repetitions."""
    rng = np.random.default_rng(20)
    draws = [draw for _, draw, _ in cells()]
    groups = Clusters.of(draws)
    false = 0
    for _ in range(300):
        shared = rng.normal(size=(6, 18))[:, groups.index]
        contrasts = shared + rng.normal(size=(6, 162))
        p = np.array([p_value(c, groups) for c in contrasts])
        false += bool((holm(p) <= 0.05).any())
    assert false <= 26  # at most 15 are expected; more than 26 has a chance of 0.3 %


@pytest.mark.slow
def test_taking_runs_for_draws_would_find_differences() -> None:
    """Why draws are clusters: a test of single runs is wrong about the same data."""
    rng = np.random.default_rng(21)
    groups = Clusters.of([draw for _, draw, _ in cells()])
    false = 0
    for _ in range(200):
        contrasts = rng.normal(size=18)[groups.index] + rng.normal(size=162)
        apart = Clusters.of([str(i) for i in range(162)])
        false += p_value(contrasts, apart) <= 0.05
    assert false > 60


@pytest.mark.parametrize("spread", [(0.0, 1.0), (1.0, 1.0), (2.0, 0.5)])
def test_intervals_cover_with_shared_draws(spread: tuple[float, float]) -> None:
    """Nominal 95 %; benchmarks/interval_coverage.py looks closer."""
    rng = np.random.default_rng(22)
    groups = Clusters.of([draw for _, draw, _ in cells()])
    covered = np.zeros(3)
    for _ in range(150):
        values = spread[0] * rng.normal(size=18)[groups.index] + spread[1] * rng.normal(size=162)
        for i, found in enumerate((
            clusters.mean(values, groups),
            effect_size(values, groups),
            clusters.mean(0.5 + np.sign(values) / 2, groups),
        )):  # fmt: skip
            truth = 0.5 if i == 2 else 0.0
            covered[i] += (found.low or 0.0) <= truth <= (found.high or 0.0)
    assert covered.min() >= 0.89 * 150
    assert covered.max() <= 150


def test_a_difference_beyond_the_noise_is_found() -> None:
    shift = {"a": 0.0, "b": 2.0, "c": 2.0}
    summary = summarise(challenge(["a", "b", "c"], 3, np.random.default_rng(3), lambda p: shift[p]))
    assert summary.ranks("m00") == {"a": 3, "b": 1, "c": 1}
    found = summary.comparison("m00", "a", "b")
    assert found is not None
    assert found.verdict == "worse"
    assert summary.comparison("m00", "b", "a") is None


def test_counts_show_every_run() -> None:
    runs = tuple(run("a", f"s{i}", f"d{i}") for i in range(4))
    failed = run("a", "s9", "d9", status="planner_failed")
    worse = run("a", "s8", "d8", status="planner_failed")
    scores = (score(runs[0], 1.0), score(runs[1], reason="no_agents"), censored(runs[2], 0.5))
    after = (*scores, score(failed, 0.0), censored(worse, 0.5))
    (found,) = summarise(Results(runs=(*runs, failed, worse), scores=after)).scores
    counts = found.counts
    assert (counts.ok, counts.undefined, counts.censored, counts.failed) == (2, 2, 1, 1)
    assert counts.tried == 6
    assert found.reasons == {
        "goal_not_reached": 1, "no_agents": 1, "not_scored": 1, "planner_failed": 1,
    }  # fmt: skip
    assert (found.mean.value, found.least, found.most) == (0.5, 0.0, 1.0)


def test_headlines_take_restricted_where_it_knows_more() -> None:
    runs = [run("a", f"s{i}") for i in range(2)]
    scores = []
    for i, r in enumerate(runs):
        full = score(r, 1.0, metric="e") if i else censored(r, metric="e")
        scores += [full, score(r, 1.0, metric="e", variant="restricted"),
                   score(r, 1.0, metric="e", variant="literal"), score(r, 1.0, metric="f"),
                   score(r, 1.0, metric="g", variant="literal"),
                   score(r, metric="h", reason="no_command")]  # fmt: skip
    table = Table(Results(runs=tuple(runs), scores=tuple(scores)))
    assert headline_names(table) == (("e", "restricted"), ("f", "corrected"), ("g", "literal"))


def test_nothing_at_all() -> None:
    summary = summarise(Results())
    assert (summary.planners, summary.scores, summary.comparisons) == ((), (), ())
    assert summary.ranks("m") == {}


def test_effect_of_an_axis_by_hand() -> None:
    # values 1 2 3 | 5 6 7: total 28, between 24, within 4 -> noise 1
    runs = tuple(run("a", f"s{i}", f"d{i}", axes={"flow": "in" if i < 3 else "counter"})
                 for i in range(6))  # fmt: skip
    scores = tuple(score(r, v) for r, v in zip(runs, (1.0, 2, 3, 5, 6, 7), strict=True))
    flow, density = summarise(Results(runs=runs, scores=scores)).axes
    assert flow.eta_squared == pytest.approx(24 / 28)
    assert flow.omega_squared == pytest.approx((24 - 1) / (28 + 1))
    assert [(x.label, x.runs, x.mean) for x in flow.levels] == [("in", 3, 2.0), ("counter", 3, 6.0)]
    assert density.reason == "no spread of densities or values"


def test_every_axis_has_its_effect_and_the_real_density_too() -> None:
    summary = summarise(challenge(["a"], 1, np.random.default_rng(0)))
    assert [e.axis for e in summary.axes] == [*AXES, "realised density"]
    assert [x.label for x in summary.densities] == list(AXES["density"])
    assert all(x.least <= x.mean <= x.most for x in summary.densities)
    assert sum(x.runs for x in summary.densities) == 162


def test_a_score_that_follows_density_says_so() -> None:
    runs = tuple(run("a", f"s{i}", f"d{i}", density=0.1 * i) for i in range(8))
    scores = tuple(score(r, 3.0 * (r.density or 0.0) + 1.0) for r in runs)
    (found,) = summarise(Results(runs=runs, scores=scores)).axes
    assert found.eta_squared == pytest.approx(1.0)


@pytest.mark.parametrize(("values", "reason"), [
    ([2.0] * 6, "all values are equal"),
    ([1.0, None, None, None, None, None], "fewer than two labels have a value"),
    ([1.0, None, None, 2.0, None, None], "one value a label: chance cannot be told from the axis"),
])  # fmt: skip
def test_axes_without_an_effect_say_why(values: list[float | None], reason: str) -> None:
    runs = tuple(run("a", f"s{i}", axes={"flow": "in" if i < 3 else "counter"}) for i in range(6))
    scores = tuple(score(r, v) for r, v in zip(runs, values, strict=True))
    flow = summarise(Results(runs=runs, scores=scores)).axes[0]
    assert (flow.omega_squared, flow.reason) == (None, reason)


@pytest.mark.parametrize("scale", [1e300, 1e-300])
def test_very_large_and_very_small_scores_are_summarised_without_overflow(scale: float) -> None:
    rng = np.random.default_rng(2)
    a, b = (rng.random((2, 20)) + 0.5).tolist()
    with np.errstate(over="raise", invalid="raise"):
        plain = summarise(pairs(a, b)).comparisons[0]
        found = summarise(pairs([scale * x for x in a], [scale * x for x in b])).comparisons[0]
    assert (found.p, found.verdict) == (plain.p, plain.verdict)
    for one, other in (
        (found.difference, plain.difference),
        (found.improvement, plain.improvement),
    ):
        unit = scale if one is found.difference else 1.0
        assert one.low is not None
        assert other.low is not None
        assert one.low / unit == pytest.approx(other.low)
    assert found.standardised.value == pytest.approx(plain.standardised.value)
