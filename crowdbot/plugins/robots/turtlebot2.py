"""TurtleBot2: Kobuki base and hexagon stack."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import Component
from crowdbot.plugins.robots.limits import (
    LimitedRobotSpec,
    Mass,
    MaxAcceleration,
    MaxSpeed,
    MaxYawAcceleration,
    MaxYawRate,
)


class Turtlebot2Spec(LimitedRobotSpec):
    """TurtleBot2 with a box of limits; the body itself is fixed."""

    wheels: ClassVar[tuple[float, float]] = (0.035, 0.23)

    kind: Literal["turtlebot2"] = "turtlebot2"
    max_speed: MaxSpeed = 0.65
    max_yaw_rate: MaxYawRate = 3.14
    max_acceleration: MaxAcceleration = 1.0
    max_yaw_acceleration: MaxYawAcceleration = 2.0
    mass: Mass = 6.3

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline, m."""
        return 0.178


TURTLEBOT2 = Component(
    spec=Turtlebot2Spec,
    summary="Kobuki base with hexagon stack, differential drive, 0.65 m/s",
)
