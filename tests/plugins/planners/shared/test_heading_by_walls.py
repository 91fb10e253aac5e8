"""Heading by walls: turns that wheels do not notice."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from crowdbot.plugin import Array, LidarPoints, Pose
from crowdbot.plugins.planners.shared.heading_by_walls_build import (
    BINS,
    HeadingByWalls,
    directions,
    turned,
)
from tests.plugins.planners.world import World, crowd

LIDARS = LidarPoints({n: s.info() for n, s in World().sensors.items()})


def seen_from(pose: Pose, people: Array | None = None, walls: bool = True) -> Array:
    """What both lidars show in the corridor, base frame, m."""
    world = World(() if people is None else people, start=pose)
    if not walls:
        world = World(() if people is None else people, start=pose, walls=np.empty((0, 4)))
    obs = world._observe()
    return LIDARS(obs.readings, obs.t, (0.0, 0.0))


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.floats(-4.0, 4.0), st.integers(0, 40))
def test_the_turn_is_the_one_of_the_best_fit(seed: int, guess: float, filled: int) -> None:
    rng = np.random.default_rng(seed)
    memory, seen = rng.random(BINS), np.zeros(BINS)
    seen[rng.choice(BINS, filled, replace=False)] = rng.random(filled)
    found = turned(memory, seen, guess, np.zeros(BINS, np.int64))
    middle, wide = round(guess / math.pi * BINS), int(0.75 / math.pi * BINS)
    turns = np.arange(middle - wide, middle + wide + 1)
    fit = [float(seen @ np.roll(memory, -turn)) for turn in turns]
    best = turns[int(np.argmax(fit))] if filled else guess / math.pi * BINS
    assert abs(found / math.pi * BINS - best) <= 0.5 + 1e-9


def off(a: float, b: float) -> float:
    return abs(math.remainder(a - b, 2.0 * math.pi))


@settings(max_examples=40)
@given(st.floats(-3.0, 3.0), st.floats(-0.65, 0.65), st.floats(5.0, 40.0), st.floats(-3.5, 3.5))
@example(0.0, 0.5, 20.0, 0.0)
def test_a_turn_that_nobody_told_is_noticed(yaw: float, push: float, x: float, y: float) -> None:
    heading = HeadingByWalls()
    odometry = Pose(x, y, yaw)
    assert off(heading.pose(odometry, seen_from(odometry)).yaw, yaw) == 0.0
    found = heading.pose(odometry, seen_from(Pose(x, y, yaw + push)))
    near = 0.5 if abs(push) > 0.03 else 1.7  # up to 0.02 rad odometry is believed
    assert off(found.yaw, yaw + push) < math.radians(near)


def test_nobody_touches_it_and_it_heads_as_odometry_says() -> None:
    heading = HeadingByWalls()
    for k in range(50):
        odometry = Pose(5.0 + 0.04 * k, 0.0, 0.01 * k)
        assert heading.pose(odometry, seen_from(odometry)) == pytest.approx(odometry)


def test_many_bumps_among_people() -> None:
    """Thirty bumps of up to 30 degrees: odometry is lost, the walls are not."""
    rng = np.random.default_rng(3)
    heading, yaw, values = HeadingByWalls(), 0.0, 0.0
    worst = 0.0
    for k in range(300):
        x = 5.0 + 0.04 * k
        if k % 10 == 9:
            yaw += rng.uniform(-0.5, 0.5)  # a bump; wheels slip
        people = crowd(k // 40, 60, (0.0, 1.0), (1,))
        found = heading.pose(Pose(x, 0.0, values), seen_from(Pose(x, 0.0, yaw), people))
        worst = max(worst, off(found.yaw, yaw))
    assert abs(yaw) > 0.5
    assert worst < math.radians(2.0)


def test_where_no_wall_is_seen_odometry_is_believed() -> None:
    heading = HeadingByWalls()
    nothing = np.empty((0, 2))
    for k in range(5):
        odometry = Pose(0.1 * k, 0.0, 0.3 * k)
        assert heading.pose(odometry, nothing) == pytest.approx(odometry)


def test_legs_are_no_walls() -> None:
    people = np.array([[10.0 + 0.9 * k, 0.8 * (-1) ** k, 0.0, 0.0] for k in range(-4, 5)])
    cloud = seen_from(Pose(10.4, 0.1, 0.0), people, walls=False)
    assert len(cloud) > 40
    assert directions(cloud, np.zeros(BINS)) < 12


def test_the_way_is_laid_along_the_true_heading() -> None:
    """After an unnoticed turn to the left, 1 m forward by the wheels is 1 m to the left."""
    heading = HeadingByWalls()
    heading.pose(Pose(20.0, 0.0, 0.0), seen_from(Pose(20.0, 0.0, 0.0)))
    heading.pose(Pose(20.0, 0.0, 0.0), seen_from(Pose(20.0, 0.0, 0.6)))
    found = heading.pose(Pose(21.0, 0.0, 0.0), seen_from(Pose(20.8, 0.56, 0.6)))
    assert (found.x, found.y) == pytest.approx((20.0 + math.cos(0.6), math.sin(0.6)), abs=0.02)


def test_all_directions_are_counted_once() -> None:
    line = np.column_stack([np.linspace(0.0, 2.0, 60), np.full(60, 1.0)])
    out = np.zeros(BINS)
    count = directions(line, out)
    assert count == 55
    assert out.sum() == pytest.approx(count)
    assert np.argmax(out) == 0
    directions(line[:, ::-1].copy(), out)
    assert np.argmax(out) == BINS // 2


def line(angle: float, points: int) -> Array:
    """Points 3 cm apart on a straight line 2 m away at an angle, (P, 2), base frame, m."""
    along = 0.03 * (np.arange(points) - points / 2)
    way = np.array([math.cos(angle), math.sin(angle)])
    return np.asarray(along[:, None] * way + 2.0 * np.array([-way[1], way[0]]))


@pytest.mark.parametrize(("points", "noticed"), [(24, False), (200, True)])
def test_a_table_at_an_angle_is_no_turn_and_a_wall_is(points: int, noticed: bool) -> None:
    heading, values = HeadingByWalls(), Pose(0.0, 0.0, 0.0)
    heading.pose(values, line(0.0, 200))
    found = heading.pose(values, line(0.5, points))
    assert (off(found.yaw, 0.0) > 0.4) is noticed
