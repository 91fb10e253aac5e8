"""Odometry from the true velocity of the base."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Pose, Scene, SensorInfo, SimulationError
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.wheel_odometry import BaseOdometrySpec


class BaseOdometry(DescribedSensor):
    """Reading: (6,) x, y, yaw, v, w, vy; m, rad, m/s, rad/s; vy to the left."""

    def __init__(self, spec: BaseOdometrySpec) -> None:
        self._info = SensorInfo(
            category="odometry",
            frame="odom",
            mount=(0.0, 0.0, 0.0, 0.0),
            rate=spec.rate,
            shape=(6,),
            ros_type="nav_msgs/msg/Odometry",
            random=False,
            sees=False,
        )

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return pose and twist of the base.

        Raises:
            SimulationError: the scene has no robot.
        """
        del t, rng
        robot = scene.robot
        if robot is None:
            raise SimulationError("odometry needs a robot in the scene")
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        ahead, aside = c * robot.vx + s * robot.vy, c * robot.vy - s * robot.vx
        yaw = math.remainder(pose.yaw, 2.0 * math.pi)
        return np.array([pose.x, pose.y, yaw, ahead, robot.w, aside])


build = BaseOdometry.from_spec
