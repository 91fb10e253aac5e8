"""Planar lidar: a fan of level rays from one point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import NoiseGenerator, Pose, SensorInfo
from crowdbot.core.sensing.columns import Grid
from crowdbot.core.sensing.proximity import Proximity
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec

Array = NDArray[np.float64]


class Lidar2d:
    """All beams are taken at one instant, level whatever the robot's tilt."""

    def __init__(self, spec: Lidar2dSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._range_max, self._proximity = spec.range_max, Proximity(spec, noise)
        angles: Array = spec.angle_min + spec.angle_step * np.arange(spec.beams, dtype=np.float64)
        angles.setflags(write=False)
        self._info = SensorInfo(
            category="lidar",
            frame="lidar",
            mount=self._proximity.mount,
            rate=spec.rate,
            shape=(spec.beams,),
            ros_type="sensor_msgs/msg/LaserScan",
            angles=angles,
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._proximity.random,
        )
        self._grid = Grid(angles, [0.0])

    def info(self) -> SensorInfo:
        """Constant description; ``angles`` are in the sensor frame."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Ranges (R,) in m, inf for no return."""
        del t
        own = self._proximity
        distance, incidence, _ = scene.cast_grid(
            self._grid, *own.place(scene, pose), self._range_max, details=own.limited
        )
        own.returned(distance, incidence)
        return own.measured(distance[0], rng)


def build(spec: Lidar2dSpec, noise: Sequence[NoiseGenerator] = ()) -> Lidar2d:
    """A lidar from its spec and its noise generators."""
    return Lidar2d(spec, noise)
