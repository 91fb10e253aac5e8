"""Wall hug: goal seek on a line along the edge of the goal zone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek
from crowdbot.plugins.planners.shared.robot_outline_build import swept_half_width
from crowdbot.plugins.planners.wall_hug import WallHugSpec

#: Distance from the edge to the centre of a narrow robot, and clearance beside a wide one, m.
_GAP, _BESIDE = 0.3, 0.1


class WallHug:
    """Follows a line parallel to the line from start to goal."""

    def __init__(self, spec: WallHugSpec) -> None:
        self._spec = spec
        self._seek = GoalSeek(
            GoalSeekSpec(
                speed=spec.speed, heading_gain=spec.heading_gain, turn_in_place=spec.turn_in_place
            )
        )
        self._origin = (0.0, 0.0)
        self._ahead, self._length = (1.0, 0.0), 0.0

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Set the line from beside the start to beside the goal."""
        self._seek.reset(task, limits, sensors, seed)
        dx, dy = task.goal[0] - task.start.x, task.goal[1] - task.start.y
        self._length = math.hypot(dx, dy)
        along = math.atan2(dy, dx) if self._length else task.start.yaw
        self._ahead = ux, uy = math.cos(along), math.sin(along)
        side = 1.0 if self._spec.side == "left" else -1.0
        nx, ny = -side * uy, side * ux
        reach = max(nx * (x - task.goal[0]) + ny * (y - task.goal[1]) for x, y in task.goal_zone)
        aside = max(0.0, reach - self._gap(task))
        self._origin = task.start.x + aside * nx, task.start.y + aside * ny

    def _gap(self, task: Task) -> float:
        if self._spec.gap is not None:
            return self._spec.gap
        return max(_GAP, swept_half_width(None, task.robot) + _BESIDE)

    def step(self, obs: Observation) -> Command:
        """Return goal seek's command towards a point of the line."""
        (x, y), (ux, uy) = self._origin, self._ahead
        made = (obs.pose.x - x) * ux + (obs.pose.y - y) * uy
        at = min(self._length, max(0.0, made) + self._spec.look_ahead)
        v, w, _ = self._seek.step(replace(obs, goal=(x + at * ux, y + at * uy)))
        return Command(v, w)


build = WallHug
