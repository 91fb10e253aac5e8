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
        root = math.sqrt(spec.rate)
        self._white = [spec.gyro_noise * root] * 3 + [spec.force_noise * root] * 3
        self._start = [spec.gyro_bias] * 3 + [spec.force_bias] * 3
        self._walk = [spec.gyro_walk] * 3 + [spec.force_walk] * 3
        self._info = SensorInfo(
            category="imu",
            frame="imu",
            mount=mount_of(spec.mount),
            rate=spec.rate,
            shape=(6,),
            ros_type="sensor_msgs/msg/Imu",
            memory=READING.stop,
            random=any(self._white + self._start + self._walk),
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
        was = memory.tolist()  # numpy is far dearer, number by number and six by six
        if was[STARTED] == 0.0 or t > was[TIME]:
            vx, vy, reading = self._felt(scene.robot, pose.yaw, t, was)
            bias = was[BIAS]
            if self._info.random:
                bias, errors = self._errors(t, rng, was)
                reading = [value + error for value, error in zip(reading, errors, strict=True)]
            memory[:] = (1.0, t, pose.yaw, vx, vy, *bias, *reading)
        return memory[READING].copy()

    def _felt(
        self, robot: RobotState, yaw: float, t: float, was: list[float]
    ) -> tuple[float, float, list[float]]:
        """Velocity of the mount, and what a perfect IMU reads."""
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
        c, s = math.cos(heading + mount.yaw), math.sin(heading + mount.yaw)
        return vx, vy, [0.0, 0.0, robot.w, c * ax + s * ay, c * ay - s * ax, GRAVITY]

    def _errors(
        self, t: float, rng: np.random.Generator, was: list[float]
    ) -> tuple[list[float], list[float]]:
        """Biases from now on, and the errors of this reading."""
        draws = rng.standard_normal(12).tolist()
        white, walk = draws[:6], draws[6:]
        if was[STARTED]:
            root = math.sqrt(t - was[TIME])
            steps = zip(was[BIAS], self._walk, walk, strict=True)
            bias = [b + k * root * draw for b, k, draw in steps]
        else:
            bias = [b * draw for b, draw in zip(self._start, walk, strict=True)]
        parts = zip(self._white, white, bias, strict=True)
        return bias, [n * draw + b for n, draw, b in parts]


def build(spec: ImuSpec) -> Imu:
    """An IMU from its spec."""
    return Imu(spec)
