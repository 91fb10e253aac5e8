"""Planar lidar: a fan of rays from one point, with Gaussian noise on hits.

A beam reads the distance to the nearest hit, inf if there is none within ``range_max``. A hit
nearer than ``range_min`` reads ``range_min``: inf would tell a planner that the way is free while
something touches the lidar.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pose, SensorInfo
from crowdbot.core.sensing.columns import Grid
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec

Array = NDArray[np.float64]

#: Height of base_link above the floor (m) where the scene does not say it: the Kobuki's.
BASE_HEIGHT = 0.0102


class Lidar2d:
    """All beams are taken at one instant, level whatever the robot's tilt."""

    def __init__(self, spec: Lidar2dSpec) -> None:
        self._spec = spec
        count = max(1, round((spec.angle_max - spec.angle_min) / spec.angle_step))
        angles: Array = spec.angle_min + spec.angle_step * np.arange(count, dtype=np.float64)
        angles.setflags(write=False)
        mount = spec.mount
        self._info = SensorInfo(
            category="lidar",
            frame="lidar",
            mount=(mount.x, mount.y, mount.z, mount.yaw),
            rate=spec.rate,
            shape=(count,),
            ros_type="sensor_msgs/msg/LaserScan",
            angles=angles,
            range_min=spec.range_min,
            range_max=spec.range_max,
        )
        self._grid = Grid(angles, [0.0])

    def info(self) -> SensorInfo:
        """Constant description; ``angles`` are in the sensor frame."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Ranges (R,) in m, inf for no return."""
        del t
        spec = self._spec
        at, yaw = self._place(scene, pose)
        (distance,), _, _ = scene.cast_grid(self._grid, at, yaw, spec.range_max, details=False)
        # Drawn for every beam, so that one beam's noise does not depend on what the others hit.
        noise = spec.noise * rng.standard_normal(len(distance))
        _measure(distance, noise, spec.range_min, spec.range_max)
        return distance

    def _place(self, scene: Scene, pose: Pose) -> tuple[tuple[float, float, float], float]:
        """Position and heading in the world frame, m and rad."""
        mount = self._spec.mount
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        base = BASE_HEIGHT if scene.robot is None else scene.robot.z
        x, y = pose.x + c * mount.x - s * mount.y, pose.y + s * mount.x + c * mount.y
        return (x, y, base + mount.z), pose.yaw + mount.yaw


@njit(cache=True, error_model="numpy")
def _measure(distance: Array, noise: Array, shortest: float, longest: float) -> None:
    """Add the noise to the distances of hits, in place."""
    for k in range(len(distance)):
        if distance[k] < math.inf:
            distance[k] = min(max(distance[k] + noise[k], shortest), longest)


def build(spec: Lidar2dSpec) -> Lidar2d:
    """A lidar from its spec."""
    return Lidar2d(spec)
