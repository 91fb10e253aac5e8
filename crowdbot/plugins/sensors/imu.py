"""Inertial measurement unit: three gyroscopes and three accelerometers."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, PositiveFrequency, SensorSpec, TiltableMount, default

NotNegative = Annotated[float, Ge(0)]


class ImuSpec(SensorSpec):
    """Reading: angular rate x, y, z (rad/s) and specific force x, y, z (m/s^2), sensor frame.

    The default noise is from the data sheets of the L3G4200D, the gyroscope of the Kobuki (0.03
    deg/s/sqrt Hz), and of the MPU-6050's accelerometers (400 ug/sqrt Hz).
    """

    kind: Literal["imu"] = "imu"
    mount: TiltableMount = default(TiltableMount(), "Pose on the robot.")
    rate: PositiveFrequency = default(64.0, "Readings per second, Hz.", le=128)
    gyro_noise: NotNegative = default(
        5.2e-4, "Density of the noise of angular rates, rad/s/sqrt(Hz)."
    )
    gyro_bias: NotNegative = default(0.0, "Standard deviation of the bias at the start, rad/s.")
    gyro_walk: NotNegative = default(0.0, "Random walk of that bias, rad/s/sqrt(s).")
    force_noise: NotNegative = default(
        3.9e-3, "Density of the noise of specific force, m/s^2/sqrt(Hz)."
    )
    force_bias: NotNegative = default(0.0, "Standard deviation of the bias at the start, m/s^2.")
    force_walk: NotNegative = default(0.0, "Random walk of that bias, m/s^2/sqrt(s).")


IMU = Component(
    spec=ImuSpec,
    summary="angular rate and specific force with noise, bias and bias random walk",
)
