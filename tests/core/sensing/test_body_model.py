"""Legs and trunks of people."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.sensing.body_model import LEGS, PARTS, TRUNK, place_people
from tests.core.sensing.sensing_worlds import crowd_of, cylinders

Array = NDArray[np.float64]
HEIGHT = 1.7


def placed(
    xyv: Array, direction: Array, walked: Array, radius: float = 0.33, height: float = HEIGHT
) -> Array:
    """(M, 3, 5)."""
    count = len(xyv)
    out = np.empty((count * PARTS, 5))
    everybody = np.ones(count, np.bool_)
    body = np.full(count, radius), np.full(count, height)
    place_people(xyv, everybody, direction, walked, *body, out)
    bodies: Array = out.reshape(count, PARTS, 5)
    return bodies


def walker(speed: float, walked: float, radius: float = 0.33) -> Array:
    """Somebody at (3, -1) on the way along y."""
    xyv, ahead = np.array([[3.0, -1.0, 0.0, speed]]), np.array([[0.0, 1.0]])
    body: Array = placed(xyv, ahead, np.array([walked]), radius)[0]
    return body


@given(st.integers(0, 2**32 - 1), st.floats(1.0, 2.1), st.floats(0.1, 0.6))
def test_equals_the_formula(seed: int, height: float, radius: float) -> None:
    crowd = crowd_of(seed, 5)
    got = placed(*crowd, radius=radius, height=height).reshape(-1, 5)
    expected = np.array(cylinders(*crowd, height=height, radius=radius))[:, :5]
    np.testing.assert_allclose(got, expected, atol=1e-12)


@given(st.floats(0.0, 2.0), st.floats(0.0, 20.0), st.floats(0.1, 0.5))
def test_everything_stays_inside_the_disc_that_touches(
    speed: float, walked: float, radius: float
) -> None:
    for x, y, r, bottom, top in walker(speed, walked, radius):
        assert math.hypot(x - 3.0, y + 1.0) + r <= radius + 1e-9
        assert 0.0 <= bottom < top <= HEIGHT


def test_legs_swing_against_each_other_and_the_trunk_stays() -> None:
    stride = 0.83 * HEIGHT
    for share in (0.0, 0.1, 0.25, 0.6, 0.75):
        body = walker(1.2, share * stride)
        legs = body[list(LEGS), :2] - (3.0, -1.0)
        assert legs.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-12)
        assert legs[0, 1] == pytest.approx(0.19 * math.sin(math.tau * share), abs=1e-12)
        assert legs[0, 0] < 0.0  # the first leg is the left one
        assert body[TRUNK, :2].tolist() == [3.0, -1.0]
        np.testing.assert_allclose(walker(1.2, (share + 3) * stride), body, atol=1e-9)


def test_who_stands_has_the_legs_side_by_side() -> None:
    legs = walker(0.0, 0.3)[list(LEGS), :2]
    assert legs[:, 1].tolist() == [-1.0, -1.0]
    assert abs(legs[0, 0] - legs[1, 0]) == pytest.approx(0.9 * 0.191 * HEIGHT)


def test_legs_end_where_the_trunk_begins() -> None:
    left, right, trunk = walker(1.0, 0.7)
    assert left[4] == right[4] == trunk[3] == pytest.approx(0.53 * HEIGHT)
    assert trunk[4] == HEIGHT


def test_who_is_absent_is_nowhere() -> None:
    out = np.zeros((6, 5))
    two, way = np.zeros((2, 4)), np.tile([1.0, 0.0], (2, 1))
    sizes = np.full(2, 0.33), np.full(2, HEIGHT)
    place_people(two, np.array([True, False]), way, np.zeros(2), *sizes, out)
    assert np.isfinite(out[:3]).all()
    assert np.isinf(out[3:, :2]).all()
