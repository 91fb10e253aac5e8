"""Rule that a robot must be able to brake before it touches anything; compiled.

People keep their velocity meanwhile. A person who walks into the standing robot does not count
against it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.plugin import Array, kernel

#: Time step while braking is checked, s.
_FINE = 0.1
#: What is already too near may be passed but not approached, m.
_SLACK = 1e-3
#: State of a robot: x, y, yaw, v, w, vy; m, rad, m/s, rad/s, m/s.
MotionState = tuple[float, float, float, float, float, float]


class AroundRobot(NamedTuple):
    """People and static obstacles around a robot.

    Attributes:
        people: (N, 5) x, y, vx, vy, radius; m, m/s.
        points: (P, 2) what stands, m.
        robot: (K, 3) discs that hold the robot, in its frame, m.
    """

    people: Array
    points: Array
    robot: Array


@kernel
def gap_at(world: AroundRobot, x: float, y: float, yaw: float, t: float) -> float:
    """Return the least gap to people after ``t`` seconds and to static obstacles, m."""
    best = math.inf
    c, s = math.cos(yaw), math.sin(yaw)
    for d in range(world.robot.shape[0]):
        ox, oy, r = world.robot[d, 0], world.robot[d, 1], world.robot[d, 2]
        px, py = x + c * ox - s * oy, y + s * ox + c * oy
        for i in range(world.people.shape[0]):
            dx = world.people[i, 0] + t * world.people[i, 2] - px
            dy = world.people[i, 1] + t * world.people[i, 3] - py
            best = min(best, math.sqrt(dx * dx + dy * dy) - r - world.people[i, 4])
        for i in range(world.points.shape[0]):
            dx, dy = world.points[i, 0] - px, world.points[i, 1] - py
            best = min(best, math.sqrt(dx * dx + dy * dy) - r)
    return best


@kernel
def can_brake(
    world: AroundRobot,
    state: MotionState,
    command: tuple[float, float, float],
    slew: tuple[float, float],
    times: tuple[float, float],
) -> bool:
    """Return True if the robot touches nothing if it accelerates to a command and then brakes.

    Args:
        state: x, y, yaw, v, w, vy of the robot.
        command: v, w, vy.
        slew: a_max, alpha_max.
        times: for which the command holds, s; clearance that must remain, m.
    """
    x, y, yaw, v, w, vy = state
    held, touch = times
    need = min(touch, gap_at(world, x, y, yaw, 0.0) - _SLACK)
    t = 0.0
    while t < held or abs(v) + abs(vy) > 1e-6 or abs(w) > 1e-6:
        target = command if t < held - 1e-9 else (0.0, 0.0, 0.0)
        dv, dvy = target[0] - v, target[2] - vy
        most, change = slew[0] * _FINE, math.sqrt(dv * dv + dvy * dvy)
        share = min(1.0, most / max(change, 1e-12))
        v, vy = v + share * dv, vy + share * dvy
        w += min(max(target[1] - w, -slew[1] * _FINE), slew[1] * _FINE)
        yaw += w * _FINE
        c, s = math.cos(yaw), math.sin(yaw)
        x += (v * c - vy * s) * _FINE
        y += (v * s + vy * c) * _FINE
        t += _FINE
        gap = gap_at(world, x, y, yaw, t)
        if gap < need:
            return False
        need = min(touch, max(need, gap - _SLACK))
    return True
