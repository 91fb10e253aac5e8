"""Smart Wheelchair: a powered wheelchair with its driver."""

from __future__ import annotations

from typing import Literal

import crowdbot.plugins.robots.limits as limits
from crowdbot.plugin import Component, PositiveLength, default


class SmartWheelchairSpec(limits.LimitedRobotSpec):
    """A powered wheelchair.

    Its width is that of the real chair, which drives 2.78 m/s outdoors; all else is proposed.

    The mass is that of the chair, 130 kg, and its driver, 75 kg; limits are for indoor use.
    """

    kind: Literal["smart_wheelchair"] = "smart_wheelchair"
    max_speed: limits.MaxSpeed = 1.5
    max_yaw_rate: limits.MaxYawRate = 1.5
    max_acceleration: limits.MaxAcceleration = 1.0
    max_yaw_acceleration: limits.MaxYawAcceleration = 2.0
    mass: limits.Mass = 205.0
    length: PositiveLength = default(1.1, "Foot rests included, m.", ge=0.9, le=1.3)
    width: PositiveLength = default(0.61, "m.", ge=0.6, le=0.75)

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return 0.5 * self.width


SMART_WHEELCHAIR = Component(
    spec=SmartWheelchairSpec,
    summary="powered wheelchair with its driver, mid-wheel drive, 1.1 m x 0.61 m, 1.5 m/s",
)
