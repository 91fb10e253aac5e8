"""How many draws a verdict takes, and that so many do find what they are said to find."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.statistics.sample_size import draws_needed, least_draws, sample_size
from crowdbot.core.statistics.summary import summarise
from tests.core.statistics.made_up_results import pairs


@pytest.mark.parametrize(("tests", "least"), [(1, 6), (2, 7), (4, 8), (12, 9), (40, 11)])
def test_the_least_number_of_draws(tests: int, least: int) -> None:
    assert least_draws(tests, 0.05) == least
    assert tests * 2.0 ** (1 - least) <= 0.05 < tests * 2.0 ** (2 - least)


@pytest.mark.parametrize("count", [5, 6])
def test_a_sample_below_it_has_no_verdict_whatever_the_difference(count: int) -> None:
    summary = summarise(pairs([10.0 + i for i in range(count)], [0.0] * count))
    size = sample_size(summary)
    assert size is not None
    assert (size.draws, size.pairs, size.least) == (count, count, 6)
    assert size.too_small == (count < 6)
    assert ("a verdict needs at least 6" in size.text) == size.too_small
    assert (summary.comparisons[0].verdict == "better") == (not size.too_small)


def test_runs_in_one_crowd_do_not_help() -> None:
    summary = summarise(pairs([1.0] * 30, [0.0] * 30, draws=["one", "two", "three"] * 10))
    size = sample_size(summary)
    assert size is not None
    assert (size.draws, size.pairs, size.too_small) == (3, 30, True)


def test_one_planner_is_compared_with_nobody() -> None:
    results = pairs([1.0], [0.0])
    one = tuple(r for r in results.runs if r.planner == "a")
    assert sample_size(summarise(replace(results, runs=one))) is None


def test_so_many_draws_find_the_difference_in_four_cases_of_five() -> None:
    rng = np.random.default_rng(5)
    first = rng.normal(0.5, 1.0, size=12)
    first = 0.5 + (first - first.mean()) / first.std(ddof=1)  # what is seen is what is there
    (seen,) = summarise(pairs(first.tolist(), [0.0] * 12)).comparisons
    needed = draws_needed(seen, 1, 0.05, 0.95)
    assert needed is not None
    assert needed == pytest.approx(34, abs=1)  # t test: 33.4
    found = [
        summarise(pairs(rng.normal(0.5, 1.0, size=needed).tolist(), [0.0] * needed))
        for _ in range(120)
    ]
    share = np.mean([s.comparisons[0].verdict == "better" for s in found])
    assert 0.70 <= share <= 0.90


def test_more_tests_need_more_and_no_difference_needs_none() -> None:
    rng = np.random.default_rng(5)
    (seen,) = summarise(pairs(rng.normal(0.5, 1.0, size=12).tolist(), [0.0] * 12)).comparisons
    one, forty = (draws_needed(seen, n, 0.05, 0.95) for n in (1, 40))
    assert one is not None
    assert forty is not None
    assert one < forty < 4 * one
    (equal,) = summarise(pairs([1.0] * 12, [1.0] * 12)).comparisons
    assert draws_needed(equal, 1, 0.05, 0.95) is None
