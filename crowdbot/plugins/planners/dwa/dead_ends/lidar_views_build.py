"""Decide from each lidar's position if a remembered point may still be there.

A robot's lidars sit at its corners, and one may look through a door while no lidar sees the wall
beside it. So occlusion is computed from each lidar, not from the robot's centre.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Mask, Pose, Reading, SensorInfo

#: A point is gone if a lidar sees this far behind it, m, also on both sides of it, rad, since some
#: beams always pass a body's outline.
_BEHIND, _BESIDE = 0.4, math.radians(6.0)


class LidarViews:
    """The planar lidars of a robot and the points in their views.

    Args:
        sensors: description of every sensor; other than level planar lidars are not used.
    """

    def __init__(self, sensors: Mapping[str, SensorInfo]) -> None:
        self._lidars = {
            name: (info.mount, info.angles)
            for name, info in sensors.items()
            if info.category == "lidar" and info.angles is not None and info.tilt == (0.0, 0.0)
        }

    def past(self, readings: Mapping[str, Reading], pose: Pose, points: Array) -> Mask:
        """Return a mask of the world points (N, 2) that some lidar sees far past.

        Args:
            readings: by sensor name; lidars without a reading are ignored.
            pose: the robot's pose.
            points: (N, 2) world frame, m.
        """
        out = np.zeros(len(points), dtype=np.bool_)
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        for name, ((x, y, _, yaw), angles) in self._lidars.items():
            if name not in readings or len(angles) < 2:
                continue
            dx = points[:, 0] - (pose.x + c * x - s * y)
            dy = points[:, 1] - (pose.y + s * x + c * y)
            bearing = np.arctan2(dy, dx) - pose.yaw - yaw - angles[0]
            beam = (bearing % (2.0 * math.pi)) / (angles[1] - angles[0])
            view = _shortest_around(readings[name].values, angles[1] - angles[0])
            within = beam <= len(angles) - 1
            nearest = np.where(within, np.rint(beam), 0).astype(np.int64)
            out |= within & (np.hypot(dx, dy) + _BEHIND < view[nearest])
        return out


def _shortest_around(ranges: Array, step: float) -> Array:
    """Return the shortest range within `_BESIDE` of each beam (R,), m.

    Beams are a step (rad) apart.
    """
    wide = math.ceil(_BESIDE / step)
    padded = np.pad(ranges, wide, mode="edge")
    shortest: Array = np.lib.stride_tricks.sliding_window_view(padded, 2 * wide + 1).min(axis=1)
    return shortest
