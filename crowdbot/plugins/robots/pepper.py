"""Pepper: a humanoid on three omni wheels."""

from __future__ import annotations

from typing import ClassVar, Literal

import crowdbot.plugins.robots.limits as limits
from crowdbot.plugin import Component


class PepperSpec(limits.LimitedRobotSpec):
    """Pepper, which drives in every direction; its arms and head are held still.

    The mass is from the published URDF. Speed and acceleration are those usually given for its
    software (NAOqi), without a checked source; wheel speed and radius in the URDF give 0.44 m/s.
    """

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["pepper"] = "pepper"
    max_speed: limits.MaxSpeed = 0.55
    max_yaw_rate: limits.MaxYawRate = 2.0
    max_acceleration: limits.MaxAcceleration = 0.55
    max_yaw_acceleration: limits.MaxYawAcceleration = 3.0
    mass: limits.Mass = 28.7

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return 0.27


PEPPER = Component(
    spec=PepperSpec,
    summary="humanoid on three omni wheels, goes sideways too, 0.55 m/s",
)
