"""IMU: what gyroscopes and accelerometers at its mount feel of the robot's motion.

Specific force is the acceleration of the mount minus gravity: at rest it is +g upwards. The
acceleration is the mean since the last reading: the difference of the mount's velocities, seen
from the heading half-way, which is exact in a steady turn up to (w dt)^2 / 24. The robot's tilt,
hundredths of a degree, is left out.

Noise after Woodman, "An introduction to inertial navigation", UCAM-CL-TR-696 (2007), section 3.2:
white noise of density n at a rate f has the standard deviation n sqrt(f); a bias walks by
k sqrt(dt) from one reading to the next.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pose, RobotState, SensorInfo
from crowdbot.core.sensing.place import mount_of
from crowdbot.core.sensing.scene import Scene
from crowdbot.errors import SimulationError
from crowdbot.plugins.sensors.imu import ImuSpec

Array = NDArray[np.float64]

GRAVITY = 9.81  # m/s^2, the plant's
#: Layout of the memory.
STARTED, TIME, YAW, VX, VY = range(5)
BIAS, READING = slice(5, 11), slice(11, 17)


class Imu:
    """Reading: angular rate (3) and specific force (3) in the axes of the mount."""

    def __init__(self, spec: ImuSpec) -> None:
        self._mount, self._rate = spec.mount, spec.rate
        gyro, force = (
            np.repeat([[1.0], [0.0]], 3, 1).ravel(),
            np.repeat([[0.0], [1.0]], 3, 1).ravel(),
        )
        self._white = (spec.gyro_noise * gyro + spec.force_noise * force) * math.sqrt(spec.rate)
        self._start = spec.gyro_bias * gyro + spec.force_bias * force
        self._walk = spec.gyro_walk * gyro + spec.force_walk * force
        self._info = SensorInfo(
            category="imu",
            frame="imu",
            mount=mount_of(spec.mount),
            rate=spec.rate,
            shape=(6,),
            ros_type="sensor_msgs/msg/Imu",
            memory=READING.stop,
            random=bool(np.any(self._white + self._start + self._walk)),
            sees=False,
        )

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Angular rate and specific force; reading twice at one instant gives the same.

        Raises:
            SimulationError: the scene has no robot.
        """
        if scene.robot is None:
            raise SimulationError("an IMU needs a robot in the scene")
        was = memory[: BIAS.start].tolist()  # far cheaper than number by number
        if was[STARTED] == 0.0 or t > was[TIME]:
            memory[READING] = self._felt(scene.robot, pose.yaw, t, was, memory)
            if self._info.random:
                memory[READING] += self._errors(t, rng, was, memory)
        return memory[READING].copy()

    def _felt(
        self, robot: RobotState, yaw: float, t: float, was: list[float], memory: Array
    ) -> Array:
        """What a perfect IMU reads; remembers time, heading and velocity."""
        mount = self._mount
        c, s = math.cos(yaw), math.sin(yaw)
        x, y = c * mount.x - s * mount.y, s * mount.x + c * mount.y
        vx, vy = robot.vx - robot.w * y, robot.vy + robot.w * x
        ax = ay = 0.0
        heading = yaw
        if was[STARTED]:
            dt = t - was[TIME]
            ax, ay = (vx - was[VX]) / dt, (vy - was[VY]) / dt
            heading -= 0.5 * math.remainder(yaw - was[YAW], 2.0 * math.pi)
        memory[: BIAS.start] = 1.0, t, yaw, vx, vy
        c, s = math.cos(heading + mount.yaw), math.sin(heading + mount.yaw)
        return np.array([0.0, 0.0, robot.w, c * ax + s * ay, c * ay - s * ax, GRAVITY])

    def _errors(self, t: float, rng: np.random.Generator, was: list[float], memory: Array) -> Array:
        draws = rng.standard_normal((2, 6))
        if was[STARTED]:
            memory[BIAS] += self._walk * math.sqrt(t - was[TIME]) * draws[1]
        else:
            memory[BIAS] = self._start * draws[1]
        errors: Array = self._white * draws[0] + memory[BIAS]
        return errors


def build(spec: ImuSpec) -> Imu:
    """An IMU from its spec."""
    return Imu(spec)
