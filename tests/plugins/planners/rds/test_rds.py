"""RDS: half-planes by hand, for a disc and for a long robot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugins.planners.rds.rds_build import half_planes
from crowdbot.plugins.planners.shared.half_planes_build import best_velocity

#: Radius and margin, m; horizon, s, and distance of the reference point, m.
SIZES, SCALES = (0.3, 0.05), (1.5, 0.2)
DISC, LONG = np.zeros((2, 2)), np.array([[-0.6, 0.0], [0.4, 0.0]])


def _best(
    things: list[list[float]],
    ends: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = DISC,
    wanted: tuple[float, float] = (1.0, 0.0),
    reach: float = SCALES[1],
) -> tuple[float, float]:
    lines, scratch = np.zeros((50, 4)), np.zeros((50, 4))
    table = np.array(things).reshape(-1, 5)
    count = half_planes(table, ends, SIZES, (SCALES[0], reach), 0, lines)
    return best_velocity(lines, count, 0, 10.0, wanted, scratch)


def test_nothing_around_leaves_the_wish() -> None:
    assert _best([]) == (1.0, 0.0)


def test_it_comes_no_nearer_than_the_margin_within_the_horizon() -> None:
    v, aside = _best([[1.5, 0.0, 0.0, 0.0, 0.3]])
    assert v == pytest.approx((1.5 - 0.3 - 0.3 - 0.05) / 1.5)
    assert aside == pytest.approx(0.0)


def test_a_person_who_goes_away_leaves_the_wish_and_one_who_comes_does_not() -> None:
    assert _best([[1.5, 0.0, 1.0, 0.0, 0.3]]) == (1.0, 0.0)
    v, _ = _best([[1.5, 0.0, -1.0, 0.0, 0.3]])
    assert v == pytest.approx(0.0)  # rest stays allowed


def test_the_front_of_a_long_robot_counts() -> None:
    v, _ = _best([[1.9, 0.0, 0.0, 0.0, 0.3]], LONG)
    assert v == pytest.approx((1.9 - 0.4 - 0.3 - 0.3 - 0.05) / 1.5)


def test_the_tail_does_not_swing_into_what_stands_beside_it() -> None:
    turning = (0.0, 0.3)  # to the left, so that the tail goes right
    assert _best([], LONG, turning) == turning
    beside = [-0.6, -0.75, 0.0, 0.0, 0.3]
    _, aside = _best([beside], LONG, turning)
    gap = 0.75 - 0.3 - 0.3 - 0.05
    assert aside / SCALES[1] * 0.6 == pytest.approx(gap / SCALES[0])
    ahead = [0.4, -0.75, 0.0, 0.0, 0.3]
    assert _best([ahead], LONG, turning) == pytest.approx(turning)


def test_a_robot_that_goes_sideways_keeps_its_own_velocity() -> None:
    v, aside = _best([[0.0, 1.0, 0.0, 0.0, 0.3]], LONG, (0.0, 1.0), reach=0.0)
    assert (v, aside) == pytest.approx((0.0, (1.0 - 0.65) / 1.5))


def test_rest_is_always_allowed() -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        things = np.column_stack([rng.uniform(-2, 2, (12, 2)), rng.normal(size=(12, 2)),
                                  np.full(12, 0.3)])  # fmt: skip
        lines = np.zeros((12, 4))
        wanted = (rng.uniform(-1, 1), rng.uniform(-1, 1))
        count = half_planes(things, LONG, SIZES, SCALES, 0, lines)
        n = np.column_stack([-lines[:count, 3], lines[:count, 2]])
        assert np.all(np.einsum("kc,kc->k", n, lines[:count, :2]) <= 1e-12)
        v, w = best_velocity(lines, count, 0, 10.0, wanted, np.zeros((12, 4)))
        assert math.hypot(v, w) <= math.hypot(*wanted) + 1e-9
        assert np.all(n @ (v, w) >= np.einsum("kc,kc->k", n, lines[:count, :2]) - 1e-9)
