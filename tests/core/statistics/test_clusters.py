"""Intervals: against scipy where every run is a draw of its own, by hand where they are shared."""

from __future__ import annotations

import math

import numpy as np
import pytest
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


def test_one_draw_has_no_interval() -> None:
    found = c.mean(SOME, Clusters.of(["a"] * len(SOME)))
    assert found.value is not None
    assert found.low is found.high is None
    assert found.reason == c.ONE_DRAW


def test_equal_values_have_an_interval_without_width() -> None:
    equal = np.full(12, 0.1)
    found = c.mean(equal, alone(12))
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
