"""RDS: half-planes by hand, for a disc and for a long robot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugins.planners.rds.rds_build import allowed, capsule_ahead, half_planes
from crowdbot.plugins.planners.shared.half_planes_build import best_velocity

#: Radius and margin, m; horizon, s, and distance of the reference point, m.
SIZES, SCALES = (0.3, 0.05), (1.5, 0.2)
REST = (0.0, 0.0, 0.0)
DISC, LONG = np.zeros((2, 2)), np.array([[-0.6, 0.0], [0.4, 0.0]])


def _best(
    things: list[list[float]],
    ends: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = DISC,
    wanted: tuple[float, float] = (1.0, 0.0),
    reach: float = SCALES[1],
    twist: tuple[float, float, float] | None = None,
) -> tuple[float, float]:
    lines, scratch = np.zeros((50, 4)), np.zeros((50, 4))
    table = np.array(things).reshape(-1, 5)
    count = half_planes(
        table, ends, SIZES, twist or REST, (SCALES[0], reach), twist is None, 0, lines
    )
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
        count = half_planes(things, LONG, SIZES, REST, SCALES, True, 0, lines)
        n = np.column_stack([-lines[:count, 3], lines[:count, 2]])
        assert np.all(np.einsum("kc,kc->k", n, lines[:count, :2]) <= 1e-12)
        v, w = best_velocity(lines, count, 0, 10.0, wanted, np.zeros((12, 4)))
        assert math.hypot(v, w) <= math.hypot(*wanted) + 1e-9
        assert np.all(n @ (v, w) >= np.einsum("kc,kc->k", n, lines[:count, :2]) - 1e-9)


def test_a_point_on_the_axle_only_brakes_and_one_ahead_steers() -> None:
    nearly_ahead = [[1.0, 0.1, -0.5, 0.0, 0.3]]
    v, aside = _best(nearly_ahead, DISC)
    assert v < 0.5
    assert aside == pytest.approx(0.0)
    ends, radius = capsule_ahead(np.array([[0.0, 0.0, SIZES[0]]]), SCALES[1])
    assert ends.tolist() == [[0.0, 0.0], [SCALES[1], 0.0]]
    assert radius == SIZES[0]
    v, aside = _best(nearly_ahead, ends)
    assert aside < -0.05
    assert v > 0.0


def test_the_capsule_holds_discs_beside_the_axis_and_keeps_a_front_that_is_farther() -> None:
    discs = np.array([[-0.2, 0.3, 0.2], [0.6, -0.1, 0.25]])
    ends, radius = capsule_ahead(discs, 0.18)
    assert ends.tolist() == [[-0.2, 0.0], [0.6, 0.0]]
    assert radius == pytest.approx(0.5)


def test_around_its_motion_it_gives_way_as_orca_does() -> None:
    """A point that moves at 0.65 m/s at a disc 2 m ahead: the nearest edge of the obstacle."""
    ends = np.array([[0.0, 0.0], [SCALES[1], 0.0]])
    person, far = [2.0 + SCALES[1], 0.1, -1.0, 0.0, 0.3], 2.0
    lines = np.zeros((1, 4))
    table, twist = np.array([person]), (0.65, 0.0, 0.0)
    assert half_planes(table, ends, SIZES, twist, SCALES, False, 0, lines) == 1
    both, away = 2 * 0.3 + 0.05, math.hypot(far, 0.1)
    half = math.asin(both / away)
    edge = math.atan2(0.1, far) - half  # the right leg, which is nearer
    off = 1.65 * math.sin(-edge)
    assert lines[0, :2] @ (-lines[0, 3], lines[0, 2]) == pytest.approx(
        (0.65 * math.sin(edge) + off), abs=1e-9
    )
    v, aside = _best([person], ends, (0.65, 0.0), twist=twist)
    assert aside < -0.3
    assert v > 0.4


def test_where_no_velocity_avoids_all_none_is_allowed() -> None:
    lines = np.array([[0.5, 0.0, 0.0, -1.0], [0.4, 0.0, 0.0, 1.0]])
    assert not allowed(lines, 2, (0.45, 0.0))
    assert allowed(lines, 1, (0.6, 0.0))
