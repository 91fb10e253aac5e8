"""Multi-layer lidar: a grid of rays from one point, horizontal unless its mount is tilted."""

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
from crowdbot.plugins.sensors.lidar3d import Lidar3dSpec


class Lidar3d(DescribedSensor):
    """All beams are measured at the same time; they hit the floor but not the robot.

    The ``angles`` (L, C, 2) of its description are each beam's azimuth and elevation.
    """

    def __init__(self, spec: Lidar3dSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._range_max, self._range_model = spec.range_max, RangeModel(spec, noise)
        azimuth: Array = spec.angle_min + spec.angle_step * np.arange(spec.beams, dtype=np.float64)
        elevation = np.array(spec.elevation)
        angles = np.stack(np.meshgrid(azimuth, elevation), axis=-1)
        angles.setflags(write=False)
        self._info = SensorInfo(
            category="lidar3d",
            frame="lidar",
            mount=self._range_model.mount,
            rate=spec.rate,
            shape=(len(elevation), len(azimuth)),
            ros_type="sensor_msgs/msg/PointCloud2",
            angles=angles,
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._range_model.random,
            tilt=self._range_model.tilt,
        )
        self._grid = RayGrid(azimuth, np.tan(elevation))
        self._rays = grid_rays(self._grid) if self._range_model.tilted else NO_RAYS

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return ranges (L, C) in m, lowest layer first, inf for no return."""
        del t
        own = self._range_model
        if own.tilted:
            distance = own.measure(own.cast_tilted(scene, pose, self._rays), rng)
            return distance.reshape(self._info.shape)
        distance, incidence, _ = scene.cast_grid(
            self._grid,
            *own.pose_in_world(scene, pose),
            self._range_max,
            floor=True,
            details=own.drops_slanted,
        )
        own.drop_slanted(distance, incidence)
        return own.measure(distance.ravel(), rng).reshape(self._info.shape)


build = Lidar3d.from_spec
