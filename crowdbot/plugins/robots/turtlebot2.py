"""TurtleBot2: Kobuki base and hexagon stack."""

from __future__ import annotations

from typing import ClassVar, Literal

import crowdbot.plugins.robots.limits as limits
from crowdbot.plugin import Component


class Turtlebot2Spec(limits.LimitedRobotSpec):
    """TurtleBot2 with a box of limits; the body itself is fixed."""

    wheels: ClassVar[tuple[float, float]] = (0.035, 0.23)

    kind: Literal["turtlebot2"] = "turtlebot2"
    max_speed: limits.MaxSpeed = 0.65
    max_yaw_rate: limits.MaxYawRate = 3.14
    max_acceleration: limits.MaxAcceleration = 1.0
    max_yaw_acceleration: limits.MaxYawAcceleration = 2.0
    mass: limits.Mass = 6.3

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return 0.178


TURTLEBOT2 = Component(
    spec=Turtlebot2Spec,
    summary="Kobuki base with hexagon stack, differential drive, 0.65 m/s",
)
