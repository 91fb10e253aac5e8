"""Conditions fixed and people random: strata of draws, and what varies with which."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.variance import nested_variance

CONDITIONS, DRAWS = 18, 5
#: Conditions differ by far more than people do: what an interval about people must not contain.
EFFECTS = 10.0 * np.arange(CONDITIONS)


def nested(draws: int = DRAWS, seeds: int = 1) -> Clusters:
    """Every condition with people of its own."""
    cells = [(i, j) for i in range(CONDITIONS) for j in range(draws) for _ in range(seeds)]
    return Clusters.of([f"{i}/{j}" for i, j in cells], [str(i) for i, _ in cells])


def crossed(draws: int = DRAWS) -> Clusters:
    """Every condition with the same people."""
    cells = [(i, j) for i in range(CONDITIONS) for j in range(draws)]
    return Clusters.of([str(j) for _, j in cells], [str(i) for i, _ in cells])


def values(rng: np.random.Generator, *, shared: bool, draws: int = DRAWS) -> c.Floats:
    people = rng.normal(size=draws if shared else (CONDITIONS, draws))
    noise = 0.5 * rng.normal(size=(CONDITIONS, draws))
    return np.asarray((EFFECTS[:, np.newaxis] + people + noise).ravel())


def test_strata_of_nested_and_of_crossed_draws() -> None:
    assert (nested().strata, nested().count, nested().freedom) == (18, 90, 72)
    assert (crossed().strata, crossed().count, crossed().freedom) == (1, 5, 4)


def test_the_interval_of_a_stratified_mean() -> None:
    sample = values(np.random.default_rng(1), shared=False)
    found = c.mean(sample, nested())
    table = sample.reshape(CONDITIONS, DRAWS)
    error = math.sqrt(float((table.var(axis=1, ddof=1) / DRAWS).sum())) / CONDITIONS
    low, high = stats.t.interval(0.95, CONDITIONS * (DRAWS - 1), table.mean(), error)
    assert found.value == pytest.approx(table.mean())
    assert found.low == pytest.approx(low)
    assert found.high == pytest.approx(high)


@pytest.mark.parametrize("names", [["a"] * 4 + ["b"] * 4, [f"{i}" for i in range(8)]])
def test_one_draw_a_condition_leaves_conditions_to_chance(names: list[str]) -> None:
    sample = np.random.default_rng(2).normal(size=8)
    fixed = Clusters.of(names, [f"condition {i}" for i in range(8)])
    assert fixed.strata == 1
    assert c.mean(sample, fixed) == c.mean(sample, Clusters.of(names))


def test_a_stratum_that_is_left_with_one_draw_ends_the_strata() -> None:
    groups, kept = nested(2), np.ones(2 * CONDITIONS, bool)
    kept[0] = False
    assert groups.part(kept).strata == 1
    kept[1] = False  # without the whole condition the others are as they were
    assert groups.part(kept).strata == CONDITIONS - 1


@pytest.mark.slow
@pytest.mark.parametrize(("shared", "draws"), [(False, 2), (False, 5), (True, 9)])
def test_intervals_cover_what_other_people_would_give(shared: bool, draws: int) -> None:
    """93 to 97 % of intervals cover the mean over these conditions and all people."""
    groups = crossed(draws) if shared else nested(draws)
    rng, truth, times = np.random.default_rng(3), EFFECTS.mean(), 1500
    covered = 0
    for _ in range(times):
        sample = values(rng, shared=shared, draws=draws)
        covered += covers(c.mean(sample, groups), truth)
    assert 0.93 <= covered / times <= 0.97


def covers(found: Estimate, truth: float) -> bool:
    assert found.low is not None
    assert found.high is not None
    return found.low <= truth <= found.high


# ------------------------------------------------------------------ what varies with which
def laid_out(draws: int, seeds: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    draw = np.repeat(np.arange(CONDITIONS * draws), seeds)
    return draw // draws, draw


def test_equal_groups_give_the_textbook_components() -> None:
    condition, draw = laid_out(3, 4)
    sample = np.random.default_rng(5).normal(size=len(draw))
    found = nested_variance(sample, condition, draw)
    cube = sample.reshape(CONDITIONS, 3, 4)
    error = cube.var(axis=2, ddof=1).mean()
    within = cube.mean(axis=2).var(axis=1, ddof=1).mean() - error / 4
    between = cube.mean(axis=(1, 2)).var(ddof=1) - max(0.0, within) / 3 - error / 12
    assert found == pytest.approx((max(0.0, between), max(0.0, within), error))


def test_planted_components_are_recovered() -> None:
    rng, found = np.random.default_rng(6), []
    condition, draw = laid_out(5, 3)
    for _ in range(200):
        sample = (
            3.0 * rng.normal(size=CONDITIONS)[condition]
            + 2.0 * rng.normal(size=CONDITIONS * 5)[draw]
            + rng.normal(size=len(draw))
        )
        kept = rng.random(len(draw)) < 0.8  # unequal groups
        _, index = np.unique(draw[kept], return_inverse=True)
        found.append(nested_variance(sample[kept], condition[kept], index))
    np.testing.assert_allclose(np.mean(np.array(found, float), axis=0), [9.0, 4.0, 1.0], rtol=0.08)


def test_without_repeated_runs_draws_have_the_part_of_seeds() -> None:
    condition, draw = laid_out(4, 1)
    sample = np.random.default_rng(7).normal(size=len(draw))
    found = nested_variance(sample, condition, draw)
    assert found is not None
    assert found[1] == pytest.approx(sample.reshape(CONDITIONS, 4).var(axis=1, ddof=1).mean())
    assert found[2] is None
    assert nested_variance(sample, draw, draw) is None
