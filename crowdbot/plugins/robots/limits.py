"""Fields shared by the robots' specs: a box of limits, and a mass."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from crowdbot.plugin import (
    PositiveAcceleration,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveMass,
    PositiveSpeed,
    RobotSpec,
)

MaxSpeed = Annotated[
    PositiveSpeed,
    Field(description="Largest |v|, and |vy| where it goes sideways, m/s."),
]
MaxYawRate = Annotated[PositiveAngularSpeed, Field(description="Largest |w|, rad/s.")]
MaxAcceleration = Annotated[
    PositiveAcceleration,
    Field(description="Slew of v, of (v, vy) where it goes sideways, m/s^2."),
]
MaxYawAcceleration = Annotated[
    PositiveAngularAcceleration, Field(description="Slew of w, rad/s^2.")
]
CommandTimeout = Annotated[
    PositiveDuration, Field(description="The robot stops after this long without a command, s.")
]
Mass = Annotated[PositiveMass, Field(description="Whole robot, with who rides on it, kg.")]


class LimitedRobotSpec(RobotSpec):
    """Abstract robot whose limits form a box. Each robot sets its own numbers.

    The Kobuki stops after 0.6 s without a command; for the other robots this is proposed.
    """

    max_speed: MaxSpeed
    max_yaw_rate: MaxYawRate
    max_acceleration: MaxAcceleration
    max_yaw_acceleration: MaxYawAcceleration
    command_timeout: CommandTimeout = 0.6
    mass: Mass
