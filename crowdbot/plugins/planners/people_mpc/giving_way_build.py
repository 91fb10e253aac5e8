"""Predicted people give way to the robot's plan, as the crowd's response `giving_way`; compiled."""

from __future__ import annotations

import math

from crowdbot.plugin import Array, kernel

#: Time in which people take up the velocity that they want, s.
_RELAXATION = 0.3
#: People look ahead so far, s, and expect to be clear at the earliest in this time, s.
_HORIZON, _SOONEST = 4.0, 0.25
#: Clearance that they want, m, and their largest accelerations sideways and in all, m/s^2.
_CLEARANCE, _LATERAL, _MOST = 0.1, 1.2, 3.0
#: Square of the relative speed below which nothing happens, m^2/s^2.
_STILL = 1e-6


@kernel
def give_way(
    people: Array,
    first: Array,
    yields: Array,
    predicted: Array,
    n: int,
    robot: tuple[float, float, float, float, float],
    dt: float,
) -> None:
    """Move predicted people by one step, in place; those who notice the robot give way.

    They shift to the shorter side until they are clear, and go on with their wanted velocity.
    Others move as predicted.

    Args:
        people: (N, 5) x, y, vx, vy, radius; m, m/s.
        first: (N, 5) the same at the beginning.
        yields: (N,) time to contact from which each gives way, s, 0: never.
        predicted: (T, N, 2) where they would be after each step if there were no robot, m.
        n: number of this step, from 0.
        robot: x, y, vx, vy, m and m/s, and its extent, m.
        dt: length of the step, s.
    """
    for i in range(people.shape[0]):
        x, y = predicted[n, i, 0], predicted[n, i, 1]
        bx, by = first[i, 0], first[i, 1]
        if n > 0:
            bx, by = predicted[n - 1, i, 0], predicted[n - 1, i, 1]
        wx, wy = (x - bx) / dt, (y - by) / dt
        if yields[i] == 0.0:
            people[i, 0], people[i, 1] = x, y
            people[i, 2], people[i, 3] = wx, wy
            continue
        ax, ay = (wx - people[i, 2]) / _RELAXATION, (wy - people[i, 3]) / _RELAXATION
        ex, ey = _sidestep(people, i, yields[i], robot)
        if ex != 0.0 or ey != 0.0:  # what is against it is dropped
            against = min(0.0, ax * ex + ay * ey) / (ex * ex + ey * ey)
            ax += ex - against * ex
            ay += ey - against * ey
        size = math.sqrt(ax * ax + ay * ay)
        if size > _MOST:
            ax, ay = ax * _MOST / size, ay * _MOST / size
        people[i, 0] += (people[i, 2] + 0.5 * ax * dt) * dt
        people[i, 1] += (people[i, 3] + 0.5 * ay * dt) * dt
        people[i, 2] += ax * dt
        people[i, 3] += ay * dt


@kernel
def _sidestep(
    people: Array, i: int, notice: float, robot: tuple[float, float, float, float, float]
) -> tuple[float, float]:
    """Return the acceleration by which person i passes a robot that keeps its velocity, m/s^2."""
    x, y, vx, vy, extent = robot
    dx, dy = x - people[i, 0], y - people[i, 1]
    if dx * people[i, 2] + dy * people[i, 3] < 0.0:
        return 0.0, 0.0  # it comes from behind, and is not seen
    wx, wy = people[i, 2] - vx, people[i, 3] - vy
    along, across = dx * wx + dy * wy, wx * dy - wy * dx
    square = wx * wx + wy * wy
    if along <= 0.0 or square < _STILL or along >= min(_HORIZON, notice) * square:
        return 0.0, 0.0
    speed = math.sqrt(square)
    shift = people[i, 4] + extent + _CLEARANCE - abs(across) / speed
    if shift <= 0.0:
        return 0.0, 0.0
    time = max(along / square, _SOONEST)
    aside = min(2.0 * shift / (time * time), _LATERAL)
    left = -aside if across > 0.0 else aside
    return -left * wy / speed, left * wx / speed
