"""Planar lidar."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from crowdbot.core.component import Component
from crowdbot.dsl.base import Mount, SensorSpec
from crowdbot.dsl.quantities import (
    Angle,
    NonNegativeLength,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
)


class Lidar2dSpec(SensorSpec):
    """Beams from ``angle_min`` (included) to ``angle_max`` (excluded), counter-clockwise."""

    kind: Literal["lidar2d"] = "lidar2d"
    mount: Mount = Field(default=Mount(), description="Pose on the robot.")
    rate: PositiveFrequency = Field(default=16.0, le=128, description="Scans per second, Hz.")
    angle_min: Angle = Field(default=-2.0943951023931953, description="First beam, rad.")
    angle_max: Angle = Field(default=2.0943951023931953, description="End of the scan, rad.")
    angle_step: PositiveAngle = Field(
        default=0.008726646259971648, description="Between beams, rad."
    )
    range_min: NonNegativeLength = Field(default=0.1, description="Nearest hit, m.")
    range_max: PositiveLength = Field(default=10.0, description="Farthest hit, m.")
    noise: NonNegativeLength = Field(
        default=0.001, description="Standard deviation of each hit, m."
    )

    @model_validator(mode="after")
    def _ordered(self) -> Lidar2dSpec:
        if not self.angle_min < self.angle_max:
            raise ValueError("angle_min must be below angle_max")
        if not self.range_min < self.range_max:
            raise ValueError("range_min must be below range_max")
        return self


LIDAR2D = Component(
    spec=Lidar2dSpec,
    build="crowdbot.plugins.sensors.lidar2d_build:build",
    summary="planar laser scanner with Gaussian range noise",
)
