"""Shared parts of lidars with one layer and with several."""

from __future__ import annotations

import math

from pydantic import model_validator

from crowdbot.plugin import (
    MOST_RAYS,
    Angle,
    NonNegativeLength,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
    RangeSensorSpec,
    TiltableMount,
    default,
)

_COUNTABLE = 1e15  # a tiny step is that of infinitely many beams
_SLACK = 1e-9  # rad; 360 deg in any unit is one turn


class LidarSpec(RangeSensorSpec):
    """Beams from ``angle_min`` (included) to ``angle_max`` (excluded), counter-clockwise."""

    mount: TiltableMount = default(TiltableMount(), "Pose on the robot.")
    rate: PositiveFrequency = default(16.0, "Scans per second, Hz.", le=128)
    angle_min: Angle = default(-2.0943951023931953, "First beam, rad.")
    angle_max: Angle = default(2.0943951023931953, "End of the scan, rad.")
    angle_step: PositiveAngle = default(0.008726646259971648, "Between beams, rad.")
    range_min: NonNegativeLength = default(0.1, "Nearest reading; what is nearer reads this, m.")
    range_max: PositiveLength = default(10.0, "Farthest hit, m.")

    @property
    def beams(self) -> int:
        """Return the number of beams of a fan."""
        steps = (self.angle_max - self.angle_min) / self.angle_step
        return max(1, round(min(steps, _COUNTABLE)))

    @model_validator(mode="after")
    def _fan(self) -> LidarSpec:
        if not self.angle_min < self.angle_max:
            raise ValueError("angle_min must be below angle_max")
        if self.angle_max - self.angle_min > 2.0 * math.pi + _SLACK:
            raise ValueError("a scan covers at most one turn, 360 deg")
        if self.beams > MOST_RAYS:
            raise ValueError(f"{self.beams} beams, more than {MOST_RAYS}: angle_step is too small")
        return self
