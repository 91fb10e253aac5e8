"""TurtleBot2: Kobuki base and hexagon stack."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from crowdbot.dsl import (
    Component,
    PositiveAcceleration,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveMass,
    PositiveSpeed,
    RobotSpec,
)


class Turtlebot2Spec(RobotSpec):
    """Limits are a box; the body itself is fixed."""

    wheels: ClassVar[tuple[float, float]] = (0.035, 0.23)

    kind: Literal["turtlebot2"] = "turtlebot2"
    max_speed: PositiveSpeed = Field(default=0.65, description="Largest |v|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=3.14, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(default=1.0, description="Slew of v, m/s^2.")
    max_yaw_acceleration: PositiveAngularAcceleration = Field(
        default=2.0, description="Slew of w, rad/s^2."
    )
    command_timeout: PositiveDuration = Field(
        default=0.6, description="Without a command for so long it stops, s (as the Kobuki does)."
    )
    mass: PositiveMass = Field(default=6.3, description="Whole robot, kg.")


TURTLEBOT2 = Component(
    spec=Turtlebot2Spec,
    build="crowdbot.plugins.robots.turtlebot2_build:build",
    summary="Kobuki base with hexagon stack, differential drive, 0.65 m/s",
)
