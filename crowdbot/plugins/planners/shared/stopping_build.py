"""Least gap on the arc of a command until the robot has stopped; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, kernel

#: Time step along an arc, s.
_STEP = 0.1


@kernel
def arc_gap_moving(
    bodies: Array, robot: Array, v: float, w: float, time: float, brake: float
) -> float:
    """Return the least gap on the arc of a command, then braking, m; inf without obstacles.

    Args:
        bodies: (N, 5) x, y, vx, vy, radius of what is around, base frame; they go on as they do.
        robot: (K, 3) discs that hold the robot, m.
        v, w: of the command, m/s, rad/s.
        time: for which it is driven, s.
        brake: deceleration afterwards, m/s^2; infinite: the arc ends there.
    """
    best, x, y, yaw, t = math.inf, 0.0, 0.0, 0.0, 0.0
    share, speed = 1.0, abs(v)
    while True:
        c, s = math.cos(yaw), math.sin(yaw)
        for k in range(robot.shape[0]):
            px = x + c * robot[k, 0] - s * robot[k, 1]
            py = y + s * robot[k, 0] + c * robot[k, 1]
            for i in range(bodies.shape[0]):
                dx = bodies[i, 0] + t * bodies[i, 2] - px
                dy = bodies[i, 1] + t * bodies[i, 3] - py
                best = min(best, math.sqrt(dx * dx + dy * dy) - robot[k, 2] - bodies[i, 4])
        if t >= time:
            share = 0.0 if speed == 0.0 else 1.0 - brake * (t - time) / speed
            if not share > 0.0:  # or NaN, where an infinite deceleration begins
                return best
        x += share * v * _STEP * math.cos(yaw + 0.5 * share * w * _STEP)
        y += share * v * _STEP * math.sin(yaw + 0.5 * share * w * _STEP)
        yaw += share * w * _STEP
        t += _STEP


def compile_stopping() -> None:
    """Compile kernels that are not compiled yet."""
    arc_gap_moving(np.ones((1, 5)), np.ones((1, 3)), 0.1, 0.0, 0.1, 1.0)
