"""MPC: predicts people, improves the last plan and plans on other sides, drives the best one.

After Brito, Floor, Ferranti, Alonso-Mora, "Model predictive contouring control for collision
avoidance in unstructured dynamic environments", RA-L 4(4), 2019: people are discs that keep their
velocity, free space is convex around each stage, and the goal is a line to follow.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from crowdbot.plugin import Array, Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
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
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder
from crowdbot.plugins.planners.shared.robot_outline_build import swept_half_width
from crowdbot.plugins.planners.shared.starts_build import moved_on, starts
from crowdbot.plugins.planners.shared.surroundings_build import (
    PlannerSurroundings,
    in_base,
    people_near,
)

_ARRIVED, _BESIDE = 0.1, 0.12
#: At most this many people are predicted, the nearest.
_PEOPLE = 40


class Mpc:
    """The MPC planner; remembers its last plan and its time."""

    def __init__(self, spec: MpcSpec, casadi: Any) -> None:
        self._spec, self._casadi = spec, casadi
        self._surroundings = PlannerSurroundings(spec)
        self._problem: Problem | None = None
        self._robot = covering_discs(spec.robot_radius, None)
        self._path_finder = PathFinder(1.0)
        self._plan, self._planned = np.zeros((spec.stages, 2)), 0.0
        self._failed = self._braked = 0

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Build the problem for the robot's limits; compile kernels."""
        del seed
        spec = self._spec
        self._surroundings.reset(sensors)
        self._robot = covering_discs(spec.robot_radius, task.robot)
        self._path_finder = PathFinder(swept_half_width(spec.robot_radius, task.robot) + _BESIDE)
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
        assert self._problem is not None
        limits = self._problem.limits
        scene = self._surroundings.see(obs)
        pose = scene.pose
        distance, _ = bearing(pose, obs.goal)
        self._plan = moved_on(self._plan, (obs.t - self._planned) / self._problem.dt)
        self._planned = obs.t
        if distance <= _ARRIVED:
            self._plan[:] = 0.0
            return Command(0.0, 0.0)
        top = min(self._spec.speed * limits.v_max, braking_speed(distance, limits.a_max))
        waypoint = self._path_finder.waypoint(obs.t, pose, scene.seen, obs.goal)
        people = people_near(scene, limits.v_max, self._spec.horizon, _PEOPLE)
        world = AroundRobot(people, scene.points, self._robot)
        state = (pose.x, pose.y, pose.yaw, *scene.twist)
        command = self._command(world, state, waypoint, top)
        poses = poses_of((pose.x, pose.y, pose.yaw), self._plan, self._problem.dt)
        obs.draw("plan", in_base(pose, poses[:, :2]))
        obs.log("mpc/failed", self._failed)
        obs.log("mpc/braked", self._braked)
        return command

    def _command(
        self, world: AroundRobot, state: MotionState, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the beginning of the new plan, slower where the robot could not stop in time."""
        assert self._problem is not None
        limits = self._problem.limits
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
        assert self._problem is not None
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
        assert self._problem is not None
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
