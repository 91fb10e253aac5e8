"""Half-planes, distance fields, discs around outlines, and the way past what stands."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.plugin import Pose, RobotBody, RobotLimits
from crowdbot.plugins.planners.follow_the_gap.follow_the_gap_build import widest_gap
from crowdbot.plugins.planners.orca.orca_build import followable
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.distance_field_build import CELL, DistanceField, distance_at
from crowdbot.plugins.planners.shared.follow_velocity_build import follow
from crowdbot.plugins.planners.shared.half_planes_build import avoid, best_velocity, violation
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder, is_blocked
from crowdbot.plugins.planners.vfh_plus.vfh_plus_build import openings

SPEED = st.floats(-1.5, 1.5)


@settings(max_examples=60, deadline=None)
@given(st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0)), SPEED, SPEED, SPEED, SPEED)
def test_the_full_evasion_ends_at_the_border_of_the_velocity_obstacle(
    place: tuple[float, float], u: float, v: float, ou: float, ov: float
) -> None:
    radius, time = 0.5, 2.0
    if math.hypot(*place) < radius + 0.05:
        return
    line = np.zeros(4)
    avoid(place, (u, v), (ou, ov), radius, time, 0.25, 1.0, line)
    assert math.hypot(line[2], line[3]) == pytest.approx(1.0)
    # the chosen velocity touches the disc at one time within the horizon, or just does not
    t = np.linspace(0.0, time, 4001)
    gap = np.hypot(place[0] - (line[0] - ou) * t, place[1] - (line[1] - ov) * t)
    assert gap.min() == pytest.approx(radius, abs=0.01)


def test_two_robots_that_share_the_evasion_pass() -> None:
    line, scratch = np.zeros((1, 4)), np.zeros((1, 4))
    found = []
    for sign in (1.0, -1.0):
        avoid(
            (3.0 * sign, 0.1 * sign),
            (1.0 * sign, 0.0),
            (-1.0 * sign, 0.0),
            0.6,
            5.0,
            0.25,
            0.5,
            line[0],
        )
        found.append(best_velocity(line, 1, 0, 1.0, (sign, 0.0), scratch))
    (u, v), (ou, ov) = found
    t = np.linspace(0.0, 5.0, 500)
    assert np.hypot(3.0 + (ou - u) * t, 0.1 + (ov - v) * t).min() > 0.599
    assert (u, v) == pytest.approx((-ou, -ov))


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000))
def test_no_sampled_velocity_is_better_than_the_best(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 6))
    lines = np.zeros((count, 4))
    for row in lines:
        angle = rng.uniform(-math.pi, math.pi)
        row[:] = *rng.uniform(-0.8, 0.8, 2), math.cos(angle), math.sin(angle)
    wish = (float(rng.uniform(-1, 1)), float(rng.uniform(-1, 1)))
    u, v = best_velocity(lines, count, 0, 1.0, wish, np.zeros((count, 4)))
    assert math.hypot(u, v) < 1.0 + 1e-9
    worst = max(violation(row, u, v) for row in lines)
    samples = rng.uniform(-1, 1, (4000, 2))
    samples = samples[np.hypot(*samples.T) <= 1.0]
    beyond = np.array([[violation(row, *s) for row in lines] for s in samples[:400]]).max(axis=1)
    if worst > 1e-6:
        assert beyond.min() > worst - 1e-6
    else:
        away = np.hypot(*(samples[:400] - wish).T)[beyond <= 0.0]
        assert away.size == 0 or away.min() > math.hypot(u - wish[0], v - wish[1]) - 1e-6


def test_distances_are_those_of_the_nearest_point() -> None:
    rng = np.random.default_rng(2)
    points, field = rng.uniform(-3, 3, (40, 2)), DistanceField()
    field.fill(points, 0.3, -0.2)
    for x, y in rng.uniform(-2.5, 2.5, (200, 2)):
        exact = np.hypot(points[:, 0] - x, points[:, 1] - y).min()
        assert distance_at(field.values, field.corner, x, y) == pytest.approx(exact, abs=1.5 * CELL)
    assert distance_at(field.values, field.corner, 99.0, 0.0) > 1e5
    field.fill(np.empty((0, 2)), 0.0, 0.0)
    assert distance_at(field.values, field.corner, 0.0, 0.0) > 50.0


@pytest.mark.parametrize(("front", "back", "half"), [(0.6, 0.5, 0.35), (0.2, 0.2, 0.5)])
def test_discs_cover_the_outline(front: float, back: float, half: float) -> None:
    corners = np.array([[front, half], [-back, half], [-back, -half], [front, -half]])
    body = RobotBody(drive="differential", radius=1.0, footprint=corners, front=front, back=back,
                     half_width=half)  # fmt: skip
    discs = covering_discs(None, body)
    inside = np.random.default_rng(1).uniform((-back, -half), (front, half), (500, 2))
    gap = np.hypot(*(inside[:, None] - discs[None, :, :2]).T).T - discs[:, 2]
    assert gap.min(axis=1).max() <= 1e-9
    assert discs[:, 2].max() < 1.25 * min(half, 0.5 * (front + back))


def test_a_way_leads_around_a_wall() -> None:
    wall = np.column_stack([np.full(81, 2.0), np.linspace(-1.0, 3.0, 81)])
    finder = PathFinder(0.3)
    for t in (0.0, 0.5, 1.0):  # seen three times, it stands
        _, y = finder.waypoint(t, Pose(0.0, 0.0, 0.0), wall, (5.0, 0.0))
    assert y < -0.4  # the shorter side
    assert finder.waypoint(1.5, Pose(2.5, -1.4, 0.0), wall, (5.0, -1.4)) == (5.0, -1.4)
    assert is_blocked(wall, 0.0, 0.0, 5.0, 0.0, 0.3)
    assert not is_blocked(wall, 0.0, -1.5, 5.0, -1.5, 0.3)


LIMITS = RobotLimits(v_min=-0.2, v_max=0.6, w_max=1.5, a_max=0.8, alpha_max=1.5)


def test_a_robot_turns_before_it_drives_backwards() -> None:
    command = follow((-0.5, 0.01), 0.0, 0.0, LIMITS)
    assert command.v == 0.0
    assert command.w == LIMITS.w_max
    assert follow((0.5, 0.0), 0.0, 0.0, LIMITS) == (0.5, 0.0, 0.0)
    assert follow((0.0, 0.0), 0.0, 1.0, LIMITS) == (0.0, 0.0, 0.0)


def test_a_robot_that_goes_sideways_does() -> None:
    limits = RobotLimits(v_min=-0.2, v_max=0.6, w_max=1.5, a_max=0.8, alpha_max=1.5, vy_max=0.4)
    command = follow((0.0, 0.5), 0.0, 0.0, limits)
    assert command.vy == pytest.approx(0.4)
    assert abs(command.v) < 1e-9
    back = follow((-0.5, 0.0), 0.0, 0.0, limits)
    assert back.v == pytest.approx(-0.2)


def test_what_can_be_followed_shrinks_with_the_turn() -> None:
    straight = followable(0.6, 0.0, 0.0, 0.05)
    assert straight == (0.6, 0.0)
    speeds = [math.hypot(*followable(0.6 * math.cos(a), 0.6 * math.sin(a), 0.0, 0.05))
              for a in (0.2, 0.6, 1.2, 2.0)]  # fmt: skip
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[-1] == pytest.approx(0.1)


def test_openings_of_a_histogram() -> None:
    free = np.ones(72, np.bool_)
    assert openings(free, 0.7, 16) == [0.7]
    free[:] = False
    free[4:8] = True  # 20 to 40 degrees
    assert openings(free, 0.0, 16) == pytest.approx([math.radians(30)])
    free[4:40] = True  # 20 to 200 degrees: edges, and the goal within
    found = np.degrees(openings(free, math.radians(90), 16))
    assert sorted(found) == pytest.approx([60.0, 90.0, 160.0])
    assert openings(np.zeros(72, np.bool_), 0.0, 16) == []


def test_the_widest_gap() -> None:
    right, left = np.array([-0.5, 0.2]), np.array([-0.1, 0.6])
    assert widest_gap(right, left, 1.5) == pytest.approx((-1.5, -0.5))
    assert widest_gap(np.array([-2.0]), np.array([2.0]), 1.5) is None
