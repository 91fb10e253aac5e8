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
    c, s = np.cos(yaw), np.sin(yaw)
    path = np.empty((len(yaw), 2))
    np.cumsum(v * c - vy * s, out=path[:, 0])
    np.cumsum(v * s + vy * c, out=path[:, 1])
    path *= step
    return path
