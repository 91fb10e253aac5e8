from __future__ import annotations

from collections.abc import Mapping

from crowdbot import Command, Observation, RobotLimits, SensorInfo, Task


class Strafe:
    """Goes straight to the goal without turning towards it."""

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        self.limits = limits

    def step(self, obs: Observation) -> Command:
        dx, dy = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        far = max((dx * dx + dy * dy) ** 0.5, 1e-6)
        speed = min(0.5, self.limits.v_max, self.limits.vy_max)
        return Command(speed * dx / far, 0.0, speed * dy / far)
