"""A planner for pictures: it sways and hardly brakes, so that metrics have something to tell."""

from __future__ import annotations

import math
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task


class Sidestep:
    """Sways on its way to the goal where a person is near; backs off once."""

    needs = ("lidar",)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Remember the limits."""
        del task, sensors, seed
        self.limits = limits

    def step(self, obs: Observation) -> Command:
        """One command."""
        near = min(float(r.values.min()) for r in obs.readings.values())
        bearing = math.atan2(obs.goal[1] - obs.pose.y, obs.goal[0] - obs.pose.x)
        sway = 0.45 * min(1.0, max(0.0, 1.7 - near)) * math.sin(0.9 * obs.t)
        turn = math.remainder(bearing + sway - obs.pose.yaw, math.tau)
        if 10.0 <= obs.t < 11.5:  # so that there is something to see of a way that is lost
            return Command(-0.4 * self.limits.v_max, 0.0)
        speed = self.limits.v_max * min(1.0, max(0.5, (near - 0.12) / 0.7))
        return Command(speed, 1.6 * turn)
