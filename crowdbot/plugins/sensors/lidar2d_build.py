"""Planar lidar: a fan of rays from one point, horizontal unless its mount is tilted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import (
    Array,
    NoiseGenerator,
    Pose,
    RangeModel,
    Scene,
    SensorInfo,
)
from crowdbot.plugin.for_sensors import NO_RAYS, RayGrid, grid_rays
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec


class Lidar2d(DescribedSensor):
    """All beams are measured at the same time, whatever the robot's tilt.

    A lidar that is tilted down sees the floor.
    """

    def __init__(self, spec: Lidar2dSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._range_max, self._range_model = spec.range_max, RangeModel(spec, noise)
        angles: Array = spec.angle_min + spec.angle_step * np.arange(spec.beams, dtype=np.float64)
        angles.setflags(write=False)
        self._info = SensorInfo(
            category="lidar",
            frame="lidar",
            mount=self._range_model.mount,
            rate=spec.rate,
            shape=(spec.beams,),
            ros_type="sensor_msgs/msg/LaserScan",
            angles=angles,
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._range_model.random,
            tilt=self._range_model.tilt,
        )
        self._grid = RayGrid(angles, [0.0])
        self._rays = grid_rays(self._grid) if self._range_model.tilted else NO_RAYS

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return ranges (R,) in m, inf for no return."""
        del t
        own = self._range_model
        if own.tilted:
            return own.measure(own.cast_tilted(scene, pose, self._rays), rng)
        distance, incidence, _ = scene.cast_grid(
            self._grid, *own.pose_in_world(scene, pose), self._range_max, details=own.drops_slanted
        )
        own.drop_slanted(distance, incidence)
        return own.measure(distance[0], rng)


build = Lidar2d.from_spec
