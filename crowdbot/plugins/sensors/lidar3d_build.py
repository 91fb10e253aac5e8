"""Multi-layer lidar: a grid of rays from one point, level whatever the robot's tilt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import NoiseGenerator, Pose, SensorInfo
from crowdbot.core.sensing.columns import Grid
from crowdbot.core.sensing.proximity import Proximity
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.lidar3d import Lidar3dSpec

Array = NDArray[np.float64]


class Lidar3d:
    """All beams are taken at one instant; the floor is hit, the robot is not."""

    def __init__(self, spec: Lidar3dSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._range_max, self._proximity = spec.range_max, Proximity(spec, noise)
        azimuth: Array = spec.angle_min + spec.angle_step * np.arange(spec.beams, dtype=np.float64)
        elevation = np.array(spec.elevation)
        angles = np.stack(np.meshgrid(azimuth, elevation), axis=-1)
        angles.setflags(write=False)
        self._info = SensorInfo(
            category="lidar3d",
            frame="lidar",
            mount=self._proximity.mount,
            rate=spec.rate,
            shape=(len(elevation), len(azimuth)),
            ros_type="sensor_msgs/msg/PointCloud2",
            angles=angles,
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._proximity.random,
        )
        self._grid = Grid(azimuth, np.tan(elevation))

    def info(self) -> SensorInfo:
        """Constant description; ``angles`` (L, C, 2) are azimuth and elevation of each beam."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Ranges (L, C) in m, lowest layer first, inf for no return."""
        del t
        own = self._proximity
        distance, incidence, _ = scene.cast_grid(
            self._grid, *own.place(scene, pose), self._range_max, floor=True, details=own.limited
        )
        own.returned(distance, incidence)
        return own.measured(distance.ravel(), rng).reshape(self._info.shape)


def build(spec: Lidar3dSpec, noise: Sequence[NoiseGenerator] = ()) -> Lidar3d:
    """A lidar from its spec and its noise generators."""
    return Lidar3d(spec, noise)
