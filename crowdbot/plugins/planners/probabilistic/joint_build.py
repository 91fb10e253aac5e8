"""The joint density of a robot's way with those of user, planner and people; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel

#: Time between the points of a way at which densities are compared, s.
STEP = 0.25
#: Indices into the parameter vector.
HORIZON, AGREEABILITY, USER_SPREAD, ROBOT_SPREAD, PEOPLE_SPREAD, AVOIDANCE, SAFETY, FRONT = range(8)
PARAMETERS = 8


@kernel
def _advanced(
    x: float, y: float, yaw: float, v: float, w: float, vy: float
) -> tuple[float, float, float]:
    """Return the pose one step later on the arc of a command."""
    middle = yaw + 0.5 * w * STEP
    c, s = math.cos(middle), math.sin(middle)
    return x + (c * v - s * vy) * STEP, y + (s * v + c * vy) * STEP, yaw + w * STEP


@kernel
def _apart(
    one: tuple[float, float, float], other: tuple[float, float, float], front: float
) -> float:
    """Return the squared distance of the robot's front at two poses, m^2: turns count, too."""
    dx = one[0] - other[0] + front * (math.cos(one[2]) - math.cos(other[2]))
    dy = one[1] - other[1] + front * (math.sin(one[2]) - math.sin(other[2]))
    return dx * dx + dy * dy


@kernel
def _crowd(
    bodies: Array, robot: Array, x: float, y: float, yaw: float, t: float, p: Array
) -> float:
    """Return the log of the interaction of a pose with all bodies, marginal over their spread."""
    total, safe = 0.0, p[SAFETY] * p[SAFETY]
    c, s = math.cos(yaw), math.sin(yaw)
    for i in range(bodies.shape[0]):
        bx, by = bodies[i, 0] + t * bodies[i, 2], bodies[i, 1] + t * bodies[i, 3]
        gap = math.inf
        for k in range(robot.shape[0]):
            dx = bx - x - c * robot[k, 0] + s * robot[k, 1]
            dy = by - y - s * robot[k, 0] - c * robot[k, 1]
            gap = min(gap, math.sqrt(dx * dx + dy * dy) - robot[k, 2] - bodies[i, 4])
        gap = max(gap, 0.0)
        spread = 0.0 if bodies[i, 4] == 0.0 else p[PEOPLE_SPREAD] * t
        wide = safe + spread * spread
        if gap * gap < 16.0 * wide:
            touch = safe / wide * math.exp(-0.5 * gap * gap / wide)
            total += math.log(1.0 - p[AVOIDANCE] * touch)
    return total


@array_kernel
def log_densities(
    candidates: Array, user: Array, planner: Array, bodies: Array, robot: Array, p: Array
) -> Array:
    """Return the log of the density of each candidate's way, up to a constant; (C,).

    Args:
        candidates: (C, 3) commands v, w, vy; m/s, rad/s, m/s.
        user, planner: (3,) their commands, the means of their ways.
        bodies: (N, 5) x, y, vx, vy, radius in the base frame; of radius 0: they stand.
        robot: (K, 3) discs that hold the robot, m.
        p: parameters.
    """
    out = np.empty(candidates.shape[0])
    agree = p[AGREEABILITY] * p[AGREEABILITY]
    for k in range(candidates.shape[0]):
        f = h = r = (0.0, 0.0, 0.0)
        total, t = 0.0, 0.0
        while t < p[HORIZON] - 1e-9:
            f = _advanced(*f, candidates[k, 0], candidates[k, 1], candidates[k, 2])
            h = _advanced(*h, user[0], user[1], user[2])
            r = _advanced(*r, planner[0], planner[1], planner[2])
            t += STEP
            total -= 0.5 * _apart(f, h, p[FRONT]) / (agree + (p[USER_SPREAD] * t) ** 2)
            total -= 0.5 * _apart(f, r, p[FRONT]) / (p[ROBOT_SPREAD] * t) ** 2
            total += _crowd(bodies, robot, f[0], f[1], f[2], t, p)
        out[k] = total
    return out
