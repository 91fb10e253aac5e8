"""Depth camera: one ray for each pixel, through the centre of the pixel.

Depth is measured along the optical axis: a wall that faces the camera has one depth everywhere. The
random error grows with the square of the depth, as in triangulation (Khoshelham and Elberink,
"Accuracy and resolution of Kinect depth data", Sensors 12, 2012, equation 12).
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import (
    Array,
    Pinhole,
    Pose,
    Scene,
    SensorInfo,
    kernel,
    mount_pose,
    mount_tilt,
    sensor_pose_in_world,
    sensor_rotation_in_world,
)
from crowdbot.plugin.for_sensors import MOST_MILLIMETRES, NO_RAYS, DepthRenderer, RayGrid, depth_mm
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec

Image = NDArray[np.float32]


class RgbdCamera(DescribedSensor):
    """Depth camera with a global shutter; the robot's own tilt does not move the axis."""

    def __init__(self, spec: RgbdCameraSpec) -> None:
        self._spec = spec
        focal = 0.5 * spec.width / math.tan(0.5 * spec.horizontal_view)
        pinhole = Pinhole(width=spec.width, height=spec.height, focal=focal, colour=spec.colour)
        self._info = SensorInfo(
            category="camera",
            frame="camera",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(spec.height, spec.width),
            ros_type="sensor_msgs/msg/Image",
            range_min=spec.depth_min,
            range_max=spec.depth_max,
            random=spec.noise > 0.0 or spec.dropout > 0.0,
            camera=pinhole,
            tilt=mount_tilt(spec.mount),
        )
        self._renderer = DepthRenderer(pinhole, spec.depth_min, spec.depth_max)
        self._step = (spec.depth_max - spec.depth_min) / 2.0**spec.bits if spec.bits else 0.0
        self._limited = spec.max_incidence < math.pi / 2
        # Azimuths of a grid increase, so its columns run from right to left.
        camera = self._renderer
        self._grid = RayGrid(np.arctan(camera.left[::-1]), camera.slope, camera.cos_azimuth[::-1])
        errors = spec.noise, spec.resolution, spec.bits, spec.dropout
        self._tilted = mount_tilt(spec.mount) != (0.0, 0.0)
        self._rays, self._stretch = _pixels(camera) if self._tilted else (NO_RAYS, np.ones(0))
        self._exact = (
            not self._tilted
            and not any(errors)
            and not self._limited
            and spec.depth_max < MOST_MILLIMETRES
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return depth (H, W) float32 in m, first row on top.

        Inf if nothing is in range, 0 if too near.
        """
        del t
        spec = self._spec
        at, yaw = sensor_pose_in_world(spec.mount, scene, pose)
        if self._tilted:
            depth = self._slanted(scene, at, pose)
        elif self._limited:
            depth = self._facing(scene, at, yaw)
        else:
            depth = scene.render_depth(self._renderer, at, yaw)
        if spec.noise > 0.0:
            # Drawn for every pixel, so that a pixel's noise does not depend on what others see.
            noise = rng.standard_normal(self._info.shape, dtype=np.float32)
            _disturb(depth, noise, spec.noise, spec.depth_min, spec.depth_max)
        if spec.resolution > 0.0:
            _round(depth, spec.resolution, spec.depth_min, spec.depth_max)
        if spec.bits:
            _round_down(depth, self._step, spec.depth_min)
        if spec.dropout > 0.0:
            depth[rng.random(self._info.shape) < spec.dropout] = np.inf
        return cast(Array, depth)

    def _slanted(self, scene: Scene, at: tuple[float, float, float], pose: Pose) -> Image:
        """Return depth (H, W) of a camera that is not level, ray by ray."""
        spec = self._spec
        turn = sensor_rotation_in_world(spec.mount, pose)
        reach = spec.depth_max * float(self._stretch.max())
        length, incidence, _ = scene.cast_tilted(at, turn, self._rays, reach)
        depth = length / self._stretch
        depth[depth < spec.depth_min] = 0.0
        depth[(incidence > spec.max_incidence) | (depth > spec.depth_max)] = np.inf
        return depth.reshape(self._info.shape).astype(np.float32)

    def _facing(self, scene: Scene, at: tuple[float, float, float], yaw: float) -> Image:
        """Return depth (H, W) of surfaces not hit at too large an angle, ray by ray."""
        spec, grid = self._spec, self._grid
        scale = grid.slope_scale
        stretch = np.sqrt(1.0 + (grid.slope[:, np.newaxis] * scale) ** 2) / scale
        reach = spec.depth_max * float(stretch.max())
        length, incidence, _ = scene.cast_grid(grid, at, yaw, reach, floor=True)
        depth = length / stretch
        depth[depth < spec.depth_min] = 0.0
        depth[(incidence > spec.max_incidence) | (depth > spec.depth_max)] = np.inf
        return np.ascontiguousarray(depth[:, ::-1], np.float32)

    def depth_mm(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator
    ) -> NDArray[np.uint16]:
        """Return depth (H, W) in whole millimetres, 0 if too near or nothing is in range."""
        if self._exact:
            at, yaw = sensor_pose_in_world(self._spec.mount, scene, pose)
            return scene.render_depth_mm(self._renderer, at, yaw)
        return depth_mm(self.read(scene, pose, t, rng))


def _pixels(camera: DepthRenderer) -> tuple[Array, Array]:
    """Return the pixels' ray directions (H * W, 3), and lengths (H * W,) per metre of depth."""
    rays = np.ones((*camera.shape, 3))
    rays[..., 1], rays[..., 2] = camera.left, camera.slope[:, np.newaxis]
    flat = rays.reshape(-1, 3)
    stretch = np.linalg.norm(flat, axis=1)
    return flat / stretch[:, np.newaxis], stretch


@kernel
def _disturb(depth: Image, noise: Image, deviation: float, nearest: float, farthest: float) -> None:
    """Add an error to the measured depths (H, W), in place.

    Args:
        noise: (H, W) with a standard deviation of 1.
        deviation: standard deviation of depth per squared depth, 1/m.
    """
    for r in range(depth.shape[0]):
        for c in range(depth.shape[1]):
            true = depth[r, c]
            if 0.0 < true < math.inf:
                found = true + true * true * deviation * noise[r, c]
                depth[r, c] = min(max(found, nearest), farthest)


@kernel
def _round(depth: Image, step: float, nearest: float, farthest: float) -> None:
    """Round the measured depths to multiples of ``step``, in place."""
    for r in range(depth.shape[0]):
        for c in range(depth.shape[1]):
            if 0.0 < depth[r, c] < math.inf:
                rounded = round(depth[r, c] / step) * step
                depth[r, c] = min(max(rounded, nearest), farthest)


@kernel
def _round_down(depth: Image, step: float, nearest: float) -> None:
    """Round the measured depths down to multiples of ``step``, in place."""
    for r in range(depth.shape[0]):
        for c in range(depth.shape[1]):
            if 0.0 < depth[r, c] < math.inf:
                depth[r, c] = max(math.floor(depth[r, c] / step) * step, nearest)


build = RgbdCamera.from_spec
