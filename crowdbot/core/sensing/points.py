"""Lidar points around the robot, for planners."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.core.geometry.rotation import rotation
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.immutable import immutable
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import Reading, SensorInfo

#: Points of a tilted lidar below this height over base_link count as floor, m.
CLEARANCE = 0.05


class LidarPoints:
    """Converts the scans of all of a robot's lidars to points in the base frame.

    Args:
        sensors: description of every sensor the planner sees; only planar lidars are used.
    """

    def __init__(self, sensors: Mapping[str, SensorInfo]) -> None:
        self._beams: dict[str, tuple[float, float, Array, Array]] = {}
        for name, info in sensors.items():
            if info.category == "lidar" and info.angles is not None and info.angles.ndim == 1:
                x, y, _, yaw = map(float, info.mount)
                if any(info.tilt):
                    rays, longest = _tilted(info)
                else:
                    angle = info.angles + yaw
                    rays = np.column_stack([np.cos(angle), np.sin(angle)])
                    longest = np.full(len(rays), math.inf)
                self._beams[name] = x, y, np.ascontiguousarray(rays), longest
        self._most = sum(len(longest) for _, _, _, longest in self._beams.values())
        # Compile kernels that are not compiled yet, for read-only readings as planners get them.
        nothing = {n: Reading(0.0, immutable(b[3])) for n, b in self._beams.items()}
        self(nothing, 0.0, (0.0, 0.0))

    def __len__(self) -> int:
        """Return the number of lidars."""
        return len(self._beams)

    def __call__(
        self, readings: Mapping[str, Reading], t: float, twist: tuple[float, float], vy: float = 0.0
    ) -> Array:
        """Return the points of all hits.

        A scan that is older than ``t`` is moved by the robot's own motion since.

        Args:
            readings: by sensor name; lidars without a reading are ignored.
            t: current time, s.
            twist: the robot's v (m/s) and w (rad/s).
            vy: its speed to the left, m/s.

        Returns:
            (P, 2) x forward, y left of base_link, m; new.
        """
        out, count = np.empty((self._most, 2)), 0
        for name, (x, y, rays, longest) in self._beams.items():
            if name in readings:
                stamp, ranges, _ = readings[name]
                if ranges.shape != longest.shape:
                    raise ValueError(
                        f"{name}: a reading of shape {ranges.shape}; its lidar has "
                        f"{len(longest)} beams, so {longest.shape} is wanted"
                    )
                first, count = count, _add_points(ranges, longest, rays, x, y, out, count)
                if t > stamp:
                    out[first:count] = _moved(out[first:count], t - stamp, twist, vy)
        return out[:count]


@kernel
def _add_points(
    ranges: Array, longest: Array, rays: Array, x: float, y: float, out: Array, count: int
) -> int:
    """Append the hits of a lidar at (x, y) to ``count`` points in ``out``.

    Returns:
        the new number of points.
    """
    for k in range(ranges.shape[0]):
        if -math.inf < ranges[k] < longest[k]:
            out[count, 0] = rays[k, 0] * ranges[k] + x
            out[count, 1] = rays[k, 1] * ranges[k] + y
            count += 1
    return count


def _tilted(info: SensorInfo) -> tuple[Array, Array]:
    """Return beams of a tilted lidar from above (R, 2), and their distance to the floor, m.

    Readings from `CLEARANCE` above the floor on are the floor, not obstacles. base_link is assumed
    to lie on the floor; if it is higher, less of the floor is removed.
    """
    assert info.angles is not None  # by __init__
    fan = np.column_stack([np.cos(info.angles), np.sin(info.angles), np.zeros_like(info.angles)])
    rays = fan @ rotation(*info.tilt, info.mount[3]).T
    room, down = info.mount[2] - CLEARANCE, -rays[:, 2]
    longest = np.full(len(rays), math.inf)
    if room > 0.0:  # otherwise the floor is unknown
        np.divide(room, down, out=longest, where=down > 0.0)
    return rays[:, :2], longest


def _moved(points: Array, age: float, twist: tuple[float, float], vy: float) -> Array:
    """Return points seen ``age`` seconds ago, in the frame of a robot that has moved since."""
    v, w = twist
    if v == 0.0 and w == 0.0 and vy == 0.0:
        return points
    turn = w * age
    half, full = (math.cos(turn / 2.0), math.sin(turn / 2.0)), (math.cos(turn), math.sin(turn))
    x, y = v * age * half[0], v * age * half[1]
    if vy:
        x, y = x - vy * age * half[1], y + vy * age * half[0]
    c, s = full
    moved: Array = (points - (x, y)) @ np.array([[c, -s], [s, c]])
    return moved
