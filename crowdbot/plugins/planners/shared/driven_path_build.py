"""The path of a sequence of velocities, for drawings."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array


def driven(velocities: Array, step: float) -> Array:
    """Return the positions (T, 2) after each velocity, in the frame of the first one, m.

    Args:
        velocities: (T, 3) v, w, vy; m/s, rad/s, m/s.
        step: time of each, s.
    """
    v, w, vy = velocities.T
    yaw = np.cumsum(w) * step
    x = np.cumsum(v * np.cos(yaw) - vy * np.sin(yaw)) * step
    y = np.cumsum(v * np.sin(yaw) + vy * np.cos(yaw)) * step
    return np.column_stack([x, y])
