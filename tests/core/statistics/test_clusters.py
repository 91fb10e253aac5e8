"""Intervals: against scipy where every run is a draw of its own, by hand where they are shared."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Clusters

SOME = np.array([2.1, 0.4, 3.3, -1.2, 0.9, 5.0, 1.1, 0.2, 2.7, 1.6, -0.3, 4.4])


def alone(count: int) -> Clusters:
    return Clusters.of([f"draw {i}" for i in range(count)])


def test_mean_of_single_runs_is_students_interval() -> None:
    found = c.mean(SOME, alone(len(SOME)))
    low, high = stats.t.interval(0.95, len(SOME) - 1, SOME.mean(), stats.sem(SOME))
    assert found.value == pytest.approx(SOME.mean(), rel=1e-14)
    assert found.low == pytest.approx(low)
    assert found.high == pytest.approx(high)


def test_mean_of_equal_draws_is_students_interval_of_their_means() -> None:
    groups = Clusters.of(["a", "b", "c", "d"] * 3)
    means = SOME.reshape(3, 4).mean(axis=0)
    low, high = stats.t.interval(0.95, 3, means.mean(), stats.sem(means))
    found = c.mean(SOME, groups)
    assert found.low == pytest.approx(low)
    assert found.high == pytest.approx(high)


def test_repeating_every_run_of_a_draw_adds_nothing() -> None:
    names = [f"d{i}" for i in range(len(SOME))]
    once = c.mean(SOME, Clusters.of(names))
    often = c.mean(np.repeat(SOME, 9), Clusters.of(list(np.repeat(names, 9))))
    assert often.low == pytest.approx(once.low)
    assert often.high == pytest.approx(once.high)


def test_bca_without_correction_is_that_of_scipy() -> None:
    values = np.exp(np.random.default_rng(5).normal(size=40))
    found = c.bootstrap(c.weighted(lambda a, n: a / n, values), alone(40), studentised=False)
    oracle = stats.bootstrap(
        (values,), np.mean, n_resamples=20_000, method="BCa", rng=np.random.default_rng(1)
    ).confidence_interval
    width = oracle.high - oracle.low
    assert found.low == pytest.approx(oracle.low, abs=0.06 * width)
    assert found.high == pytest.approx(oracle.high, abs=0.06 * width)


def mean_of(values: c.Floats) -> c.Statistic:
    return c.weighted(lambda a, n: a / n, values)


def test_the_correction_for_few_draws_widens() -> None:
    mean = mean_of(SOME)
    plain = c.bootstrap(mean, alone(len(SOME)), studentised=False)
    wide = c.bootstrap(mean, alone(len(SOME)))
    assert wide.low < plain.low < plain.high < wide.high  # type: ignore[operator]


@given(st.lists(st.integers(0, 4), min_size=4, max_size=12).filter(lambda w: sum(w) > 0))
def test_weights_stand_for_repetitions(weights: list[int]) -> None:
    values = SOME[: len(weights)]
    repeated = np.repeat(values, weights)
    by_weight = mean_of(values)(np.array([weights], dtype=float))[0]
    by_hand = mean_of(repeated)(np.ones((1, len(repeated))))[0]
    assert by_weight == pytest.approx(by_hand, abs=1e-12)


def test_the_stream_depends_on_the_draws_alone() -> None:
    names = [f"d{i % 5}" for i in range(len(SOME))]
    whole = np.round(10.0 * SOME)  # whose sums are exact in any order
    order = np.random.default_rng(0).permutation(len(SOME))
    one = c.bootstrap(mean_of(whole), Clusters.of(names))
    c._times.cache_clear()
    other = c.bootstrap(mean_of(whole[order]), Clusters.of([names[i] for i in order]))
    assert one.low == pytest.approx(other.low, abs=1e-12)
    assert one.high == pytest.approx(other.high, abs=1e-12)
    different = c.bootstrap(mean_of(whole), Clusters.of([f"x{n}" for n in names]))
    assert (different.low, different.high) != (one.low, one.high)


def test_one_draw_has_no_interval() -> None:
    for found in (
        c.mean(SOME, Clusters.of(["a"] * len(SOME))),
        c.bootstrap(mean_of(SOME), Clusters.of(["a"] * len(SOME))),
    ):
        assert found.value is not None
        assert found.low is found.high is None
        assert found.reason == c.ONE_DRAW


def test_equal_values_have_an_interval_without_width() -> None:
    equal = np.full(12, 0.1)
    for found in (c.mean(equal, alone(12)), c.bootstrap(mean_of(equal), alone(12))):
        assert found.low == pytest.approx(0.1)
        assert found.high == pytest.approx(0.1)
        assert found.reason == c.NO_SPREAD


def test_nothing_has_no_mean() -> None:
    found = c.mean(np.zeros(0), Clusters.of([]))
    assert (found.value, found.reason) == (None, c.NO_RUNS)


def test_part_forgets_draws_without_runs() -> None:
    groups = Clusters.of(["b", "a", "c", "a"])
    part = groups.part(np.array([True, False, True, False]))
    assert part.names == ("b", "c")
    assert part.index.tolist() == [0, 1]
    assert groups.sums(np.arange(4.0)).tolist() == [4.0, 0.0, 2.0]


def test_huge_values_stay_finite() -> None:
    found = c.mean(SOME * 1e150, alone(len(SOME)))
    assert found.low is not None
    assert math.isfinite(found.low)
