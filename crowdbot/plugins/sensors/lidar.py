"""Shared parts of lidars with one layer and with several."""

from __future__ import annotations

import math

from pydantic import Field, model_validator

from crowdbot.plugin import (
    MOST_RAYS,
    Angle,
    NonNegativeLength,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
    RangeSensorSpec,
    TiltableMount,
)

_SLACK = 1e-9  # rad; 360 deg in any unit is one turn


class LidarSpec(RangeSensorSpec):
    """Beams from ``angle_min`` (included) to ``angle_max`` (excluded), counter-clockwise."""

    mount: TiltableMount = Field(default=TiltableMount(), description="Pose on the robot.")
    rate: PositiveFrequency = Field(default=16.0, le=128, description="Scans per second, Hz.")
    angle_min: Angle = Field(default=-2.0943951023931953, description="First beam, rad.")
    angle_max: Angle = Field(default=2.0943951023931953, description="End of the scan, rad.")
    angle_step: PositiveAngle = Field(
        default=0.008726646259971648, description="Between beams, rad."
    )
    range_min: NonNegativeLength = Field(
        default=0.1, description="Nearest reading; what is nearer reads this, m."
    )
    range_max: PositiveLength = Field(default=10.0, description="Farthest hit, m.")

    @property
    def beams(self) -> int:
        """Return the number of beams of a fan."""
        return max(1, round((self.angle_max - self.angle_min) / self.angle_step))

    @model_validator(mode="after")
    def _fan(self) -> LidarSpec:
        if not self.angle_min < self.angle_max:
            raise ValueError("angle_min must be below angle_max")
        if self.angle_max - self.angle_min > 2.0 * math.pi + _SLACK:
            raise ValueError("a scan covers at most one turn, 360 deg")
        if self.beams > MOST_RAYS:
            raise ValueError(f"{self.beams} beams, more than {MOST_RAYS}: angle_step is too small")
        return self
