"""Qolo: a standing wheelchair on two wheels and a caster, with its rider."""

from __future__ import annotations

from typing import Literal

import crowdbot.plugins.robots.limits as limits
from crowdbot.plugin import Component, PositiveLength, default


class QoloSpec(limits.LimitedRobotSpec):
    """Qolo with limits and outline of EPFL's controller; the mass, with rider, is proposed.

    The original's prefab weighs 254 kg. The real motors cannot turn the robot at full speed, which
    a box of limits cannot express.
    """

    kind: Literal["qolo"] = "qolo"
    max_speed: limits.MaxSpeed = 1.5
    max_yaw_rate: limits.MaxYawRate = 1.18
    max_acceleration: limits.MaxAcceleration = 1.5
    max_yaw_acceleration: limits.MaxYawAcceleration = 4.5
    mass: limits.Mass = 120.0
    radius: PositiveLength = default(0.4, "Of the capsule that is its outline, m.", le=0.5, ge=0.3)

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return self.radius


QOLO = Component(
    spec=QoloSpec,
    summary="standing wheelchair with a rider, differential drive, capsule of 1.37 m, 1.5 m/s",
)
