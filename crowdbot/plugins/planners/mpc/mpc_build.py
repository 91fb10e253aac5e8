"""MPC: predicts people, improves the last plan and plans on other sides, drives the best one.

After Brito, Floor, Ferranti, Alonso-Mora, "Model predictive contouring control for collision
avoidance in unstructured dynamic environments", RA-L 4(4), 2019: people are discs that keep their
velocity, free space is convex around each stage, and the goal is a line to follow.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.plugin import Array, Command, Observation, Task
from crowdbot.plugins.planners.mpc.constraints_build import constrain, poses_of
from crowdbot.plugins.planners.mpc.mpc import MpcSpec
from crowdbot.plugins.planners.mpc.problem_build import Problem
from crowdbot.plugins.planners.shared.braking_build import (
    AroundRobot,
    MotionState,
    can_brake,
)
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.optional_build import library
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.starts_build import moved_on, starts
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base, people_near

#: At most this many people are predicted, the nearest.
_PEOPLE = 40


class Mpc(PathPlanner):
    """The MPC planner; remembers its last plan and its time."""

    _problem: Problem  # for the limits of the robot

    def __init__(self, spec: MpcSpec, casadi: Any) -> None:
        super().__init__(spec, leaves=False)
        self._spec, self._casadi = spec, casadi
        self._robot = covering_discs(spec.robot_radius, None)
        self._plan, self._planned = np.zeros((spec.stages, 2)), 0.0
        self._failed = self._braked = 0

    def prepare(self, task: Task, seed: int) -> None:
        """Build the problem for the robot's limits; compile kernels."""
        del seed
        spec, limits = self._spec, self.limits
        self._robot = covering_discs(spec.robot_radius, task.robot)
        self._problem = Problem(self._casadi, spec, limits)
        self._plan, self._planned = np.zeros((spec.stages, self._problem.axes)), 0.0
        self._failed = self._braked = 0
        world = AroundRobot(np.ones((1, 5)), np.ones((1, 2)), self._robot)
        state = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        self._given(world, self._plan, self._state_of(state, (9.0, 0.0), limits.v_max))
        starts(state, (9.0, 0.0), limits, self._plan.shape, self._problem.dt, limits.v_max)
        can_brake(world, state, (0.0, 0.0, 0.0), (limits.a_max, limits.alpha_max), (0.1, 0.1))

    def step(self, obs: Observation) -> Command:
        """Return the beginning of the best plan; zero at the goal."""
        self._plan = moved_on(self._plan, (obs.t - self._planned) / self._problem.dt)
        self._planned = obs.t
        return super().step(obs)

    def interrupted(self, command: Command, *, at_goal: bool) -> Command:
        """Return the command; the plan is to stand."""
        del at_goal
        self._plan[:] = 0.0
        return command

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the beginning of the best plan."""
        pose = scene.pose
        people = people_near(scene, self.limits.v_max, self._spec.horizon, _PEOPLE)
        world = AroundRobot(people, scene.points, self._robot)
        state = (pose.x, pose.y, pose.yaw, *scene.twist)
        command = self._command(world, state, waypoint, top)
        obs.draw("plan", lambda: in_base(pose, self._planned_path(state)))
        obs.log("mpc/failed", self._failed)
        obs.log("mpc/braked", self._braked)
        return command

    def _planned_path(self, state: MotionState) -> Array:
        """Return the positions (T, 2) of the plan from a state, m."""
        return poses_of(state[:3], self._plan, self._problem.dt)[:, :2]

    def _command(
        self, world: AroundRobot, state: MotionState, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the beginning of the new plan, slower where the robot could not stop in time."""
        limits = self.limits
        improved = self._improved(world, state, waypoint, top)
        if improved is None:
            self._failed += 1
            self._plan[:] = 0.0
            return Command(0.0, 0.0)
        self._plan = improved
        v, w, *aside = improved[0].tolist()
        vy = aside[0] if aside else 0.0
        slew, times = (limits.a_max, limits.alpha_max), (self._problem.dt, self._spec.touch)
        for share in (1.0, 0.5, 0.0):
            if can_brake(world, state, (share * v, w, share * vy), slew, times):
                return Command(share * v, w, share * vy)
            self._braked += share == 1.0
        return Command(0.0, 0.0)

    def _improved(
        self, world: AroundRobot, state: MotionState, waypoint: tuple[float, float], top: float
    ) -> Array | None:
        """Return the cheapest plan found by the solver; None if it fails from every start."""
        problem, values = self._problem, self._state_of(state, waypoint, top)
        others = starts(state, waypoint, problem.limits, self._plan.shape, problem.dt, top)
        given = [self._given(world, plan, values) for plan in others]
        costs = [problem.cost(p, g) for p, g in zip(others, given, strict=True)]
        best = int(np.argmin(costs))
        kept = problem.solve(self._plan, self._given(world, self._plan, values))
        new = problem.solve(others[best], given[best])
        if kept is None or new is None:
            one = kept or new
            return None if one is None else one[0]
        return new[0] if new[1] < self._spec.patience * kept[1] else kept[0]

    def _state_of(self, state: MotionState, waypoint: tuple[float, float], top: float) -> Array:
        return np.array([*state, *waypoint, top])

    def _given(self, world: AroundRobot, plan: Array, values: Array) -> Array:
        """Return the optimiser's parameters: the state, and constraints along the last plan."""
        spec = self._spec
        poses = poses_of(tuple(values[:3].tolist()), plan, self._problem.dt)
        margins = spec.margin, spec.margin_growth
        rows = constrain(world, poses, self._problem.dt, margins, spec.neighbours, spec.planes)
        return np.concatenate([values, rows.ravel()])


def build(spec: MpcSpec) -> Mpc:
    """Build a planner from its spec.

    Raises:
        PluginError: CasADi is not installed.
    """
    return Mpc(spec, library("mpc", "casadi", "mpc"))
