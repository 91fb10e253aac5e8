"""The test of mean differences and its correction: by hand, against scipy, and its level."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from crowdbot.core.statistics import sign_flip
from crowdbot.core.statistics.clusters import Clusters, Floats
from crowdbot.core.statistics.sign_flip import holm, least_p, p_value
from crowdbot.core.statistics.signed_rank import double_ranks, signed_ranks

#: The draws of a campaign of 18 conditions with nine draws each.
CAMPAIGN = Clusters.of([f"{i}" for i in range(162)], [f"{i // 9}" for i in range(162)])


def alone(count: int) -> Clusters:
    return Clusters.of([f"draw {i}" for i in range(count)])


def hall(values: Floats) -> float:
    """Hall's transformed t, by its formula, with the skewness of the sum about zero."""
    n, total = len(values), values.sum()
    variance, third = n * stats.kstat(values, 2), n * stats.kstat(values, 3)
    t = total / variance**0.5
    about_zero = third + 3.0 * variance * values.mean() + n * values.mean() ** 3
    skew = about_zero / (variance + n * values.mean() ** 2) ** 1.5
    return float(t + skew * t**2 / 3 + skew**2 * t**3 / 27 + skew / 6)


@pytest.mark.parametrize("count", [6, 8])
@pytest.mark.parametrize("shift", [0.0, 0.7])
def test_few_draws_are_enumerated(count: int, shift: float) -> None:
    values = np.random.default_rng(count).normal(shift, 1.0, size=count)
    signs = np.array(list(product((1, -1), repeat=count)))
    found = np.abs([hall(values * s) for s in signs])
    by_hand = np.mean(found >= abs(hall(values)) * (1 - 1e-6))
    assert p_value(values, alone(count)) == pytest.approx(by_hand)


@pytest.mark.parametrize("shift", [0.0, 0.12, 0.25])
def test_many_draws_come_near_students_t(shift: float) -> None:
    values = np.random.default_rng(2).normal(shift, 1.0, size=300)
    values -= values.mean() - shift
    oracle = stats.ttest_1samp(values, 0.0).pvalue
    assert p_value(values, alone(300)) == pytest.approx(oracle, rel=0.25, abs=0.01)


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(-6, 6)), min_size=1, max_size=14))
def test_shared_draws_flip_together(pairs: list[tuple[int, int]]) -> None:
    groups = Clusters.of([str(draw) for draw, _ in pairs])
    values = np.array([float(value) for _, value in pairs])
    found = p_value(values, groups)
    assert found == p_value(-values, groups)
    assert found == p_value(groups.sums(values), Clusters.of(groups.names))
    assert least_p(groups.count) <= found <= 1.0


def test_random_flips_agree_with_all_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.random.default_rng(3).normal(0.9, 1.0, size=13)
    exact = p_value(values, alone(13))
    monkeypatch.setattr(sign_flip, "_EXACT", 1)
    assert 0.01 < exact < 0.3
    assert p_value(values, alone(13)) == pytest.approx(exact, rel=0.2)


def test_a_large_difference_has_as_small_a_p_as_the_draws_allow() -> None:
    assert p_value(np.ones(6), alone(6)) == pytest.approx(least_p(6))
    assert p_value(1.0 + 0.01 * np.arange(40.0), alone(40)) < 2e-5


def test_one_bad_draw_does_not_hide_a_large_gain() -> None:
    """35 draws of 36 are won by about 0.5, one is lost by 2.3: Student's p is below 0.001."""
    values = np.append(np.random.default_rng(5).normal(0.5, 0.25, size=35), -2.3)
    conditions = Clusters.of([f"{i}" for i in range(36)], [f"{i // 3}" for i in range(36)])
    assert stats.ttest_1samp(values, 0.0).pvalue < 0.001
    assert p_value(values, alone(36)) < 0.02
    assert p_value(values, conditions) < 0.02
    assert p_value(values - 0.35, alone(36)) > 0.2  # and a small one is not told


def test_one_draw_can_prove_nothing() -> None:
    assert p_value(np.arange(1.0, 10.0), Clusters.of(["a"] * 9)) == 1.0
    assert least_p(1) == 1.0
    assert least_p(6) == pytest.approx(0.03125)


def test_equal_differences_and_none() -> None:
    assert p_value(np.zeros(9), alone(9)) == 1.0
    assert p_value(np.array([1.0, -1.0] * 6), alone(12)) == 1.0
    assert p_value(np.full(20, 1e-200), alone(20)) < 1e-4


def _significant(draw: object, repeats: int = 120) -> tuple[float, float]:
    """Share of campaigns in which the first planner is better, and worse, at 5 %."""
    found = np.array([_verdict(draw()) for _ in range(repeats)])  # type: ignore[operator]
    return float((found > 0).mean()), float((found < 0).mean())


def _verdict(gains: Floats) -> int:
    return int(np.sign(gains.sum())) if p_value(gains, CAMPAIGN) <= 0.05 else 0


def test_a_faster_planner_that_is_worth_nothing_in_a_tenth_of_its_runs_is_not_better() -> None:
    """Equal means with 10 % zeros; a mean lower by 0.02 with 12 %; ranks would say better."""
    rng = np.random.default_rng(12)

    def gains(zeros: float, less: float) -> Floats:
        value = rng.normal(0.7, 0.06, size=162)
        own = np.where(rng.random(162) < zeros, 0.0, value)
        return np.asarray(own - value * (1 - zeros) - less + 0.04 * rng.normal(size=162))

    better, _ = _significant(lambda: gains(0.10, 0.0))
    assert better <= 0.05
    better, worse = _significant(lambda: gains(0.12, 0.02))
    assert better <= 0.02
    assert worse > better
    assert (gains(0.10, 0.0) > 0).mean() > 0.7


def test_level_with_exchangeable_planners_and_power_with_conditions_that_differ() -> None:
    rng = np.random.default_rng(13)
    better, worse = _significant(lambda: rng.normal(size=162) * rng.exponential(size=162))
    assert better + worse <= 0.1  # two standard errors above 0.05 of 120 campaigns: 0.09
    sides = np.repeat(np.linspace(-3.0, 3.0, 18), 9)  # in each condition another planner leads
    better, worse = _significant(lambda: rng.normal(0.25, 1.0, size=162) + sides)
    assert better > 0.75
    assert worse == 0.0


def test_signed_ranks_by_hand() -> None:
    values = np.array([0.0, 1.0, -1.0, 2.0, 2.0, 0.0, 3.0, -0.5])
    # sizes 0 0 .5 1 1 2 2 3 -> ranks 1.5 1.5 3 4.5 4.5 6.5 6.5 8
    assert signed_ranks(values, double_ranks(values)).tolist() == [0, 9, -9, 13, 13, 0, 16, -6]
    infinite = np.array([np.inf, 1.0, -np.inf, -2.0])
    assert signed_ranks(infinite, double_ranks(infinite)).tolist() == [7, 2, -7, -4]


def test_holm_by_hand() -> None:
    # sorted .005 .01 .03 .04: times 4 3 2 1 = .02 .03 .06 .04 -> .02 .03 .06 .06
    assert holm(np.array([0.01, 0.04, 0.03, 0.005])).tolist() == pytest.approx(
        [0.03, 0.06, 0.06, 0.02]
    )
    assert holm(np.array([0.5, 0.9])).tolist() == [1.0, 1.0]
    assert holm(np.zeros(0)).tolist() == []
