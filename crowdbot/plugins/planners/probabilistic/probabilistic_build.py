"""Probabilistic shared control: the command with the most likely path.

Trautman, "Assistive planning in complex, dynamic environments: a probabilistic approach", 2015,
arXiv:1506.06784, after Trautman, Ma, Murray, Krause, International Journal of Robotics Research
34(3), 2015: p(h, f, people) ~ psi(h, f) p(h | user) p(f | robot) psi(f, people) p(people). User and
people are integrated out here, and the maximum is taken over the paths of some commands.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Command, Observation, Planner, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.dwa.window_build import candidates
from crowdbot.plugins.planners.probabilistic import joint_build as joint
from crowdbot.plugins.planners.probabilistic.probabilistic import ProbabilisticSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.robot_outline_build import half_width_and_front
from crowdbot.plugins.planners.shared.surroundings_build import PlannerSurroundings, bodies_in_base
from crowdbot.plugins.planners.shared.user_input_build import UserInput

#: Shares of the commands of user and planner that are candidates.
_SHARES = np.array([1.0, 0.75, 0.5, 0.25])[:, None]


class Probabilistic:
    """Chooses the most likely path, given the user, another planner and the crowd."""

    _limits: RobotLimits  # from `reset` on

    def __init__(self, spec: ProbabilisticSpec, half: Planner) -> None:
        self._spec, self._half = spec, half
        self._user, self._surroundings = UserInput(), PlannerSurroundings(spec)
        self._robot = covering_discs(spec.robot_radius, None)
        self._p: Array = np.zeros(joint.PARAMETERS)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits and outline, reset the other planner; compile kernels."""
        spec = self._spec
        self._user.reset(sensors, limits)
        self._surroundings.reset(sensors)
        self._robot = covering_discs(spec.robot_radius, task.robot)
        self._limits = limits
        _, front = half_width_and_front(spec.robot_radius, task.robot)
        self._p = np.array(
            [spec.horizon, spec.agreeability, spec.user_spread, spec.robot_spread,
             spec.people_spread, spec.avoidance, spec.safety, front, limits.a_max,
             limits.alpha_max, spec.standing]
        )  # fmt: skip
        one = np.ones(3)
        candidates(0.0, 1.0, 2, -1.0, 1.0, 2, 0.0)
        joint.log_densities(np.ones((1, 3)), one, one, np.ones((1, 5)), self._robot, one, self._p)
        self._half.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the command of the most likely path."""
        user, planner = np.array(self._user.command(obs)), np.array(self._half.step(obs))
        scene = self._surroundings.see(obs)
        ways = self._candidates(scene.twist, user, planner)
        density = joint.log_densities(
            ways,
            user,
            planner,
            bodies_in_base(scene),
            self._robot,
            np.array(scene.twist, np.float64),
            self._p,
        )
        best = int(np.argmax(density))
        obs.log("probabilistic/log_density", float(density[best]))
        return Command(*ways[best].tolist())

    def _candidates(self, twist: tuple[float, float, float], user: Array, planner: Array) -> Array:
        """Return (C, 3) commands: of user and planner, slowed, blended, and those within reach."""
        spec, limits = self._spec, self._limits
        v, w, _ = twist
        dv, dw = limits.a_max * spec.window, limits.alpha_max * spec.window
        speeds = (0.0, float(user[0]), float(planner[0]))  # no flight that no one asks for
        low = min(max(v - dv, limits.v_min, min(speeds)), limits.v_max)
        high = max(min(v + dv, limits.v_max, max(speeds)), low)
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        grid = candidates(
            low, high, spec.speeds, left, right, spec.yaw_rates, min(max(user[1], left), right)
        )
        reachable = np.column_stack([grid, np.zeros(len(grid))])
        blends = _SHARES * user + (1.0 - _SHARES) * planner
        slowed = [_SHARES * user, _SHARES * planner, np.zeros((1, 3))]
        return np.ascontiguousarray(np.concatenate([*slowed, blends, reachable]))


build = Probabilistic
