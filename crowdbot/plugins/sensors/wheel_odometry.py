"""Wheel odometry from quantised encoders."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from annotated_types import Ge, Gt

from crowdbot.plugin import (
    Component,
    PositiveFrequency,
    PositiveLength,
    RobotSpec,
    SensorSpec,
    default,
)


class OdometrySpec(SensorSpec):
    """Fields of wheel odometry, with two wheels or three."""

    rate: PositiveFrequency = default(64.0, "Readings per second, Hz.", le=128)
    wheel_radius: PositiveLength | None = default(
        None, "Radius the firmware believes in, m; unset: the robot's."
    )
    track: PositiveLength | None = default(
        None, "Distance between the wheels, m; unset: the robot's."
    )
    ticks_per_turn: Annotated[float, Gt(0)] = default(2578.33, "Encoder ticks per wheel turn.")
    noise: Annotated[float, Ge(0)] = default(
        0.0, "Standard deviation of each wheel's rate, drawn at each reading, rad/s."
    )
    heading: Literal["wheels", "gyro"] = default(
        "wheels", "Where yaw and w come from; a Kobuki can use its gyro."
    )
    gyro_noise: Annotated[float, Ge(0)] = default(
        5.2e-4, "Density of the gyro's noise, rad/s/sqrt(Hz)."
    )

    def on_robot(self, robot: RobotSpec) -> Self:
        """Return odometry with the wheel sizes of the robot's firmware, if its spec gives them."""
        if robot.wheels is None:
            return self
        radius, track = robot.wheels
        return self.model_copy(
            update={
                "wheel_radius": radius if self.wheel_radius is None else self.wheel_radius,
                "track": track if self.track is None else self.track,
            }
        )


class WheelOdometrySpec(OdometrySpec):
    """Reading: x, y (m), yaw (rad), v (m/s), w (rad/s); starts at the task's start pose."""

    kind: Literal["wheel_odometry"] = "wheel_odometry"


class HolonomicOdometrySpec(OdometrySpec):
    """Reading: x, y (m), yaw (rad), v (m/s), w (rad/s), vy (m/s); starts at the start pose.

    A third wheel under the robot's frame rolls sideways, positive to the left.
    """

    kind: Literal["holonomic_odometry"] = "holonomic_odometry"


class BaseOdometrySpec(SensorSpec):
    """Reading: x, y (m), yaw (rad), v (m/s), w (rad/s), vy (m/s): the true ones.

    The second method of the annex of D7.3, which reads the velocity of the base itself; add
    `errors` to make it drift-free but noisy.
    """

    kind: Literal["base_odometry"] = "base_odometry"
    rate: PositiveFrequency = default(64.0, "Readings per second, Hz.", le=128)


BASE_ODOMETRY = Component(
    spec=BaseOdometrySpec,
    build="crowdbot.plugins.sensors.base_odometry_build:build",
    summary="pose and twist of the base as they are, without wheels",
)

WHEEL_ODOMETRY = Component(
    spec=WheelOdometrySpec,
    summary="pose and twist integrated from quantised wheel encoders, or encoders and gyro",
)

HOLONOMIC_ODOMETRY = Component(
    spec=HolonomicOdometrySpec,
    summary="the same for a robot that goes sideways: three measuring wheels, and vy",
)
