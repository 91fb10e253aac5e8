"""Times to contact and nearest points against brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numba import njit

from crowdbot.core.crowd.contact.geometry import nearest_on_segment, time_to_disc, time_to_segment
from tests.examples import costly

COORDINATE = st.floats(-6.0, 6.0)
SPEED = st.floats(-3.0, 3.0)
RADIUS = st.floats(0.05, 1.0)
HORIZON, STEPS = 12.0, 24_000
TIMES = np.linspace(0.0, HORIZON, STEPS + 1)


def _distance_to_segment(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    s = np.linspace(0.0, 1.0, 4001)
    return float(np.min(np.hypot(ax + s * (bx - ax) - px, ay + s * (by - ay) - py)))


@given(COORDINATE, COORDINATE, COORDINATE, COORDINATE, COORDINATE, COORDINATE)
@costly(200)
def test_nearest_on_segment(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> None:
    x, y = nearest_on_segment(px, py, ax, ay, bx, by)
    found = math.hypot(x - px, y - py)
    step = math.hypot(bx - ax, by - ay) / 4000.0
    best = _distance_to_segment(px, py, ax, ay, bx, by)
    assert best - step - 1e-9 <= found <= best + 1e-9
    on_segment = math.hypot(x - ax, y - ay) + math.hypot(x - bx, y - by)
    assert math.isclose(on_segment, math.hypot(bx - ax, by - ay), abs_tol=1e-9)


def test_nearest_on_a_segment_of_no_length() -> None:
    assert nearest_on_segment(3.0, 4.0, 1.0, 2.0, 1.0, 2.0) == (1.0, 2.0)


def _first_below(distance: np.ndarray[tuple[int], np.dtype[np.float64]], reach: float) -> float:
    touching = np.flatnonzero(distance <= reach)
    return float(TIMES[touching[0]]) if len(touching) else math.inf


@given(COORDINATE, COORDINATE, SPEED, SPEED, RADIUS)
@costly(300)
def test_time_to_disc(rx: float, ry: float, vx: float, vy: float, reach: float) -> None:
    gap2 = rx * rx + ry * ry - reach * reach
    assume(gap2 > 1e-6)
    t = time_to_disc(rx, ry, vx, vy, gap2)
    assert t > 0.0
    speed2 = vx * vx + vy * vy
    assume(abs((rx * vy - ry * vx) ** 2 - reach**2 * speed2) > 1e-6)  # grazing: rounding decides
    distance = np.hypot(rx - vx * TIMES, ry - vy * TIMES)
    sampled = _first_below(distance, reach)
    if math.isfinite(sampled):
        assert sampled - HORIZON / STEPS - 1e-9 <= t <= sampled + 1e-9
        assert math.isclose(math.hypot(rx - vx * t, ry - vy * t), reach, rel_tol=1e-7)
    else:  # never, later, or so grazing that sampling misses it
        speed = math.hypot(vx, vy)
        assert t >= HORIZON or np.min(distance) < reach + speed * HORIZON / STEPS


@pytest.mark.slow
@given(COORDINATE, COORDINATE, COORDINATE, COORDINATE, SPEED, SPEED, st.floats(0.05, 0.5))
@costly(400)
def test_time_to_segment(
    ax: float, ay: float, bx: float, by: float, vx: float, vy: float, radius: float
) -> None:
    """Whenever the disc touches, be it an end or the middle; also at a slant."""
    length = math.hypot(bx - ax, by - ay)
    assume(length > 0.2 and math.hypot(vx, vy) > 0.05)
    assume(_distance_to_segment(0.0, 0.0, ax, ay, bx, by) > radius + 0.01)
    t = time_to_segment(vx, vy, radius, ax, ay, bx, by)
    px, py = vx * TIMES, vy * TIMES
    s = ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / length**2
    s = np.clip(s, 0.0, 1.0)
    distance = np.hypot(ax + s * (bx - ax) - px, ay + s * (by - ay) - py)
    sampled = _first_below(distance, radius)
    step = HORIZON / STEPS
    assume(abs(np.min(distance) - radius) > 1e-4)  # grazing: rounding and sampling decide
    if math.isfinite(sampled):
        assert sampled - step - 1e-6 <= t <= sampled + 1e-6
    else:
        assert t >= HORIZON


@njit(error_model="numpy")  # other roots and products have other bits than Python's
def _least_of_all(
    vx: float, vy: float, radius: float, ax: float, ay: float, bx: float, by: float
) -> float:
    first = time_to_disc(ax, ay, vx, vy, ax * ax + ay * ay - radius * radius)
    first = min(first, time_to_disc(bx, by, vx, vy, bx * bx + by * by - radius * radius))
    sx, sy = bx - ax, by - ay
    cross = vx * sy - vy * sx
    if abs(cross) >= 1e-5:
        t = (ax * sy - ay * sx) / cross - radius * math.hypot(sx, sy) / abs(cross)
        along = (vx * t - ax) * sx + (vy * t - ay) * sy
        if t >= 0.0 and 0.0 <= along <= sx * sx + sy * sy:
            first = min(first, t)
    return first


@given(COORDINATE, COORDINATE, COORDINATE, COORDINATE, SPEED, SPEED, RADIUS, st.floats(-1.0, 1.0))
@costly(2000)
def test_time_to_segment_is_the_least_of_both_ends_and_the_middle(
    ax: float, ay: float, bx: float, by: float, vx: float, vy: float, radius: float, near: float
) -> None:
    """To the last bit, although the ends are not looked at where the middle is touched."""
    assume(_distance_to_segment(0.0, 0.0, ax, ay, bx, by) > radius)
    vx, vy = (ax + 0.02 * near, ay) if abs(near) < 0.5 else (vx, vy)  # often towards an end
    expected = _least_of_all(vx, vy, radius, ax, ay, bx, by)
    assert time_to_segment(vx, vy, radius, ax, ay, bx, by) == expected


def test_time_to_a_long_wall() -> None:
    assert math.isclose(time_to_segment(0.0, 2.0, 0.33, -50.0, 5.0, 50.0, 5.0), (5.0 - 0.33) / 2.0)
    assert math.isclose(time_to_segment(3.0, 2.0, 0.33, -50.0, 5.0, 50.0, 5.0), (5.0 - 0.33) / 2.0)
    assert time_to_segment(0.0, -2.0, 0.33, -50.0, 5.0, 50.0, 5.0) == math.inf
    assert time_to_segment(2.0, 0.0, 0.33, -50.0, 5.0, 50.0, 5.0) == math.inf
    assert time_to_segment(0.0, 0.0, 0.33, -50.0, 5.0, 50.0, 5.0) == math.inf
