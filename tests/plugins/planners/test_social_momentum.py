"""Social Momentum: sides, people who are left out, and what is free."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.plugin import Array
from crowdbot.plugins.planners.social_momentum.social_momentum_build import (
    choose,
    is_free,
    momentum_of,
    touches,
)

NOTHING = np.empty((0, 2))
HERE = (0.0, 0.0, 0.3)
EAST = (1.0, 0.0)
FAN = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 31)
CHOICES = np.column_stack([np.cos(FAN), np.sin(FAN)])
SPEED = st.floats(-1.5, 1.5)


def person(x: float, y: float, u: float, v: float) -> Array:
    return np.array([[x, y, u, v, 0.25]])


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_turns_aside_early_to_the_side_that_is_settled(side: float) -> None:
    met = person(4.0, 0.3 * side, -1.0, 0.0)
    best, momentum = choose(CHOICES, met, NOTHING, HERE, EAST, EAST, (0.8, 2.0, 5.0))
    assert momentum > 0.3
    # The person passes on this side, so the robot goes to the other one.
    assert CHOICES[best, 1] * side < 0.0
    # Without a weight it drives as straight as it may.
    plain, _ = choose(CHOICES, met, NOTHING, HERE, EAST, EAST, (0.0, 2.0, 5.0))
    assert abs(CHOICES[plain, 1]) < abs(CHOICES[best, 1])


def test_momentum_is_that_of_two_bodies_about_the_middle() -> None:
    # Masses 1 at (0, 0) and (3, 1), about (1.5, 0.5): r x v of each, by hand.
    robot = -1.5 * 0.0 - -0.5 * 1.0
    other = 1.5 * 0.2 - 0.5 * -1.0
    found = momentum_of(1.0, 0.0, person(3.0, 1.0, -1.0, 0.2), HERE, EAST, EAST, 5.0)
    assert found == pytest.approx(abs(robot + other))


def test_people_weigh_by_nearness() -> None:
    both = np.concatenate([person(2.0, 1.0, 0.0, 0.0), person(4.0, -1.0, 0.0, 0.0)])
    near, far = (momentum_of(1.0, 0.0, both[k : k + 1], HERE, EAST, EAST, 9.0) for k in (0, 1))
    w = np.array([1.0 / math.hypot(2, 1), 1.0 / math.hypot(4, 1)])
    both_found = momentum_of(1.0, 0.0, both, HERE, EAST, EAST, 9.0)
    assert both_found == pytest.approx((w @ [near, far]) / w.sum())


@pytest.mark.parametrize("place", [(-1.0, 0.5), (9.0, 0.5)])
def test_people_behind_and_far_play_no_part(place: tuple[float, float]) -> None:
    assert momentum_of(1.0, 0.0, person(*place, 0.0, 0.0), HERE, EAST, EAST, 5.0) == 0.0


def test_no_momentum_where_a_side_changes() -> None:
    met = person(3.0, 0.2, -1.0, 0.0)
    toward = (math.cos(0.9), math.sin(0.9))
    assert momentum_of(*toward, met, HERE, EAST, EAST, 5.0) == 0.0
    assert momentum_of(math.cos(-0.9), math.sin(-0.9), met, HERE, EAST, EAST, 5.0) > 0.5


def test_it_stops_where_nothing_is_free() -> None:
    angles = np.linspace(-math.pi, math.pi, 90)
    ring = 0.5 * np.column_stack([np.cos(angles), np.sin(angles)])
    nobody = np.empty((0, 5))
    assert choose(CHOICES, nobody, ring, HERE, EAST, EAST, (0.2, 2.0, 5.0)) == (-1, 0.0)
    assert not is_free(1.0, 0.0, nobody, ring, HERE, 2.0)


@settings(max_examples=200, deadline=None)
@given(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), SPEED, SPEED)
def test_touching_is_that_of_sampled_motion(x: float, y: float, u: float, v: float) -> None:
    t = np.linspace(0.0, 2.0, 2001)
    gap = np.hypot(x - u * t, y - v * t)
    least = float(gap.min())
    if abs(least - 0.5) < 1e-3:
        return
    closes = x * u + y * v > 0.0
    assert touches(x, y, u, v, 0.5, 2.0) == (least < 0.5 and closes)
