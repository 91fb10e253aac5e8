"""Two outlines against each other: geometry against shapely, motion against an ODE."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from shapely.affinity import rotate, translate  # type: ignore[import-untyped]
from shapely.geometry import LineString, Point, Polygon  # type: ignore[import-untyped]

from crowdbot.core.sim.contacts.outline_overlap import mark_within_reach, overlap_of_robots
from crowdbot.core.sim.contacts.robot_contacts import DISSIPATION, SHELL, touch
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array

BOX = np.array([[0.55, 0.35], [-0.55, 0.35], [-0.55, -0.35], [0.55, -0.35]])
SEGMENT = np.array([[-0.2, 0.0], [0.2, 0.0]])
#: Outlines before rounding, and their radii.
SHAPES = [(np.zeros((0, 2)), 0.2), (SEGMENT, 0.15), (BOX, 0.0)]

# Compiled before any example has a deadline.
overlap_of_robots(np.zeros(8), BOX, np.zeros(8), BOX)
mark_within_reach(np.zeros((2, 8)), np.zeros(2), np.zeros((2, 2), dtype=np.bool_))

poses = st.tuples(st.floats(-1.6, 1.6), st.floats(-1.6, 1.6), st.floats(-3.1, 3.1))
shapes = st.sampled_from(range(len(SHAPES)))


def row(pose: tuple[float, float, float], radius: float, v: tuple[float, ...] = ()) -> Array:
    """A robot's row: x, y, heading; vx, vy, yaw rate."""
    vx, vy, w = v or (0.0, 0.0, 0.0)
    return np.array([pose[0], pose[1], vx, vy, radius, radius, pose[2], w])


def core(shape: int, pose: tuple[float, float, float]) -> Point | LineString | Polygon:
    """The outline before rounding, placed."""
    corners = SHAPES[shape][0]
    made = [Point(0, 0), LineString(SEGMENT), Polygon(BOX)][shape]
    del corners
    turned = rotate(made, pose[2], origin=(0, 0), use_radians=True)
    return translate(turned, pose[0], pose[1])


@given(shapes, shapes, poses, poses)
def test_robots_touch_where_shapely_says_so(
    a: int, b: int, here: tuple[float, float, float], there: tuple[float, float, float]
) -> None:
    one, other = core(a, here), core(b, there)
    reach = SHAPES[a][1] + SHAPES[b][1]
    gap = one.distance(other)
    first, second = row(here, SHAPES[a][1]), row(there, SHAPES[b][1])
    depth, nx, ny, *_ = overlap_of_robots(first, SHAPES[a][0], second, SHAPES[b][0])
    back, mx, my, *_ = overlap_of_robots(second, SHAPES[b][0], first, SHAPES[a][0])
    assert depth == pytest.approx(back, abs=1e-12)
    if gap > 1e-9:  # no deeper than their rounding
        assert depth == pytest.approx(max(0.0, reach - gap), abs=1e-9)
    if depth > 0.0:
        assert math.hypot(nx, ny) == pytest.approx(1.0)
        assert (nx, ny) == pytest.approx((-mx, -my), abs=1e-9) or gap < 1e-9


@given(st.lists(st.tuples(shapes, poses), max_size=6))
def test_whoever_touches_is_within_reach(
    robots: list[tuple[int, tuple[float, float, float]]],
) -> None:
    """No pair that overlaps is left out, and none that cannot is looked at."""
    rows = np.reshape([row(pose, SHAPES[k][1]) for k, pose in robots], (-1, 8))
    reach = np.array([np.hypot(*SHAPES[k][0].T).max(initial=0.0) + SHAPES[k][1] for k, _ in robots])
    marks = np.zeros((len(rows), len(rows)), dtype=np.bool_)
    count = mark_within_reach(rows, reach, marks)
    assert count == marks.sum()
    for i, j in combinations(range(len(robots)), 2):
        a, b = SHAPES[robots[i][0]][0], SHAPES[robots[j][0]][0]
        if overlap_of_robots(rows[i], a, rows[j], b)[0] > 0.0:
            assert marks[i, j]
        apart = math.dist(rows[i, :2], rows[j, :2])
        assert marks[i, j] == (apart <= reach[i] + reach[j]) or apart == pytest.approx(
            reach[i] + reach[j]
        )


@given(poses, poses, st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_what_one_feels_the_other_feels(
    here: tuple[float, float, float],
    there: tuple[float, float, float],
    v: tuple[float, float, float],
) -> None:
    one, other = row(here, 0.0, v), row(there, 0.0)
    found = touch(one, BOX, other, BOX, SHELL)
    if found is None:
        return
    assert found.force >= 0.0
    again = touch(other, BOX, one, BOX, SHELL)
    assert again is not None
    assert again.at == pytest.approx(found.at, abs=1e-9)
    assert again.depth == pytest.approx(found.depth, abs=1e-12)


@pytest.mark.parametrize(("offset", "mass"), [(0.0, 6.3), (0.1, 6.3), (0.0, 28.0)])
def test_discs_that_meet_exchange_what_the_equation_says(offset: float, mass: float) -> None:
    """Head-on and glancing: Hunt and Crossley's equation, solved by scipy."""
    r, speed, other_mass = 0.178, 0.65, 6.3
    start = np.array([-2 * r - 0.01, offset, speed, 0.0, 0.0, 0.0, -speed, 0.0])

    def acceleration(t: float, s: Array) -> Array:
        del t
        away = s[4:6] - s[0:2]
        distance = float(np.hypot(*away))
        n = away / distance
        depth = 2 * r - distance
        closing = -float((s[6:8] - s[2:4]) @ n)
        force = max(0.0, SHELL * depth * (1.0 + DISSIPATION * closing)) if depth > 0 else 0.0
        return np.concatenate([s[2:4], -force / mass * n, s[6:8], force / other_mass * n])

    end = 0.3
    solved = solve_ivp(acceleration, (0.0, end), start, rtol=1e-9, atol=1e-12, max_step=1e-3)
    wanted = other_mass * float(np.hypot(*(solved.y[6:8, -1] - start[6:8])))

    step, x = TICK / 8, start.copy()
    impulse, momentum = 0.0, mass * x[2:4] + other_mass * x[6:8]
    for _ in range(round(end / step)):
        a = np.array([x[0], x[1], x[2], x[3], r, r, 0.0, 0.0])
        b = np.array([x[4], x[5], x[6], x[7], r, r, 0.0, 0.0])
        found = touch(a, np.zeros((0, 2)), b, np.zeros((0, 2)), SHELL)
        if found is not None:
            push = found.force * step * np.array(found.normal)
            x[2:4] -= push / mass
            x[6:8] += push / other_mass
            impulse += found.force * step
        x[0:2] += x[2:4] * step
        x[4:6] += x[6:8] * step
    assert impulse == pytest.approx(wanted, rel=0.01)
    assert np.abs(mass * x[2:4] + other_mass * x[6:8] - momentum).max() < 1e-9
