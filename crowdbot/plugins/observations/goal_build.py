"""Goal and own motion of robots, as parts of observations."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, InputError, RobotLimits, SensorInfo, kernel
from crowdbot.plugin.for_learning import LearningContext, RobotInputs, sensor_named

#: Numbers of the part: distance, cosine and sine of the direction; v, w, vy.
SIZE = 6


def goal_and_motion(seen: RobotInputs, limits: RobotLimits, goal_range: float) -> Array:
    """Return (W, 6): distance to the goal from 0 to 1, its direction, and v, w, vy from -1 to 1."""
    found = np.empty((len(seen.pose), SIZE))
    fastest = max(limits.v_max, -limits.v_min), limits.w_max, limits.vy_max
    _write(seen.pose, seen.twist, seen.goal, fastest, goal_range, found)
    return found


@kernel
def _write(
    pose: Array, twist: Array, goal: Array, fastest: tuple[float, float, float], goal_range: float,
    found: Array,
) -> None:  # fmt: skip
    """Write the result of `goal_and_motion`; ``fastest``: largest v, w, vy, 0 if not possible."""
    for w in range(pose.shape[0]):
        dx, dy = goal[w, 0] - pose[w, 0], goal[w, 1] - pose[w, 1]
        bearing = math.atan2(dy, dx) - pose[w, 2]
        found[w, 0] = min(math.hypot(dx, dy) / goal_range, 1.0)
        found[w, 1], found[w, 2] = math.cos(bearing), math.sin(bearing)
        for k in range(3):
            found[w, 3 + k] = twist[w, k] / fastest[k] if fastest[k] > 0.0 else 0.0


def lidar_named(context: LearningContext, name: str) -> tuple[str, SensorInfo]:
    """Return name and description of the first lidar of a name or category.

    Raises:
        InputError: there is none, or it is another sensor.
    """
    own = sensor_named(context.sensors, name)
    info = context.sensors[own]
    if info.category not in ("lidar", "lidar3d"):
        raise InputError(f"sensor '{own}' is of category '{info.category}'; a lidar is wanted")
    return own, info


def bounds(*parts: tuple[int, float, float]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return lower and upper bounds of an observation; each part is (length, low, high)."""
    counts = [count for count, _, _ in parts]
    low = np.repeat(np.array([low for _, low, _ in parts], np.float32), counts)
    high = np.repeat(np.array([high for _, _, high in parts], np.float32), counts)
    return low, high
