"""Points that ultrasound, infrared sensors and depth cameras see but no lidar does.

A planar lidar sees one height only. Cones of ultrasound reach kerbs, and a depth camera sees gates
that hang above the lidar's plane.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Observation, Pinhole, SensorInfo, rotation
from crowdbot.plugins.planners.shared.points_build import apart

#: Points on the arc of a cone's hit.
_ARC = 5
#: A lidar point in the cone explains a range up to this much longer or shorter, and what a camera
#: sees so near to it, m.
_SAME = 0.25
#: So does one this far beside the cone: who walks past its edge was seen a moment earlier, rad.
_BESIDE = 0.15
#: Echoes farther away than this are left out: their arc is too wide to say where, m.
_FARTHEST = 1.5
#: Heights above the floor of what a depth camera shows as an obstacle, from and to, m.
_LOW, _HIGH = 0.06, 0.5
#: A camera's images are thinned to at most this number of columns and rows.
_COLUMNS, _ROWS = 64, 48


class NearPoints:
    """Converts the readings of near sensors to points in the base frame.

    Args:
        sensors: description of every sensor that the planner gets.
    """

    def __init__(self, sensors: Mapping[str, SensorInfo]) -> None:
        self._cones = {
            n: (s.mount, _edges(s), s.range_min)
            for n, s in sensors.items()
            if s.category in ("ultrasound", "infrared") and s.angles is not None
        }
        self._cameras = {n: _Camera(s, s.camera) for n, s in sensors.items() if s.camera}

    def __len__(self) -> int:
        """Return the number of near sensors."""
        return len(self._cones) + len(self._cameras)

    def __call__(self, obs: Observation, lidar: Array) -> Array:
        """Return points that no lidar sees, (K, 2), base frame, m.

        Args:
            obs: of this step; sensors without a reading are left out.
            lidar: (P, 2) points of all lidars, base frame, m.
        """
        found = [np.empty((0, 2))]
        for name, (mount, edges, least) in self._cones.items():
            if name in obs.readings:
                reach = float(obs.readings[name].values[0])
                if least < reach < _FARTHEST:
                    found.append(_arc(mount, edges, reach, lidar))
        for name, camera in self._cameras.items():
            if name in obs.readings:
                seen = camera.points(obs.readings[name].values)
                found.append(seen[apart(seen, lidar, _SAME)])
        return np.concatenate(found)


def _edges(info: SensorInfo) -> tuple[float, float]:
    assert info.angles is not None  # by the caller
    return float(info.angles[0]), float(info.angles[-1])


def _arc(
    mount: tuple[float, float, float, float], edges: tuple[float, float], reach: float, lidar: Array
) -> Array:
    """Return points on the arc of an echo, none if a lidar sees what echoes."""
    x, y, _, yaw = mount
    dx, dy = lidar[:, 0] - x, lidar[:, 1] - y
    off = (np.arctan2(dy, dx) - yaw + math.pi) % (2.0 * math.pi) - math.pi
    within = (off >= edges[0] - _BESIDE) & (off <= edges[1] + _BESIDE)
    if np.any(np.abs(np.hypot(dx[within], dy[within]) - reach) < _SAME):
        return np.empty((0, 2))
    angle = yaw + 0.5 * np.linspace(*edges, _ARC)  # objects seldom stand at the very edge
    return np.column_stack([x + reach * np.cos(angle), y + reach * np.sin(angle)])


class _Camera:
    """The rays of a depth camera, thinned, and their base frame."""

    def __init__(self, info: SensorInfo, pinhole: Pinhole) -> None:
        rows = np.linspace(0, pinhole.height - 1, min(_ROWS, pinhole.height)).astype(int)
        columns = np.linspace(0, pinhole.width - 1, min(_COLUMNS, pinhole.width)).astype(int)
        self._pixels = np.ix_(rows, columns)
        u, v = pinhole.centre
        left = (u - columns)[None, :] / pinhole.focal + np.zeros((len(rows), 1))
        up = (v - rows)[:, None] / pinhole.focal + np.zeros((1, len(columns)))
        rays = np.stack([np.ones_like(left), left, up], axis=-1)
        x, y, z, yaw = info.mount
        self._rays, self._at = rays @ rotation(*info.tilt, yaw).T, (x, y, z)
        self._least, self._most = info.range_min, info.range_max

    def points(self, depth: Array) -> Array:
        """Return the nearest point of each column between floor and head, (K, 2)."""
        ahead = np.asarray(depth, float)[self._pixels]
        at = self._rays * np.where(np.isfinite(ahead), ahead, 0.0)[..., None] + self._at
        high = (at[..., 2] > _LOW) & (at[..., 2] < _HIGH)
        seen = high & (ahead >= self._least) & (ahead < min(self._most, 6.0))
        away = np.where(seen, np.hypot(at[..., 0], at[..., 1]), math.inf)
        nearest = np.argmin(away, axis=0)
        columns = np.arange(away.shape[1])
        kept = np.isfinite(away[nearest, columns])
        return np.asarray(at[nearest, columns, :2][kept])
