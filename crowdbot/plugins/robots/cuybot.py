"""CuyBot: a base with a column, made to be touched and pushed."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from crowdbot.dsl import (
    Component,
    PositiveAcceleration,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveForce,
    PositiveMass,
    PositiveSpeed,
    PositiveStiffness,
    RobotSpec,
)


class CuybotSpec(RobotSpec):
    """Size and weight after the original's prefab; nothing else about it is published.

    It gives way: who pushes harder than `yield_force` moves it, and it brakes with that force when
    the push is over. Its skin is a spring in series with the person's body.
    """

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["cuybot"] = "cuybot"
    max_speed: PositiveSpeed = Field(default=1.5, description="Largest |v| and |vy|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(default=2.0, description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(
        default=1.0, description="Slew of (v, vy), m/s^2."
    )
    max_yaw_acceleration: PositiveAngularAcceleration = Field(
        default=2.0, description="Slew of w, rad/s^2."
    )
    command_timeout: PositiveDuration = Field(
        default=0.6, description="Without a command for so long it stops, s."
    )
    mass: PositiveMass = Field(default=100.0, description="Whole robot, kg.")
    yield_force: PositiveForce = Field(
        default=120.0, description="Largest force of its drive, in any direction, N."
    )
    skin_stiffness: PositiveStiffness = Field(
        default=10000.0, description="Of the skin, in series with the person's body, N/m."
    )


CUYBOT = Component(
    spec=CuybotSpec,
    build="crowdbot.plugins.robots.cuybot_build:build",
    summary="base with a column and a soft skin, goes sideways too, gives way when pushed",
)
