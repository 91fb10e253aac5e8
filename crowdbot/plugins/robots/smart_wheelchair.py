"""Smart Wheelchair: a powered wheelchair with its driver."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.dsl import (
    Component,
    PositiveAcceleration,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    RobotSpec,
)


class SmartWheelchairSpec(RobotSpec):
    """Width after the real chair, which goes 2.78 m/s outdoors; all the rest is proposed."""

    kind: Literal["smart_wheelchair"] = "smart_wheelchair"
    max_speed: PositiveSpeed = Field(default=1.5, description="Largest |v| indoors, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=1.5, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(default=1.0, description="Slew of v, m/s^2.")
    max_yaw_acceleration: PositiveAngularAcceleration = Field(
        default=2.0, description="Slew of w, rad/s^2."
    )
    command_timeout: PositiveDuration = Field(
        default=0.6, description="Without a command for so long it stops, s."
    )
    mass: PositiveMass = Field(default=205.0, description="Chair (130 kg) and driver (75 kg), kg.")
    length: PositiveLength = Field(
        default=1.1, ge=0.9, le=1.3, description="Foot rests included, m."
    )
    width: PositiveLength = Field(default=0.61, ge=0.6, le=0.75, description="m.")


SMART_WHEELCHAIR = Component(
    spec=SmartWheelchairSpec,
    build="crowdbot.plugins.robots.smart_wheelchair_build:build",
    summary="powered wheelchair with its driver, mid-wheel drive, 1.1 m x 0.61 m, 1.5 m/s",
)
