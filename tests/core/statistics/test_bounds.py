"""Intervals that respect what a score can be, and rates of all runs together."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from crowdbot.core.registry.registry import discover
from crowdbot.core.results.results import Results
from crowdbot.core.scoring.score_scale import ScoreScale, score_scales
from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Bounds, Clusters
from crowdbot.core.statistics.groups import by_group
from crowdbot.core.statistics.summary import summarise
from crowdbot.core.statistics.summary_estimator import planner_mean, rate_difference
from crowdbot.core.statistics.table import Table
from tests.core.statistics.made_up_results import pairs, score
from tests.core.statistics.test_strata import CONDITIONS, covers, crossed, nested

UNIT: Bounds = (0.0, 1.0)
SCALES = {
    ("contacts_per_km", "corrected"): ScoreScale(minimum=0.0, integer=True, rate_over="way"),
    ("success", "corrected"): ScoreScale(minimum=0.0, maximum=1.0, integer=True),
}


def alone(count: int) -> Clusters:
    """Every run with people of its own."""
    return Clusters.of([str(i) for i in range(count)])


@given(
    st.lists(st.floats(0.0, 1.0), min_size=2, max_size=12),
    st.sampled_from([UNIT, (0.0, math.inf), (-math.inf, 1.0), (-1.0, 1.0)]),
)
def test_no_interval_leaves_its_bounds(values: list[float], bounds: Bounds) -> None:
    found = c.mean(np.array(values), alone(len(values)), bounds=bounds)
    assert found.value is not None
    assert found.low is not None
    assert found.high is not None
    assert bounds[0] <= found.low <= found.value + 1e-12
    assert found.value - 1e-12 <= found.high <= bounds[1]


def test_independent_successes_have_wilsons_interval() -> None:
    n, x = 40, 12
    found = c.mean(np.array([1.0] * x + [0.0] * (n - x)), alone(n), bounds=UNIT)
    t, p, runs = float(stats.t.ppf(0.975, n - 1)), x / n, n - 1  # variance with n - 1
    middle = (p + t**2 / (2 * runs)) / (1 + t**2 / runs)
    half = t * math.sqrt(p * (1 - p) / runs + t**2 / (4 * runs**2)) / (1 + t**2 / runs)
    assert (found.low, found.high) == pytest.approx((middle - half, middle + half))


def test_counts_have_the_score_interval_of_a_rate() -> None:
    """(x - m)² = k m: its two solutions, with the dispersion of the sample."""
    values = np.array([0.0] * 17 + [2.0])
    found = c.mean(values, alone(18), bounds=(0.0, math.inf))
    error, t = float(values.std(ddof=1)) / math.sqrt(18), float(stats.t.ppf(0.975, 17))
    for m in (found.low, found.high):
        assert m is not None
        assert (values.mean() - m) ** 2 == pytest.approx(t**2 * error**2 * m / values.mean())


def test_far_from_the_bounds_it_is_students() -> None:
    values = np.random.default_rng(1).normal(500.0, 1.0, 30)
    near, plain = (c.mean(values, alone(30), bounds=b) for b in ((0.0, 1000.0), c.UNBOUNDED))
    assert (near.low, near.high) == pytest.approx((plain.low, plain.high), abs=2e-3)


@pytest.mark.parametrize("all_of", [0.0, 1.0])
def test_all_alike_at_a_bound_is_not_certainty(all_of: float) -> None:
    """18 draws, each worth one run."""
    found = c.mean(np.full(18, all_of), alone(18), bounds=UNIT)
    width = float(stats.t.ppf(0.975, 17)) ** 2
    width /= 18 + width
    wanted = (1.0 - width, 1.0) if all_of else (0.0, width)
    assert (found.low, found.high) == pytest.approx(wanted)
    assert not found.reason


def test_no_contact_in_some_runs_is_not_none_ever() -> None:
    found = c.mean(np.zeros(18), alone(18), bounds=(0.0, math.inf), step=1.0)
    assert found.low == 0.0
    assert found.high == pytest.approx(float(stats.t.ppf(0.975, 17)) ** 2 / 18)
    without_unit = c.mean(np.zeros(18), alone(18), bounds=(0.0, math.inf))
    assert (without_unit.high, without_unit.reason) == (0.0, c.NO_SPREAD)


def test_bounds_that_do_not_hold_are_left_alone() -> None:
    values = np.array([2.0, 3.0, 4.0])
    assert c.mean(values, alone(3), bounds=UNIT) == c.mean(values, alone(3))


def _successes(
    rng: np.random.Generator, shared: bool, draws: int, hard: float
) -> tuple[c.Floats, float]:
    """Successes of a latent skill; conditions differ, people too. And the true share."""
    ease = np.linspace(-1.0, 1.0, CONDITIONS)[:, np.newaxis]
    people = 0.7 * rng.normal(size=draws if shared else (CONDITIONS, draws))
    skill = ease + people + 0.7 * rng.normal(size=(CONDITIONS, draws))
    truth = float(stats.norm.sf((hard - ease) / math.hypot(0.7, 0.7)).mean())
    return (skill > hard).astype(float).ravel(), truth


def _counts(
    rng: np.random.Generator, shared: bool, draws: int, size: float
) -> tuple[c.Floats, float]:
    ease = 0.5 * np.linspace(-1.0, 1.0, CONDITIONS)[:, np.newaxis]
    people = 0.5 * rng.normal(size=draws if shared else (CONDITIONS, draws))
    truth = float(np.exp(size + ease + 0.125).mean())
    return rng.poisson(np.exp(size + ease + people)).astype(float).ravel(), truth


@pytest.mark.slow
@pytest.mark.parametrize(("shared", "draws"), [(False, 2), (False, 5), (True, 9)])
@pytest.mark.parametrize(
    ("made", "size", "bounds"),
    [
        (_successes, 0.0, UNIT), (_successes, -2.0, UNIT), (_successes, 2.0, UNIT),
        (_counts, -0.5, (0.0, math.inf)),
    ],
)  # fmt: skip
def test_intervals_within_bounds_cover(
    made: Callable[..., tuple[c.Floats, float]],
    size: float,
    bounds: Bounds,
    shared: bool,
    draws: int,
) -> None:
    """Near a bound the plain interval covers 79 to 90 % of these."""
    groups = crossed(draws) if shared else nested(draws)
    rng, times, covered = np.random.default_rng(5), 600, 0
    for _ in range(times):
        sample, truth = made(rng, shared, draws, size)
        covered += covers(c.mean(sample, groups, bounds=bounds, step=1.0), truth)
    cautious = shared and size < 0.0 and bounds == UNIT  # nine draws, mostly without any failure
    assert 0.925 <= covered / times <= (0.999 if cautious else 0.985)  # a standard error is 0.9 %


# --------------------------------------------------------------------------- rates
def rates(counts: dict[str, list[float]], ways: dict[str, list[float]]) -> Results:
    """Contacts and ways (km) of two planners in pairs of runs."""
    kilometre = {p: [n / w for n, w in zip(counts[p], ways[p], strict=True)] for p in counts}
    found = pairs(kilometre["a"], kilometre["b"], better="lower", metric="contacts_per_km")
    over = [
        score(run, ways[run.planner][int(run.scenario[1:])], metric="contacts_per_km",
              variant="way", unit="km", better="none")
        for run in found.runs
    ]  # fmt: skip
    return replace(found, scores=(*found.scores, *over), scales=SCALES)


NAME = ("contacts_per_km", "corrected")
WAYS = {"a": [0.04] * 9 + [0.001], "b": [0.04] * 10}
COUNTS = {"a": [0.0] * 9 + [1.0], "b": [1.0] * 5 + [0.0] * 5}


def test_a_run_that_hardly_moves_does_not_rule_the_rate() -> None:
    found = planner_mean(Table(rates(COUNTS, WAYS)), NAME, "a")
    assert found.value == pytest.approx(1.0 / 0.361)
    assert found.low is not None
    assert found.high is not None
    assert 0.0 <= found.low < 1.0 / 0.361 < found.high < 100.0  # the mean of quotients


def test_rates_are_compared_as_rates() -> None:
    """``a`` has one contact in all, and 1000 per km in that run; its mean of quotients is worse."""
    summary = summarise(rates(COUNTS, WAYS))
    (found,) = (x for x in summary.comparisons if x.variant == "corrected")
    assert found.difference.value == pytest.approx(1.0 / 0.361 - 5.0 / 0.4)
    scores = {s.planner: s for s in summary.scores if s.variant == "corrected"}
    assert scores["a"].mean.value == pytest.approx(1.0 / 0.361)
    assert scores["a"].bounds == (scores["a"].mean.value, scores["a"].mean.value)


def test_without_the_way_it_is_the_mean_of_quotients() -> None:
    whole = rates(COUNTS, WAYS)
    older = replace(whole, scores=tuple(s for s in whole.scores if s.variant != "way"))
    assert planner_mean(Table(older), NAME, "a").value == pytest.approx(100.0)
    table = Table(older)
    assert rate_difference(table, NAME, ("a", "b"), np.ones(10, np.bool_)) is None


def test_the_table_of_a_terminal_has_the_same_rate() -> None:
    (a, _) = by_group(rates(COUNTS, WAYS), "contacts_per_km", ["planner"], "corrected")
    assert a.mean.value == pytest.approx(1.0 / 0.361)
    assert a.mean == planner_mean(Table(rates(COUNTS, WAYS)), NAME, "a")


@pytest.mark.slow
def test_the_interval_of_a_rate_covers() -> None:
    """Runs that fail get less far; 18 conditions with three draws each."""
    rng, groups, times, covered = np.random.default_rng(6), nested(3), 600, 0
    truth = 0.0
    for repetition in range(-40, times):
        luck = rng.normal(size=CONDITIONS * 3 if repetition >= 0 else CONDITIONS * 300)
        way = np.clip(0.03 + 0.02 * luck, 0.001, 0.045)
        count = rng.poisson(np.exp(-1.0 - 0.8 * luck)).astype(float)
        if repetition < 0:
            truth += count.sum() / way.sum() / 40
            continue
        found = c.ratio(count, way, groups, bounds=(0.0, math.inf), step=1.0)
        covered += covers(found, truth)
    assert 0.925 <= covered / times <= 0.985


def test_what_metrics_declare_is_known() -> None:
    scales = score_scales(discover(allow=()))
    assert scales["safe_efficiency", "corrected"].maximum == 1.0
    assert scales["collision_count", "corrected"].integer
    assert scales["contacts_per_km", "at_fault"].rate_over == "way"
    assert scales["contacts_per_km", "way"].rate_over == ""


def test_a_summary_knows_the_bounds() -> None:
    results = replace(pairs([1.0] * 7 + [0.0], [1.0] * 8, metric="success"), scales=SCALES)
    means = {s.planner: s.mean for s in summarise(results).scores}
    for mean in means.values():
        assert mean.low is not None
        assert mean.low > 0.0
        assert mean.high is not None
        assert mean.high <= 1.0
    assert means["b"].low is not None
    assert means["b"].low < 1.0
