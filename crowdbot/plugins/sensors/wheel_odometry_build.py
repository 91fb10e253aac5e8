"""Wheel odometry: encoder ticks of two or three wheels, integrated by the midpoint rule.

Between two readings the left and right wheels roll s_l and s_r, in whole ticks. The robot turns by
(s_r - s_l) / track and moves (s_l + s_r) / 2 along the heading half-way through the turn, which is
exact on straight lines and second-order on arcs. A holonomic robot has a third wheel, which rolls
s_s to the left of that heading. With ``heading: gyro`` the turn is measured by a gyro, whose noise
density n adds n sqrt(dt) (Woodman 2007, section 3.2.1).

``noise`` adds a new random draw to the rate of a wheel's apparent rotation between readings; the
encoders count the apparent rotation.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Pose, Scene, SensorContext, SensorInfo, SimulationError, kernel
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.wheel_odometry import HolonomicOdometrySpec, WheelOdometrySpec

#: Layout of the memory: offsets of three errors (rad) and of a reading of six numbers.
STARTED, TIME, LEFT, RIGHT, SIDE, YAW, ERRORS, READING = 0, 1, 2, 3, 4, 5, 6, 9
_SIZE = 15
_NO_DRAWS = np.zeros(0)


class WheelOdometry(DescribedSensor):
    """Reading: x, y (m), yaw (rad, in [-pi, pi]), v (m/s), w (rad/s), and perhaps vy (m/s).

    The frame is that of the pose at the first reading; velocities are means since the last one.
    """

    def __init__(
        self, spec: WheelOdometrySpec | HolonomicOdometrySpec, context: SensorContext
    ) -> None:
        self._gyro = spec.heading == "gyro"
        radius, track = context.robot.wheels
        radius, track = spec.wheel_radius or radius, spec.track or track
        metre = 2.0 * math.pi * radius / spec.ticks_per_turn
        self._numbers = (
            self._gyro, float(spec.ticks_per_turn), metre, track, spec.noise, spec.gyro_noise,
        )  # fmt: skip
        self._sideways = isinstance(spec, HolonomicOdometrySpec)
        self._info = SensorInfo(
            category="odometry",
            frame="odom",
            mount=(0.0, 0.0, 0.0, 0.0),
            rate=spec.rate,
            shape=(6 if self._sideways else 5,),
            ros_type="nav_msgs/msg/Odometry",
            memory=_SIZE,
            random=spec.noise > 0.0 or (self._gyro and spec.gyro_noise > 0.0),
            deviations=(
                0.0,
                0.0,
                spec.gyro_noise if self._gyro else 0.0,
                spec.noise * radius / math.sqrt(2.0),
                spec.noise * radius if self._sideways else 0.0,
                0.0 if self._gyro else spec.noise * radius * math.sqrt(2.0) / track,
            ),
            sees=False,
        )

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Return pose and twist; two readings at the same time are equal.

        Raises:
            SimulationError: the scene has no robot.
        """
        if scene.robot is None:
            raise SimulationError("wheel odometry needs a robot in the scene")
        if memory[STARTED] == 0.0 or t > memory[TIME]:
            robot, draws = scene.robot, _NO_DRAWS
            if self._info.random and memory[STARTED] != 0.0:
                draws = rng.standard_normal(4 if self._sideways else 3)
            _roll(
                memory, t, pose.x, pose.y, pose.yaw,
                robot.left_angle, robot.right_angle, robot.side_angle, *self._numbers, draws,
            )  # fmt: skip
        return memory[READING : READING + self._info.shape[0]].copy()


@kernel
def _roll(
    memory: Array, t: float, x: float, y: float, yaw: float,
    left_angle: float, right_angle: float, side_angle: float,
    gyro: bool, ticks: float, metre: float, track: float, noise: float, gyro_noise: float,
    draws: Array,
) -> None:  # fmt: skip
    """Advance the memory to time t.

    Args:
        ticks, metre: an encoder's ticks per turn, and its wheel's distance per tick, m.
        draws: normal numbers for the errors of the left wheel, the right wheel, the turn and, for a
            holonomic robot, the third wheel; empty: no noise.
    """
    dt, turned = t - memory[TIME], 0.0
    if memory[STARTED] != 0.0:
        turned = _wrapped(yaw - memory[YAW])
        if draws.shape[0]:
            memory[ERRORS] += noise * dt * draws[0]
            memory[ERRORS + 1] += noise * dt * draws[1]
            if draws.shape[0] > 3:
                memory[ERRORS + 2] += noise * dt * draws[3]
            turned += gyro_noise * math.sqrt(dt) * draws[2]
    left = _count(left_angle + memory[ERRORS], ticks)
    right = _count(right_angle + memory[ERRORS + 1], ticks)
    side = _count(side_angle + memory[ERRORS + 2], ticks)
    if memory[STARTED] != 0.0:
        rolled_left, rolled_right = left - memory[LEFT], right - memory[RIGHT]
        ahead, aside = (rolled_left + rolled_right) / 2.0 * metre, (side - memory[SIDE]) * metre
        turn = turned if gyro else (rolled_right - rolled_left) * metre / track
        middle = memory[READING + 2] + turn / 2.0
        c, s = math.cos(middle), math.sin(middle)
        memory[READING] = memory[READING] + ahead * c - aside * s
        memory[READING + 1] = memory[READING + 1] + ahead * s + aside * c
        memory[READING + 2] = _wrapped(memory[READING + 2] + turn)
        memory[READING + 3], memory[READING + 4] = ahead / dt, turn / dt
        memory[READING + 5] = aside / dt
    else:
        memory[READING], memory[READING + 1], memory[READING + 2] = x, y, _wrapped(yaw)
    memory[STARTED], memory[TIME], memory[YAW] = 1.0, t, yaw
    memory[LEFT], memory[RIGHT], memory[SIDE] = left, right, side


@kernel
def _count(angle: float, ticks: float) -> float:
    """Return an encoder's count when its wheel is at an angle (rad)."""
    return float(math.floor(angle / (2.0 * math.pi) * ticks))


@kernel
def _wrapped(angle: float) -> float:
    """Return the same direction from -pi to pi, rad."""
    while angle > math.pi:
        angle -= 2.0 * math.pi
    while angle < -math.pi:
        angle += 2.0 * math.pi
    return angle


build = WheelOdometry
