"""Inertial measurement unit: three gyroscopes and three accelerometers."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, PositiveFrequency, SensorSpec, TiltableMount

NotNegative = Annotated[float, Ge(0)]


class ImuSpec(SensorSpec):
    """Reading: angular rate x, y, z (rad/s) and specific force x, y, z (m/s^2), sensor frame.

    The default noise is from the data sheets of the L3G4200D, the gyroscope of the Kobuki (0.03
    deg/s/sqrt Hz), and of the MPU-6050's accelerometers (400 ug/sqrt Hz).
    """

    kind: Literal["imu"] = "imu"
    mount: TiltableMount = Field(default=TiltableMount(), description="Pose on the robot.")
    rate: PositiveFrequency = Field(default=64.0, le=128, description="Readings per second, Hz.")
    gyro_noise: NotNegative = Field(
        default=5.2e-4, description="Density of the noise of angular rates, rad/s/sqrt(Hz)."
    )
    gyro_bias: NotNegative = Field(
        default=0.0, description="Standard deviation of the bias at the start, rad/s."
    )
    gyro_walk: NotNegative = Field(
        default=0.0, description="Random walk of that bias, rad/s/sqrt(s)."
    )
    force_noise: NotNegative = Field(
        default=3.9e-3, description="Density of the noise of specific force, m/s^2/sqrt(Hz)."
    )
    force_bias: NotNegative = Field(
        default=0.0, description="Standard deviation of the bias at the start, m/s^2."
    )
    force_walk: NotNegative = Field(
        default=0.0, description="Random walk of that bias, m/s^2/sqrt(s)."
    )


IMU = Component(
    spec=ImuSpec,
    summary="angular rate and specific force with noise, bias and bias random walk",
)
