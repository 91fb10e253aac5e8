"""regress, ndtw, sdtw: hand cases and failures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.dynamic_time_warping import least_warping, spaced
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from tests.plugins.metrics.scenes import Body, grid, line, polyline, scene, scores_of, value_of, why

T = grid(10)


def through(*corners: tuple[float, float, float], **more: Any) -> Trajectories:
    return scene(T, polyline(T, corners), robot_goal=(10.0, 0.0), **more)


def test_driven_back() -> None:
    found = scores_of("regress", through((0, 0, 0), (4, 4, 0), (6, 2, 0), (10, 8, 0)))
    assert value_of(found) == pytest.approx(2)
    assert value_of(found, "time_share") == pytest.approx(0.2)


def test_turning_on_the_spot_is_no_regress() -> None:
    found = scores_of("regress", through((0, 0, 0), (5, 0, 0), (10, 5, 0)))
    assert value_of(found) == value_of(found, "time_share") == 0


def test_drifting_slowly_is_way_but_no_time() -> None:
    found = scores_of("regress", through((0, 0, 0), (10, -0.4, 0)))
    assert value_of(found) == pytest.approx(0.4)
    assert value_of(found, "time_share") == 0


def test_no_goal() -> None:
    run = scene(T, line(T, (0, 0), (1, 0)))
    assert why(scores_of("regress", run)) == {("undefined", "invalid_no_goal")}


# -------------------------------------------------------------------- likeness
def likeness(run: Trajectories, alone: Trajectories, metric: str = "ndtw", **fields: Any) -> float:
    return value_of(scores_of(metric, run, alone, **fields))


def test_beside_the_reference() -> None:
    alone, run = (scene(T, line(T, (0, y), (1, 0)), goal_time=10.0) for y in (0.0, 0.5))
    assert likeness(run, alone) == pytest.approx(math.exp(-0.5))
    assert likeness(run, alone, dtw_threshold="50 cm") == pytest.approx(math.exp(-1))
    assert likeness(run, alone, "sdtw") == pytest.approx(math.exp(-0.5))
    assert likeness(alone, alone) == 1


def test_waiting_costs_nothing_and_not_arriving_everything() -> None:
    alone = scene(T, line(T, (0, 0), (1, 0)), goal_time=10.0)
    waits = scene(T, polyline(T, [(0, 0, 0), (4, 2, 0), (6, 2, 0), (10, 10, 0)]))
    assert likeness(waits, alone) == pytest.approx(1)
    assert likeness(waits, alone, "sdtw") == 0


def test_standing_is_not_alike() -> None:
    alone = scene(T, line(T, (0, 0), (1, 0)), goal_time=10.0)
    stands = scene(T, line(T, (0, 0), (0, 0)))
    assert likeness(stands, alone) < 0.01


def brute_force(a: Array, b: Array) -> float:
    table = np.full((len(a) + 1, len(b) + 1), np.inf)
    table[0, 0] = 0
    for i, p in enumerate(a):
        for j, q in enumerate(b):
            least = min(table[i, j], table[i, j + 1], table[i + 1, j])
            table[i + 1, j + 1] = np.hypot(*(p - q)) + least
    return float(table[-1, -1])


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(1, 12), m=st.integers(1, 12))
@settings(max_examples=60)
def test_the_diagonals_are_the_table(seed: int, n: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(n, 2)), rng.normal(size=(m, 2))
    assert least_warping(a, b) == pytest.approx(brute_force(a, b))


def test_points_are_as_far_apart_on_the_way() -> None:
    body: Body = polyline(T, [(0, 0, 0), (2, 1, 0), (8, 1, 0), (10, 1, 1)])
    points = spaced(body.x, body.y, np.ones(len(T) - 1, bool), 0.25)
    assert len(points) == 9
    assert np.hypot(*np.diff(points, axis=0).T) == pytest.approx(0.25)
    assert len(spaced(body.x[:1], body.y[:1], np.ones(0, bool), 0.25)) == 1
