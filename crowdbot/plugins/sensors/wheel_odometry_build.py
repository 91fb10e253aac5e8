"""Wheel odometry: encoder ticks of two wheels, integrated by the midpoint rule.

Between two readings the left and right wheel roll s_l and s_r, whole ticks long. The robot turns
by (s_r - s_l) / track and moves (s_l + s_r) / 2 along the heading half-way through the turn, which
is exact on straight lines and second-order on arcs.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pose, SensorInfo
from crowdbot.core.sensing.scene import Scene
from crowdbot.errors import SimulationError
from crowdbot.plugins.sensors.wheel_odometry import WheelOdometrySpec

Array = NDArray[np.float64]

#: Layout of the memory.
STARTED, TIME, LEFT, RIGHT = 0, 1, 2, 3
READING = slice(4, 9)


class WheelOdometry:
    """Reading: x, y (m), yaw (rad, in [-pi, pi]), v (m/s), w (rad/s).

    The frame is the one of the pose at the first reading; v and w are means since the last one.
    """

    def __init__(self, spec: WheelOdometrySpec) -> None:
        self._spec = spec
        self._info = SensorInfo(
            category="odometry",
            frame="odom",
            mount=(0.0, 0.0, 0.0, 0.0),
            rate=spec.rate,
            shape=(5,),
            ros_type="nav_msgs/msg/Odometry",
            memory=READING.stop,
            random=False,
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
        del rng
        if scene.robot is None:
            raise SimulationError("wheel odometry needs a robot in the scene")
        left, right = self._ticks(scene.robot.left_angle), self._ticks(scene.robot.right_angle)
        if memory[STARTED] == 0.0:
            memory[STARTED] = 1.0
            memory[READING] = (pose.x, pose.y, _wrapped(pose.yaw), 0.0, 0.0)
            memory[TIME], memory[LEFT], memory[RIGHT] = t, left, right
        elif t > memory[TIME]:
            memory[READING] = self._advanced(
                memory[READING], left - memory[LEFT], right - memory[RIGHT], t - memory[TIME]
            )
            memory[TIME], memory[LEFT], memory[RIGHT] = t, left, right
        return memory[READING].copy()

    def _ticks(self, angle: float) -> int:
        """What an encoder has counted when its wheel stands at an angle (rad)."""
        return math.floor(angle / (2.0 * math.pi) * self._spec.ticks_per_turn)

    def _advanced(
        self, state: Array, left: float, right: float, dt: float
    ) -> tuple[float, float, float, float, float]:
        metre = 2.0 * math.pi * self._spec.wheel_radius / self._spec.ticks_per_turn
        ahead = (left + right) / 2.0 * metre
        turn = (right - left) * metre / self._spec.track
        x, y, yaw = state[0], state[1], state[2]
        middle = yaw + turn / 2.0
        x, y = x + ahead * math.cos(middle), y + ahead * math.sin(middle)
        return x, y, _wrapped(yaw + turn), ahead / dt, turn / dt


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def build(spec: WheelOdometrySpec) -> WheelOdometry:
    """Wheel odometry from its spec."""
    return WheelOdometry(spec)
