"""Simple initial plans on every side of people, for local improvement; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, RobotLimits, kernel
from crowdbot.plugins.planners.shared.braking_build import MotionState

#: Directions beside that of the goal, rad, and speeds as shares of the largest.
_ASIDE = (0.0, 0.4, -0.4, 0.9, -0.9, 1.4, -1.4, 0.0, 0.0)
_PACES = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.0)
#: Number of plans.
STARTS = len(_ASIDE)
_GAIN = 2.0


def starts(
    state: MotionState,
    waypoint: tuple[float, float],
    limits: RobotLimits,
    shape: tuple[int, ...],
    dt: float,
    top: float,
) -> Array:
    """Return plans (S, N, 2 or 3) that first turn aside and then towards a point, within limits.

    Args:
        state: x, y, yaw, v, w, vy of the robot.
        waypoint: point to drive to, m.
        limits: the robot's.
        shape: shape of one plan, (N, 2 or 3).
        dt: length of a stage, s.
        top: largest speed, m/s.
    """
    out = np.empty((STARTS, *shape))
    slew = (limits.a_max * dt, limits.alpha_max * dt, limits.w_max)
    _write(state, waypoint, slew, dt, top, out)
    return out


@kernel
def _write(
    state: MotionState,
    waypoint: tuple[float, float],
    slew: tuple[float, float, float],
    dt: float,
    top: float,
    out: Array,
) -> None:
    for n in range(out.shape[0]):
        x, y, yaw, v, w, vy = state
        stages, sideways = out.shape[1], out.shape[2] > 2
        for k in range(stages):
            off = math.atan2(waypoint[1] - y, waypoint[0] - x) - yaw
            off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
            turn = off + _ASIDE[n] * (1.0 - k / stages)
            wt = _GAIN * (off if sideways else turn)
            vt = _PACES[n] * top * (math.cos(turn) if sideways else max(0.0, math.cos(turn)))
            vyt = _PACES[n] * top * math.sin(turn) if sideways else 0.0
            v = min(max(vt, v - slew[0]), v + slew[0])
            vy = min(max(vyt, vy - slew[0]), vy + slew[0])
            w = min(max(min(max(wt, -slew[2]), slew[2]), w - slew[1]), w + slew[1])
            middle = yaw + 0.5 * dt * w
            x += dt * (v * math.cos(middle) - vy * math.sin(middle))
            y += dt * (v * math.sin(middle) + vy * math.cos(middle))
            yaw += dt * w
            out[n, k, 0], out[n, k, 1] = v, w
            if sideways:
                out[n, k, 2] = vy


def moved_on(plan: Array, stages: float) -> Array:
    """Return a plan shifted by some stages, with linear interpolation; the last one is repeated."""
    last = len(plan) - 1
    at = np.clip(np.arange(len(plan)) + max(0.0, stages), 0, last)
    low = np.minimum(at.astype(int), max(last - 1, 0))
    part = (at - low)[:, None]
    return np.asarray((1.0 - part) * plan[low] + part * plan[np.minimum(low + 1, last)])
