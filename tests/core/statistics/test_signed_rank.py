"""The test and its correction: against scipy and by hand."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.signed_rank import holm, least_p, p_value, signed_ranks


def alone(count: int) -> Clusters:
    return Clusters.of([f"draw {i}" for i in range(count)])


@pytest.mark.parametrize("count", [3, 9, 20, 30, 60])
@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_without_shared_draws_it_is_wilcoxons_exact_test(count: int, shift: float) -> None:
    values = np.random.default_rng(count).normal(shift, 1.0, size=count)
    oracle = stats.wilcoxon(values, mode="exact").pvalue
    assert p_value(signed_ranks(values), alone(count)) == pytest.approx(oracle, rel=1e-9)


def test_many_draws_come_near_the_normal_distribution() -> None:
    values = np.random.default_rng(2).normal(0.05, 1.0, size=1500)
    oracle = stats.wilcoxon(values, mode="approx", correction=False).pvalue
    assert p_value(signed_ranks(values), alone(1500)) == pytest.approx(oracle, rel=1e-6)


def test_ties_and_zeros_are_pratts() -> None:
    values = np.array([0.0, 1.0, -1.0, 2.0, 2.0, 0.0, 3.0, -0.5])
    # sizes 0 0 .5 1 1 2 2 3 -> ranks 1.5 1.5 3 4.5 4.5 6.5 6.5 8
    assert signed_ranks(values).tolist() == [0, 9, -9, 13, 13, 0, 16, -6]
    ranks = signed_ranks(values)
    every = [sum(s * r for s, r in zip(signs, ranks, strict=True)) for signs in
             product((1, -1), repeat=8)]  # fmt: skip
    by_hand = np.mean(np.abs(every) >= abs(ranks.sum()))
    assert p_value(ranks, alone(8)) == pytest.approx(by_hand)


def test_infinite_contrasts_rank_first() -> None:
    assert signed_ranks(np.array([np.inf, 1.0, -np.inf, -2.0])).tolist() == [7, 2, -7, -4]


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(-6, 6)), min_size=1, max_size=14))
def test_shared_draws_flip_together(pairs: list[tuple[int, int]]) -> None:
    groups = Clusters.of([str(draw) for draw, _ in pairs])
    ranks = signed_ranks(np.array([float(value) for _, value in pairs]))
    sums = np.rint(groups.sums(ranks.astype(float)))
    every = np.array([np.dot(signs, sums) for signs in product((1, -1), repeat=groups.count)])
    by_hand = np.mean(np.abs(every) >= abs(sums.sum()) - 1e-9)
    assert p_value(ranks, groups) == pytest.approx(by_hand)
    assert p_value(-ranks, groups) == pytest.approx(by_hand)


def test_both_exact_ways_agree() -> None:
    values = np.random.default_rng(3).normal(0.2, 1.0, size=24)
    ranks = signed_ranks(values)
    from crowdbot.core.statistics import signed_rank

    parts, seen = np.abs(ranks), abs(int(ranks.sum()))
    assert signed_rank._by_halves(parts, seen) == pytest.approx(
        signed_rank._by_sums(parts, seen), rel=1e-9
    )


def test_one_draw_can_prove_nothing() -> None:
    assert p_value(signed_ranks(np.arange(1.0, 10.0)), Clusters.of(["a"] * 9)) == 1.0
    assert least_p(1) == 1.0
    assert least_p(6) == pytest.approx(0.03125)


def test_holm_by_hand() -> None:
    # sorted .005 .01 .03 .04: times 4 3 2 1 = .02 .03 .06 .04 -> .02 .03 .06 .06
    assert holm(np.array([0.01, 0.04, 0.03, 0.005])).tolist() == pytest.approx(
        [0.03, 0.06, 0.06, 0.02]
    )
    assert holm(np.array([0.5, 0.9])).tolist() == [1.0, 1.0]
    assert holm(np.zeros(0)).tolist() == []
