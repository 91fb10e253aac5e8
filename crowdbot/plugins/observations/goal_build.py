"""Goal and own motion of robots, as parts of observations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, RobotLimits
from crowdbot.plugin.for_learning import RobotInputs

#: Numbers of the part: distance, cosine and sine of the direction; v, w, vy.
SIZE = 6


def goal_and_motion(seen: RobotInputs, limits: RobotLimits, goal_range: float) -> Array:
    """Return (W, 6): distance to the goal from 0 to 1, its direction, and v, w, vy from -1 to 1."""
    away = seen.goal - seen.pose[:, :2]
    distance = np.hypot(away[:, 0], away[:, 1])
    bearing = np.arctan2(away[:, 1], away[:, 0]) - seen.pose[:, 2]
    fastest = np.array([max(limits.v_max, -limits.v_min), limits.w_max, limits.vy_max])
    found = np.zeros((len(away), SIZE))
    found[:, 0] = np.minimum(distance / goal_range, 1.0)
    found[:, 1], found[:, 2] = np.cos(bearing), np.sin(bearing)
    np.divide(seen.twist, fastest, out=found[:, 3:], where=fastest > 0.0)
    return found


def bounds(*parts: tuple[int, float, float]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return lower and upper bounds of parts, each of a number of values between two."""
    counts = [count for count, _, _ in parts]
    low = np.repeat(np.array([low for _, low, _ in parts], np.float32), counts)
    high = np.repeat(np.array([high for _, _, high in parts], np.float32), counts)
    return low, high
