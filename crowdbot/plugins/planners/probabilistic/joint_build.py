"""The joint density of a robot's way with those of user, planner and people; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel

#: Time between the points of a way at which densities are compared, s.
STEP = 0.25
#: Indices into the parameter vector.
(
    HORIZON,
    AGREEABILITY,
    USER_SPREAD,
    ROBOT_SPREAD,
    PEOPLE_SPREAD,
    AVOIDANCE,
    SAFETY,
    FRONT,
    A_MAX,
    ALPHA_MAX,
) = range(10)
PARAMETERS = 10


@kernel
def _advanced(
    x: float, y: float, yaw: float, v: float, w: float, vy: float
) -> tuple[float, float, float]:
    """Return the pose one step later on the arc of a command."""
    middle = yaw + 0.5 * w * STEP
    c, s = math.cos(middle), math.sin(middle)
    return x + (c * v - s * vy) * STEP, y + (s * v + c * vy) * STEP, yaw + w * STEP


@kernel
def _apart(one: Array, other: Array, front: float) -> float:
    """Return the squared distance of the robot's front at two poses, m^2: turns count, too."""
    dx = one[0] - other[0] + front * (math.cos(one[2]) - math.cos(other[2]))
    dy = one[1] - other[1] + front * (math.sin(one[2]) - math.sin(other[2]))
    return float(dx * dx + dy * dy)


@kernel
def _crowd(
    bodies: Array, robot: Array, x: float, y: float, yaw: float, t: float, p: Array
) -> float:
    """Return the log of the interaction of a pose with all bodies, marginal over their spread."""
    total, nearest, safe = 0.0, 0.0, p[SAFETY] * p[SAFETY]
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
            if bodies[i, 4] == 0.0:  # of a wall's many points the nearest counts
                nearest = max(nearest, touch)
            else:
                total += math.log(1.0 - p[AVOIDANCE] * touch)
    return total + math.log(1.0 - p[AVOIDANCE] * nearest)


@kernel
def _slewed(value: float, target: float, change: float) -> float:
    return min(max(target, value - change), value + change)


@array_kernel
def way(twist: Array, command: Array, p: Array) -> Array:
    """Return the poses (T, 3) of a robot that takes on a command as fast as it can.

    Args:
        twist: (3,) v, w, vy at present.
        command: (3,) the same of the command.
        p: parameters.
    """
    count = max(1, int(p[HORIZON] / STEP + 1e-9))
    out = np.empty((count, 3))
    v, w, vy = twist[0], twist[1], twist[2]
    x, y, yaw = 0.0, 0.0, 0.0
    for k in range(count):
        v = _slewed(v, command[0], p[A_MAX] * STEP)
        w = _slewed(w, command[1], p[ALPHA_MAX] * STEP)
        vy = _slewed(vy, command[2], p[A_MAX] * STEP)
        x, y, yaw = _advanced(x, y, yaw, v, w, vy)
        out[k, 0], out[k, 1], out[k, 2] = x, y, yaw
    return out


@array_kernel
def log_densities(
    candidates: Array,
    user: Array,
    planner: Array,
    bodies: Array,
    robot: Array,
    twist: Array,
    p: Array,
) -> Array:
    """Return the log of the density of each candidate's way, up to a constant; (C,).

    Args:
        candidates: (C, 3) commands v, w, vy; m/s, rad/s, m/s.
        user, planner: (3,) their commands, the means of their ways.
        bodies: (N, 5) x, y, vx, vy, radius in the base frame; of radius 0: they stand.
        robot: (K, 3) discs that hold the robot, m.
        twist: (3,) v, w, vy of the robot at present, from which all ways begin.
        p: parameters.
    """
    out = np.empty(candidates.shape[0])
    wanted, planned = way(twist, user, p), way(twist, planner, p)
    agree = p[AGREEABILITY] * p[AGREEABILITY]
    for k in range(candidates.shape[0]):
        total, own = 0.0, way(twist, candidates[k], p)
        for i in range(own.shape[0]):
            t = (i + 1) * STEP
            total -= 0.5 * _apart(own[i], wanted[i], p[FRONT]) / (agree + (p[USER_SPREAD] * t) ** 2)
            total -= 0.5 * _apart(own[i], planned[i], p[FRONT]) / (p[ROBOT_SPREAD] * t) ** 2
            total += _crowd(bodies, robot, own[i, 0], own[i, 1], own[i, 2], t, p)
        out[k] = total
    return out
