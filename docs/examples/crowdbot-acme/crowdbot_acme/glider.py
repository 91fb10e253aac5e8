"""Glider: a long robot that goes in every direction."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import (
    Component,
    PositiveAcceleration,
    PositiveAngularSpeed,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    RobotSpec,
)
from pydantic import Field


class GliderSpec(RobotSpec):
    """A capsule on omni wheels, as seen from above: a box with round ends."""

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")

    kind: Literal["acme.glider"] = "acme.glider"
    length: PositiveLength = Field(default=0.5, description="Between the round ends, m.")
    radius: PositiveLength = Field(default=0.2, description="Of the round ends, m.")
    height: PositiveLength = Field(default=0.5, description="Of the whole robot, m.")
    mass: PositiveMass = Field(default=25.0, description="Whole robot, kg.")
    max_speed: PositiveSpeed = Field(default=0.8, description="Largest |v| and |vy|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=1.5, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(default=1.0, description="Slew, m/s^2.")


GLIDER = Component(
    spec=GliderSpec,
    build="crowdbot_acme.glider_build:build",
    summary="holonomic capsule on omni wheels, 0.8 m/s",
)
