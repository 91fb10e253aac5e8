"""Wheel odometry from quantised encoders."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt
from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import SensorSpec
from crowdbot.dsl.quantities import PositiveFrequency, PositiveLength


class WheelOdometrySpec(SensorSpec):
    """Reading: x, y (m), yaw (rad), v (m/s), w (rad/s); starts at the task's start pose."""

    kind: Literal["wheel_odometry"] = "wheel_odometry"
    rate: PositiveFrequency = Field(default=64.0, le=128, description="Readings per second, Hz.")
    wheel_radius: PositiveLength = Field(
        default=0.035, description="Radius the firmware believes in, m."
    )
    track: PositiveLength = Field(default=0.23, description="Distance between the wheels, m.")
    ticks_per_turn: Annotated[float, Gt(0)] = Field(
        default=2578.33, description="Encoder ticks per wheel turn."
    )


WHEEL_ODOMETRY = Component(
    spec=WheelOdometrySpec,
    build="crowdbot.plugins.sensors.wheel_odometry_build:build",
    summary="pose and twist integrated from quantised wheel encoders",
)
