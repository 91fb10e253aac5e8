"""What each lidar sees past: whether something that is remembered may still be there.

A robot's lidars sit at its corners, and one of them may look through a door while the wall beside
it is seen by none: what hides what is decided from where the lidar is, not from the middle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Mask, Pose, Reading, SensorInfo

#: A point is gone if a lidar sees this far behind it, m, and so it does on both sides of it, rad:
#: past the outline of a body some beams always go.
_BEHIND, _BESIDE = 0.4, math.radians(6.0)


class LidarViews:
    """The planar lidars of a robot and what lies within their views.

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
        """(N,) which points (N, 2) of the world some lidar sees far past.

        Args:
            readings: by sensor name; a lidar that has not read yet is left out.
            pose: of the robot.
            points: m.
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
    """(R,) the shortest range within `_BESIDE` of each beam, m; beams are a step (rad) apart."""
    wide = math.ceil(_BESIDE / step)
    padded = np.pad(ranges, wide, mode="edge")
    shortest: Array = np.lib.stride_tricks.sliding_window_view(padded, 2 * wide + 1).min(axis=1)
    return shortest
