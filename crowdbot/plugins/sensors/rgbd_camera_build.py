"""Depth camera: one ray for each pixel, through the centre of the pixel.

Depth is measured along the optical axis: a wall that faces the camera has one depth everywhere.
The random error grows as the square of the depth, as triangulation has it (Khoshelham and
Elberink, "Accuracy and resolution of Kinect depth data", Sensors 12, 2012, equation 12).
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pinhole, Pose, SensorInfo
from crowdbot.core.sensing.columns import Grid
from crowdbot.core.sensing.place import mount_of, placed
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec

Array = NDArray[np.float64]


class RgbdCamera:
    """A global shutter; the axis stays level whatever the robot's tilt."""

    def __init__(self, spec: RgbdCameraSpec) -> None:
        self._spec = spec
        focal = 0.5 * spec.width / math.tan(0.5 * spec.horizontal_view)
        pinhole = Pinhole(width=spec.width, height=spec.height, focal=focal, colour=spec.colour)
        self._info = SensorInfo(
            category="camera",
            frame="camera",
            mount=mount_of(spec.mount),
            rate=spec.rate,
            shape=(spec.height, spec.width),
            ros_type="sensor_msgs/msg/Image",
            range_min=spec.depth_min,
            range_max=spec.depth_max,
            random=spec.noise > 0.0,
            camera=pinhole,
        )
        column, row = pinhole.centre
        left = (column - np.arange(spec.width)) / focal
        up = (row - np.arange(spec.height)) / focal
        # Azimuths of a grid rise, so its columns run from right to left.
        self._grid = Grid(np.arctan(left[::-1]), up, 1.0 / np.sqrt(1.0 + left[::-1] ** 2))
        self._reach = spec.depth_max * math.sqrt(1.0 + float(np.max(left**2)))

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Depth (H, W) float32 in m, first row on top: inf for nothing in reach, 0 for too near."""
        del t
        spec = self._spec
        at, yaw = placed(spec.mount, scene, pose)
        seen = scene.cast_depth(self._grid, at, yaw, self._reach)
        shape = self._info.shape
        if spec.noise > 0.0:
            # Drawn for every pixel, so that one's noise does not depend on what others see.
            noise = spec.noise * rng.standard_normal(shape, dtype=np.float32)
        else:
            noise = np.zeros((0, 0), np.float32)
        depth = np.empty(shape, np.float32)
        _measure(seen, noise, spec.depth_min, spec.depth_max, spec.resolution, depth)
        return cast(Array, depth)


#: Columns that are turned into rows at a time: as many pixels as a line of the cache holds.
_BLOCK = 16


@njit(cache=True, error_model="numpy")
def _measure(
    seen: Array, noise: NDArray[np.float32], nearest: float, farthest: float, step: float,
    out: NDArray[np.float32],
) -> None:  # fmt: skip
    """Write the measured depths (H, W) of columns (W, H) that run from right to left."""
    rows, columns = out.shape
    exact = noise.shape[0] == 0 and step <= 0.0
    block = np.empty((_BLOCK, rows), np.float32)
    for first in range(0, columns, _BLOCK):
        width = min(_BLOCK, columns - first)
        for b in range(width):
            c = first + b
            column = seen[columns - 1 - c]
            for r in range(rows):
                depth = column[r]
                block[b, r] = 0.0 if depth < nearest else depth if depth <= farthest else math.inf
            if not exact:
                for r in range(rows):
                    depth = column[r]
                    if depth < nearest or depth > farthest:
                        continue
                    if noise.shape[0]:
                        depth += depth * depth * noise[r, c]
                    if step > 0.0:
                        depth = round(depth / step) * step
                    block[b, r] = min(max(depth, nearest), farthest)
        for r in range(rows):
            for b in range(width):
                out[r, first + b] = block[b, r]


def build(spec: RgbdCameraSpec) -> RgbdCamera:
    """A camera from its spec."""
    return RgbdCamera(spec)
