from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot import Command, Observation, RobotLimits, SensorInfo, Task

MARGIN = 0.3  # m, kept free ahead


class ShareControl:
    """Does what the driver asks for, but no faster than it can stop before what lidars see."""

    needs = ("joystick", "lidar")

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        assert task.robot is not None
        self.limits, self.robot = limits, task.robot
        self.lidars = {n: i for n, i in sensors.items() if i.category == "lidar"}

    def step(self, obs: Observation) -> Command:
        v, w = obs.readings["joystick"].values
        room = max(0.0, min(self.gap(obs, name) for name in self.lidars) - MARGIN)
        return Command(min(float(v), float(np.sqrt(self.limits.a_max * room))), float(w))

    def gap(self, obs: Observation, lidar: str) -> float:
        """Distance ahead of the robot, m, of the nearest thing in its way as a lidar sees it."""
        info, ranges = self.lidars[lidar], obs.readings[lidar].values
        x0, y0, _, yaw = info.mount
        assert info.angles is not None
        seen = np.isfinite(ranges)
        x = x0 + ranges[seen] * np.cos(info.angles[seen] + yaw)
        y = y0 + ranges[seen] * np.sin(info.angles[seen] + yaw)
        ahead = (np.abs(y) < self.robot.half_width + MARGIN) & (x > self.robot.front)
        return float(np.min(x[ahead], initial=np.inf)) - self.robot.front
