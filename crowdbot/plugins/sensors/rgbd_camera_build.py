"""Depth camera: one ray for each pixel, through the centre of the pixel.

Depth is measured along the optical axis: a wall that faces the camera has one depth everywhere.
The random error grows as the square of the depth, as triangulation has it (Khoshelham and
Elberink, "Accuracy and resolution of Kinect depth data", Sensors 12, 2012, equation 12).
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pinhole, Pose, SensorInfo
from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.columns import Grid, fill_columns, heights_of
from crowdbot.core.sensing.depth import floor_depths, paint_column
from crowdbot.core.sensing.place import mount_of, placed
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec

Array = NDArray[np.float64]

#: Columns that are turned into rows at a time: as many pixels as a line of the cache holds.
_BLOCK = 16


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
        self._floor, self._column = np.empty(spec.height), np.empty(spec.height)
        self._block = np.empty((_BLOCK, spec.height), np.float32)
        self._reach = spec.depth_max * math.sqrt(1.0 + float(np.max(left**2)))

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Depth (H, W) float32 in m, first row on top: inf for nothing in reach, 0 for too near."""
        del t
        spec = self._spec
        at, yaw = placed(spec.mount, scene, pose)
        shape, grid = self._info.shape, self._grid
        if spec.noise > 0.0:
            # Drawn for every pixel, so that one's noise does not depend on what others see.
            noise = spec.noise * rng.standard_normal(shape, dtype=np.float32)
        else:
            noise = np.zeros((0, 0), np.float32)
        depth = np.empty(shape, np.float32)
        _photograph(
            *at, yaw, grid.azimuth, grid.cos, grid.sin, grid.rise, grid.lean, self._reach,
            scene.walls, scene.wall_heights, *scene.bodies, grid.work, grid.count, grid.ways,
            grid.runs, self._floor, self._column, self._block,
            noise, spec.depth_min, spec.depth_max, spec.resolution, depth,
        )  # fmt: skip
        return cast(Array, depth)


@kernel
def _photograph(
    x: float, y: float, z: float, yaw: float, azimuth: Array, cos: Array, sin: Array,
    rise: Array, lean: Array, max_range: float, walls: Array, wall_heights: Array, discs: Array,
    owner: NDArray[np.int64], work: Array, count: NDArray[np.int64], ways: Array,
    runs: NDArray[np.int64], floor: Array, column: Array, block: NDArray[np.float32],
    noise: NDArray[np.float32], nearest: float, farthest: float, step: float,
    out: NDArray[np.float32],
) -> None:  # fmt: skip
    """Paint and measure an image (H, W), block by block, so that it is written only once.

    Arguments up to ``runs`` are those of `crowdbot.core.sensing.depth.paint_depth`; the grid's
    columns run from right to left.

    Args:
        floor, column, block: (H,), (H,), (`_BLOCK`, H) scratch.
    """
    rows, columns = out.shape
    lowest, highest = heights_of(z, rise, lean, max_range)
    fill_columns(
        x, y, yaw, lowest, highest, azimuth, cos, sin, max_range,
        walls, wall_heights, discs, owner, work, count, ways, runs,
    )  # fmt: skip
    floor_depths(z, rise, floor)
    for first in range(0, columns, _BLOCK):
        width = min(_BLOCK, columns - first)
        for b in range(width):
            c = columns - 1 - first - b
            paint_column(z, rise, lean[c], work[c, : count[c]], floor, column)
            _measure(column, noise, first + b, nearest, farthest, step, block[b])
        if width == _BLOCK:  # of known length, which is twice as fast
            for r in range(rows):
                for b in range(_BLOCK):
                    out[r, first + b] = block[b, r]
        else:
            for r in range(rows):
                for b in range(width):
                    out[r, first + b] = block[b, r]


@kernel
def _measure(
    column: Array, noise: NDArray[np.float32], c: int, nearest: float, farthest: float,
    step: float, out: NDArray[np.float32],
) -> None:  # fmt: skip
    """Measured depths (H,) of column c of an image."""
    for r in range(column.shape[0]):
        depth = column[r]
        out[r] = 0.0 if depth < nearest else depth if depth <= farthest else math.inf
    if noise.shape[0] == 0 and step <= 0.0:
        return
    for r in range(column.shape[0]):
        depth = column[r]
        if depth < nearest or depth > farthest:
            continue
        if noise.shape[0]:
            depth += depth * depth * noise[r, c]
        if step > 0.0:
            depth = round(depth / step) * step
        out[r] = min(max(depth, nearest), farthest)


def build(spec: RgbdCameraSpec) -> RgbdCamera:
    """A camera from its spec."""
    return RgbdCamera(spec)
