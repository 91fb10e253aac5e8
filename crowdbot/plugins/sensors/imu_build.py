"""IMU: gyroscopes and accelerometers at the mount, computed from the robot's motion.

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

from crowdbot.plugin import (
    Array,
    Pose,
    Scene,
    SensorInfo,
    SimulationError,
    kernel,
    mount_pose,
    mount_tilt,
    rotation,
)
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.imu import ImuSpec

GRAVITY = 9.81  # m/s^2, the plant's
#: Layout of the memory: offsets of six biases and of a reading of six numbers.
STARTED, TIME, YAW, VX, VY, BIAS, READING = 0, 1, 2, 3, 4, 5, 11
_SIZE = 6
_NO_DRAWS = np.zeros(0)


class Imu(DescribedSensor):
    """Reading: angular rate (3) and specific force (3) in the axes of the mount."""

    def __init__(self, spec: ImuSpec) -> None:
        self._mount = spec.mount
        root = math.sqrt(spec.rate)
        noise = (
            (spec.gyro_noise * root, spec.force_noise * root),
            (spec.gyro_bias, spec.force_bias),
            (spec.gyro_walk, spec.force_walk),
        )
        self._noise = np.repeat(noise, 3, axis=1)
        self._info = SensorInfo(
            category="imu",
            frame="imu",
            mount=mount_pose(spec.mount),
            rate=spec.rate,
            shape=(6,),
            ros_type="sensor_msgs/msg/Imu",
            memory=READING + _SIZE,
            random=bool(np.any(self._noise)),
            deviations=(
                math.hypot(spec.gyro_noise * root, spec.gyro_bias),
                math.hypot(spec.force_noise * root, spec.force_bias),
            ),
            sees=False,
            tilt=mount_tilt(spec.mount),
        )
        self._axes = rotation(*self._info.tilt, 0.0)

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Return angular rate and specific force; two readings at the same time are equal.

        Raises:
            SimulationError: the scene has no robot.
        """
        if scene.robot is None:
            raise SimulationError("an IMU needs a robot in the scene")
        if memory[STARTED] == 0.0 or t > memory[TIME]:
            robot, mount = scene.robot, self._mount
            draws = rng.standard_normal(2 * _SIZE) if self._info.random else _NO_DRAWS
            _feel(
                memory, t, pose.yaw, robot.vx, robot.vy, robot.w,
                mount.x, mount.y, mount.yaw, self._axes, self._noise, draws,
            )  # fmt: skip
        return memory[READING:].copy()


@kernel
def _feel(
    memory: Array, t: float, yaw: float, robot_vx: float, robot_vy: float, w: float,
    mount_x: float, mount_y: float, mount_yaw: float, axes: Array, noise: Array, draws: Array,
) -> None:  # fmt: skip
    """Advance the memory to time t.

    Args:
        axes: (3, 3) the mount's axes as columns, in a level frame with its yaw.
        noise: (3, 6) standard deviations of white noise, of the biases at the start, and of their
            change in one second.
        draws: (12,) normal numbers for the white noise and for the biases; none: no noise.
    """
    started, dt = memory[STARTED] != 0.0, t - memory[TIME]
    c, s = math.cos(yaw), math.sin(yaw)
    x, y = c * mount_x - s * mount_y, s * mount_x + c * mount_y
    vx, vy = robot_vx - w * y, robot_vy + w * x
    ax = ay = 0.0
    heading = yaw
    if started:
        ax, ay = (vx - memory[VX]) / dt, (vy - memory[VY]) / dt
        heading -= 0.5 * _turn(yaw - memory[YAW])
    c, s = math.cos(heading + mount_yaw), math.sin(heading + mount_yaw)
    felt = (0.0, 0.0, float(w), c * ax + s * ay, c * ay - s * ax, GRAVITY)
    level = axes[2, 2] == 1.0
    for k in range(_SIZE):
        along, first = k % 3, k - k % 3
        memory[READING + k] = (
            felt[k]
            if level
            else (
                axes[0, along] * felt[first]
                + axes[1, along] * felt[first + 1]
                + axes[2, along] * felt[first + 2]
            )
        )
        if draws.shape[0]:
            bias = noise[1, k] * draws[_SIZE + k]
            if started:
                bias = memory[BIAS + k] + noise[2, k] * math.sqrt(dt) * draws[_SIZE + k]
            memory[BIAS + k] = bias
            memory[READING + k] += noise[0, k] * draws[k] + bias
    memory[STARTED], memory[TIME], memory[YAW] = 1.0, t, yaw
    memory[VX], memory[VY] = vx, vy


@kernel
def _turn(angle: float) -> float:
    """Return the turn between two headings that differ by ``angle``, from -pi to pi, rad."""
    if angle > math.pi:
        return angle - 2.0 * math.pi
    return angle + 2.0 * math.pi if angle < -math.pi else angle


build = Imu.from_spec
