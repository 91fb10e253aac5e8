"""Wheel odometry: encoder ticks of two or three wheels, integrated by the midpoint rule.

Between two readings the left and right wheel roll s_l and s_r, whole ticks long. The robot turns
by (s_r - s_l) / track and moves (s_l + s_r) / 2 along the heading half-way through the turn, which
is exact on straight lines and second-order on arcs. A holonomic robot has a third wheel, which
rolls s_s to the left of that heading. With ``heading: gyro`` the turn is the one that a gyro
measures, whose noise of density n adds n sqrt(dt) (Woodman 2007, section 3.2.1).

``noise`` makes a wheel seem to turn faster or slower by as much as a draw says, anew from one
reading to the next; the encoders count what the wheels seem to do.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pose, SensorInfo
from crowdbot.core.sensing.scene import Scene
from crowdbot.errors import SimulationError
from crowdbot.plugins.sensors.wheel_odometry import (
    HolonomicOdometrySpec,
    WheelOdometrySpec,
)

Array = NDArray[np.float64]

#: Layout of the memory.
STARTED, TIME, LEFT, RIGHT, SIDE, YAW = range(6)
ERRORS, READING = slice(6, 9), slice(9, 15)


class WheelOdometry:
    """Reading: x, y (m), yaw (rad, in [-pi, pi]), v (m/s), w (rad/s), and perhaps vy (m/s).

    The frame is the one of the pose at the first reading; velocities are means since the last one.
    """

    def __init__(self, spec: WheelOdometrySpec | HolonomicOdometrySpec) -> None:
        self._spec = spec
        self._gyro = spec.heading == "gyro"
        self._sideways = isinstance(spec, HolonomicOdometrySpec)
        self._info = SensorInfo(
            category="odometry",
            frame="odom",
            mount=(0.0, 0.0, 0.0, 0.0),
            rate=spec.rate,
            shape=(6 if self._sideways else 5,),
            ros_type="nav_msgs/msg/Odometry",
            memory=READING.stop,
            random=spec.noise > 0.0 or (self._gyro and spec.gyro_noise > 0.0),
            sees=False,
        )

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Pose and twist; reading twice at one instant gives the same.

        Raises:
            SimulationError: the scene has no robot.
        """
        if scene.robot is None:
            raise SimulationError("wheel odometry needs a robot in the scene")
        # A list is far cheaper than an array, number by number.
        started, then, left_before, right_before, side_before, yaw = memory[: ERRORS.start].tolist()
        dt = t - then
        reading = memory[READING][: self._info.shape[0]]
        if started and dt <= 0.0:
            return reading.copy()
        turned = math.remainder(pose.yaw - yaw, 2.0 * math.pi)
        if started and self._info.random:
            draws = rng.standard_normal(4 if self._sideways else 3)
            memory[ERRORS][: len(draws) - 1] += self._spec.noise * dt * np.delete(draws, 2)
            turned += self._spec.gyro_noise * math.sqrt(dt) * draws[2]
        left_error, right_error, side_error = memory[ERRORS].tolist()
        left = self._ticks(scene.robot.left_angle + left_error)
        right = self._ticks(scene.robot.right_angle + right_error)
        side = self._ticks(scene.robot.side_angle + side_error)
        if started:
            ways = left - left_before, right - right_before, side - side_before
            memory[READING] = self._advanced(memory[READING].tolist(), *ways, turned, dt)
        else:
            memory[READING] = (pose.x, pose.y, _wrapped(pose.yaw), 0.0, 0.0, 0.0)
        memory[: ERRORS.start] = 1.0, t, left, right, side, pose.yaw
        return reading.copy()

    def _ticks(self, angle: float) -> int:
        """What an encoder has counted when its wheel stands at an angle (rad)."""
        return math.floor(angle / (2.0 * math.pi) * self._spec.ticks_per_turn)

    def _advanced(
        self, state: list[float], left: float, right: float, side: float, turned: float, dt: float
    ) -> tuple[float, float, float, float, float, float]:
        metre = 2.0 * math.pi * self._spec.wheel_radius / self._spec.ticks_per_turn
        ahead, aside = (left + right) / 2.0 * metre, side * metre
        turn = turned if self._gyro else (right - left) * metre / self._spec.track
        x, y, yaw, *_ = state
        middle = yaw + turn / 2.0
        x, y = x + ahead * math.cos(middle), y + ahead * math.sin(middle)
        x, y = x - aside * math.sin(middle), y + aside * math.cos(middle)
        return x, y, _wrapped(yaw + turn), ahead / dt, turn / dt, aside / dt


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def build(spec: WheelOdometrySpec | HolonomicOdometrySpec) -> WheelOdometry:
    """Wheel odometry from its spec."""
    return WheelOdometry(spec)
