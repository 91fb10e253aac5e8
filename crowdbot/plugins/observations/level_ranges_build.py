"""Horizontal distances measured by range sensors, in layers of beams."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, SensorInfo

#: What a camera sees below this height over the base is the floor, m.
_FLOOR = 0.1


def level_ranges(info: SensorInfo, values: Array) -> Array:
    """Return horizontal ranges (W, L, B), m; inf for no return.

    Readings of a lidar, a sonar or an infrared sensor stay unchanged. A depth camera measures along
    its axis: its pixels are converted to distances over the floor, counter-clockwise, without those
    that hit the floor.

    Args:
        values: (W, ...) readings of one sensor.
    """
    if info.camera is None:
        return values[:, np.newaxis] if values.ndim == 2 else values
    camera, (column, row) = info.camera, info.camera.centre
    left = (column - np.arange(camera.width)) / camera.focal
    up = (row - np.arange(camera.height)) / camera.focal
    roll, pitch = info.tilt
    across = math.cos(roll) * left - math.sin(roll) * up[:, np.newaxis]
    rising = math.sin(roll) * left + math.cos(roll) * up[:, np.newaxis]
    ahead = math.cos(pitch) + math.sin(pitch) * rising
    rising = math.cos(pitch) * rising - math.sin(pitch)
    depth = np.where(values == 0.0, info.range_min, values)
    with np.errstate(invalid="ignore"):  # nothing in range, straight ahead
        over = depth * rising + info.mount[2] > _FLOOR
    far = np.where(over, depth * np.hypot(ahead, across), np.inf)
    return np.ascontiguousarray(far[:, :, ::-1])
