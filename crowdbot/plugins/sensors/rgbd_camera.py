"""Depth camera, optionally with colour."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import model_validator

from crowdbot.plugin import (
    Component,
    Incidence,
    NonNegativeLength,
    PositiveFrequency,
    PositiveLength,
    Quantity,
    SensorSpec,
    TiltableMount,
    default,
)

DepthRenderer = Annotated[int, Ge(2), Le(4096)]
FieldOfView = Annotated[float, Gt(0), Lt(math.pi), Quantity("angle")]
#: Largest number of pixels of one image; more is a typing error.
MOST_PIXELS = 4_000_000


class RgbdCameraSpec(SensorSpec):
    """Reading: depth along the optical axis (height, width), m.

    A hit nearer than ``depth_min`` reads 0, nothing within ``depth_max`` reads inf. Defaults are
    those of the TurtleBot2's camera.
    """

    kind: Literal["rgbd_camera"] = "rgbd_camera"
    mount: TiltableMount = default(TiltableMount(), "Pose on the robot; it looks along x.")
    rate: PositiveFrequency = default(8.0, "Images per second, Hz.", le=128)
    width: DepthRenderer = default(320, "Columns of an image.")
    height: DepthRenderer = default(240, "Rows of an image.")
    horizontal_view: FieldOfView = default(
        math.pi / 3, "Horizontal field of view, rad; pixels are square."
    )
    depth_min: NonNegativeLength = default(0.4, "Nearest depth measured, m.")
    depth_max: PositiveLength = default(8.0, "Farthest depth measured, m.")
    max_incidence: Incidence = default(
        math.pi / 2, "Surfaces struck at a larger angle to their normal read inf, rad."
    )
    noise: Annotated[float, Ge(0)] = default(
        0.0, "Standard deviation of depth per squared depth, 1/m; 0.0014 is a Kinect's."
    )
    resolution: NonNegativeLength = default(
        0.0, "Depths are rounded to multiples of this, m; 0: not."
    )
    bits: Annotated[int, Ge(0), Le(32)] = default(
        0, "Depths are rounded down to 2^bits steps of the range; 0: not."
    )
    dropout: Annotated[float, Ge(0), Lt(1)] = default(
        0.0, "Probability that a pixel is lost and reads inf."
    )
    colour: bool = default(False, "Whether it takes colour images too; they need EGL.")

    def field_of_view(self) -> tuple[float, float, float]:
        """Return first and last angle, rad, and range, m, for drawings."""
        return -0.5 * self.horizontal_view, 0.5 * self.horizontal_view, self.depth_max

    @model_validator(mode="after")
    def _sensible(self) -> RgbdCameraSpec:
        if not self.depth_min < self.depth_max:
            raise ValueError("depth_min must be below depth_max")
        if self.width * self.height > MOST_PIXELS:
            raise ValueError(f"an image has at most {MOST_PIXELS} pixels")
        return self


RGBD_CAMERA = Component(
    spec=RgbdCameraSpec,
    summary="pinhole camera with depth, and colour if wanted",
)
