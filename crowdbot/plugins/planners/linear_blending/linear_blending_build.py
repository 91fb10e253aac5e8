"""Linear blending of commands.

Dragan, Srinivasa, "A policy-blending formalism for shared control", International Journal of
Robotics Research 32(7), 2013: the robot does (1 - a) U + a P for the user's U, the prediction's
policy P and an arbitration a; their confidence falls linearly with the distance to the goal.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, Planner, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.linear_blending.linear_blending import LinearBlendingSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.stopping_build import arc_gap_moving, compile_stopping
from crowdbot.plugins.planners.shared.surroundings_build import PlannerSurroundings, bodies_in_base
from crowdbot.plugins.planners.shared.user_input_build import UserInput


class LinearBlending:
    """Blends the commands of the user and of another planner."""

    def __init__(self, spec: LinearBlendingSpec, half: Planner) -> None:
        self._spec, self._half = spec, half
        self._user, self._surroundings = UserInput(), PlannerSurroundings(spec)
        self._robot = covering_discs(spec.robot_radius, None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the outline, reset the other planner; compile kernels."""
        self._user.reset(sensors, limits)
        self._surroundings.reset(sensors)
        self._robot = covering_discs(self._spec.robot_radius, task.robot)
        compile_stopping()
        self._half.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the blended command."""
        user, robot = self._user.command(obs), self._half.step(obs)
        share = self._share(obs, user)
        obs.log("linear_blending/share", share)
        return Command(*((1.0 - share) * u + share * r for u, r in zip(user, robot, strict=True)))

    def _share(self, obs: Observation, user: Command) -> float:
        """Return the planner's share, from 0 to 1."""
        spec = self._spec
        if spec.arbitration == "fixed":
            return spec.share
        if spec.arbitration == "goal":
            away = math.hypot(obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y)
        else:
            bodies = bodies_in_base(self._surroundings.see(obs))
            away = arc_gap_moving(bodies, self._robot, user.v, user.w, spec.look_ahead, math.inf)
        near = (spec.distance - away) / (spec.distance - spec.full_distance)
        return spec.least + (spec.most - spec.least) * min(1.0, max(0.0, near))


build = LinearBlending
