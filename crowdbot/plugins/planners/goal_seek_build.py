"""Goal seek: heading control with a braking ramp before the goal."""

from __future__ import annotations

import math
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, Pose, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec


class GoalSeek:
    """Turns towards the goal while driving and brakes in time."""

    _limits: RobotLimits  # from `reset` on

    def __init__(self, spec: GoalSeekSpec) -> None:
        self._spec = spec

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the robot's limits."""
        del task, sensors, seed
        self._limits = limits

    def step(self, obs: Observation) -> Command:
        """Return the next command; zero at the goal."""
        spec = self._spec
        distance, error = bearing(obs.pose, obs.goal)
        obs.draw(
            "aim", lambda: [[0.0, 0.0], [distance * math.cos(error), distance * math.sin(error)]]
        )
        if distance <= spec.tolerance:
            return Command(0.0, 0.0)
        w = max(-self._limits.w_max, min(self._limits.w_max, spec.heading_gain * error))
        if abs(error) > spec.turn_in_place:
            return Command(0.0, w)
        cruise = spec.speed * self._limits.v_max * math.cos(error)
        return Command(min(max(cruise, 0.0), braking_speed(distance, self._limits.a_max)), w)


def bearing(pose: Pose, goal: tuple[float, float]) -> tuple[float, float]:
    """Return the distance to a point (m) and the angle from heading to it (rad, in [-pi, pi])."""
    dx, dy = goal[0] - pose.x, goal[1] - pose.y
    return math.hypot(dx, dy), math.remainder(math.atan2(dy, dx) - pose.yaw, 2.0 * math.pi)


def braking_speed(room: float, deceleration: float) -> float:
    """Return the speed from which the robot can stop within ``room`` m."""
    return math.sqrt(2.0 * deceleration * max(room, 0.0))


build = GoalSeek
