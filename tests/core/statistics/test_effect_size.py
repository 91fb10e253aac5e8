"""Cohen's d: its interval is that of the noncentral t, and finite however few draws there are."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.effect_size import ALL_EQUAL, ONE_PAIR, effect_size


def alone(count: int) -> Clusters:
    return Clusters.of([f"draw {i}" for i in range(count)])


def test_ends_are_those_at_which_the_data_are_the_tail() -> None:
    gains = np.array([0.4, 1.3, 0.2, 2.0, 0.9])
    found = effect_size(gains, alone(5))
    assert found.value == pytest.approx(gains.mean() / gains.std(ddof=1))
    assert found.low is not None
    assert found.high is not None
    t = stats.ttest_1samp(gains, 0.0).statistic
    root = math.sqrt(5)
    assert stats.nct.sf(t, 4, found.low * root) == pytest.approx(0.025, abs=1e-6)
    assert stats.nct.cdf(t, 4, found.high * root) == pytest.approx(0.025, abs=1e-6)


@pytest.mark.parametrize("gains", [
    [-0.2001, -0.2, -0.23], [-0.2, -0.2 - 1e-9, -0.25], [1.0, 1.0 + 1e-8], [-5.0, -5.001, -5.0015],
])  # fmt: skip
def test_few_draws_of_nearly_equal_gains_stay_finite(gains: list[float]) -> None:
    """A bootstrap gave [-8.5e8, -7.6]: a resample of one draw, thrice, has almost no spread."""
    found = effect_size(np.array(gains), alone(len(gains)))
    assert found.value is not None
    assert found.low is not None
    assert found.high is not None
    assert found.low < found.value < found.high
    assert max(abs(found.low), abs(found.high)) < 3.0 * abs(found.value)


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=8), st.integers(2, 4))
def test_zero_is_inside_where_it_is_inside_of_students(gains: list[float], draws: int) -> None:
    values = np.array(gains)
    groups = Clusters.of([f"d{i % draws}" for i in range(len(gains))])
    found, mean = effect_size(values, groups), c.mean(values, groups)
    if found.low is None or found.high is None or mean.low is None or mean.high is None:
        assert found.reason in (ONE_PAIR, ALL_EQUAL, c.ONE_DRAW, c.NO_SPREAD)
        return
    close = 1e-6 * (mean.high - mean.low)
    if min(abs(mean.low), abs(mean.high)) > close:
        assert (found.low < 0.0 < found.high) == (mean.low < 0.0 < mean.high)
    assert math.isfinite(found.low)
    assert math.isfinite(found.high)


def test_intervals_cover_with_three_shared_draws() -> None:
    rng, groups = np.random.default_rng(3), Clusters.of([f"d{i}" for i in range(3)] * 9)
    covered = 0
    for _ in range(200):
        values = 0.5 * math.sqrt(2.0) + rng.normal(size=3)[groups.index] + rng.normal(size=27)
        found = effect_size(values, groups)
        covered += (found.low or 0.0) <= 0.5 <= (found.high or 0.0)
    assert covered >= 0.9 * 200


def test_without_spread_between_draws_there_is_no_interval() -> None:
    gains = np.array([1.0, 3.0, 1.0, 3.0])
    found = effect_size(gains, Clusters.of(["a", "a", "b", "b"]))
    assert found.value is not None
    assert (found.low, found.high, found.reason) == (None, None, c.NO_SPREAD)


def test_one_draw_has_no_interval() -> None:
    found = effect_size(np.array([1.0, 3.0]), Clusters.of(["a", "a"]))
    assert (found.low, found.high, found.reason) == (None, None, c.ONE_DRAW)
