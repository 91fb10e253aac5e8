"""Qolo: a standing wheelchair on two wheels and a caster, with its rider."""

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


class QoloSpec(RobotSpec):
    """Limits and outline after EPFL's controller; the mass, rider included, is proposed.

    The original's prefab weighs 254 kg. Its motors do not turn at full speed; a box of limits does
    not say so.
    """

    kind: Literal["qolo"] = "qolo"
    max_speed: PositiveSpeed = Field(default=1.5, description="Largest |v|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=1.18, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(default=1.5, description="Slew of v, m/s^2.")
    max_yaw_acceleration: PositiveAngularAcceleration = Field(
        default=4.5, description="Slew of w, rad/s^2."
    )
    command_timeout: PositiveDuration = Field(
        default=0.6, description="Without a command for so long it stops, s (proposed)."
    )
    mass: PositiveMass = Field(default=120.0, description="Robot and rider, kg.")
    radius: PositiveLength = Field(
        default=0.4, le=0.5, ge=0.3, description="Of the capsule that is its outline, m."
    )


QOLO = Component(
    spec=QoloSpec,
    build="crowdbot.plugins.robots.qolo_build:build",
    summary="standing wheelchair with a rider, differential drive, capsule of 1.37 m, 1.5 m/s",
)
