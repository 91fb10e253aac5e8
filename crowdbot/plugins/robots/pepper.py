"""Pepper: a humanoid on three omni wheels."""

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


class PepperSpec(RobotSpec):
    """Goes in every direction; arms and head are held still.

    Mass after the published URDF; speed and acceleration as its software (NAOqi) is remembered to
    limit them: by wheel speed and radius of the URDF it would be 0.44 m/s.
    """

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["pepper"] = "pepper"
    max_speed: PositiveSpeed = Field(default=0.55, description="Largest |v| and |vy|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=2.0, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(
        default=0.55, description="Slew of (v, vy), m/s^2."
    )
    max_yaw_acceleration: PositiveAngularAcceleration = Field(
        default=3.0, description="Slew of w, rad/s^2."
    )
    command_timeout: PositiveDuration = Field(
        default=0.6, description="Without a command for so long it stops, s (proposed)."
    )
    mass: PositiveMass = Field(default=28.7, description="Whole robot, kg.")


PEPPER = Component(
    spec=PepperSpec,
    build="crowdbot.plugins.robots.pepper_build:build",
    summary="humanoid on three omni wheels, goes sideways too, 0.55 m/s",
)
