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
        self._cos, self._sin = np.cos(angles), np.sin(angles)

    def info(self) -> SensorInfo:
        """Constant description; ``angles`` are in the sensor frame."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Ranges (R,) in m, inf for no return."""
        del t
        spec = self._spec
        distance, _, _ = scene.cast(*self._rays(scene, pose), spec.range_max)
        # Drawn for every beam, so that one beam's noise does not depend on what the others hit.
        noise = spec.noise * rng.standard_normal(len(distance))
        _measure(distance, noise, spec.range_min, spec.range_max)
        return distance

    def _rays(self, scene: Scene, pose: Pose) -> tuple[Array, Array]:
        """Origins and directions (R, 3) in the world frame."""
        mount = self._spec.mount
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        base = BASE_HEIGHT if scene.robot is None else scene.robot.z
        origins, directions = np.empty((len(self._cos), 3)), np.empty((len(self._cos), 3))
        x, y = pose.x + c * mount.x - s * mount.y, pose.y + s * mount.x + c * mount.y
        c, s = math.cos(pose.yaw + mount.yaw), math.sin(pose.yaw + mount.yaw)
        _aim(x, y, base + mount.z, c, s, self._cos, self._sin, origins, directions)
        return origins, directions


@njit(cache=True, error_model="numpy")
def _aim(
    x: float,
    y: float,
    z: float,
    c: float,
    s: float,
    cos: Array,
    sin: Array,
    origins: Array,
    directions: Array,
) -> None:
    """Level rays from one point, turned by the angle with cosine c and sine s."""
    for k in range(len(cos)):
        origins[k, 0], origins[k, 1], origins[k, 2] = x, y, z
        directions[k, 0], directions[k, 1] = c * cos[k] - s * sin[k], s * cos[k] + c * sin[k]
        directions[k, 2] = 0.0


@njit(cache=True, error_model="numpy")
def _measure(distance: Array, noise: Array, shortest: float, longest: float) -> None:
    """Add the noise to the distances of hits, in place."""
    for k in range(len(distance)):
        if distance[k] < math.inf:
            distance[k] = min(max(distance[k] + noise[k], shortest), longest)


def build(spec: Lidar2dSpec) -> Lidar2d:
    """A lidar from its spec."""
    return Lidar2d(spec)
