"""Oracle: use the ground truth, generate candidates, and choose the best."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

import crowdbot.plugins.planners.oracle_rollout_build as rollout
from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
    Truth,
)
from crowdbot.plugins.planners.dwa.window_build import candidates
from crowdbot.plugins.planners.goal_seek_build import braking_speed
from crowdbot.plugins.planners.oracle import OracleSpec
from crowdbot.plugins.planners.shared.points_build import nearest_per_sector
from crowdbot.plugins.planners.shared.robot_outline_build import core_of

#: Walls farther away are ignored, m; people too, beyond this plus the distance they may walk.
_REACH = 4.0
_SECTORS = 120
#: A lidar point this near to a person's disc belongs to that person, m.
_OWN = 0.15
_ARRIVED = 0.1


class Oracle:
    """Remembers only its last command."""

    def __init__(self, spec: OracleSpec) -> None:
        self._spec = spec
        self._lidars = LidarPoints({})
        self._limits: RobotLimits | None = None
        self._core, _ = core_of(spec.robot_radius, None)
        self._p: Array = np.zeros(rollout.PARAMETERS)
        self._last = (0.0, 0.0)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        del seed
        self._limits, self._last = limits, (0.0, 0.0)
        self._lidars = LidarPoints(sensors)
        self._core, rounding = core_of(self._spec.robot_radius, task.robot)
        self._p = _parameters(self._spec, limits, rounding)
        people, walls = np.ones((1, 5)), nearest_per_sector(np.ones((1, 2)), _SECTORS, _REACH)
        state = (*task.start, 0.0, 0.0)
        window = self._window(0.0, 0.0, 1.0, 0.0)
        rollout.best(people, walls, self._p, self._core, state, task.goal, window, self._last)

    def step(self, obs: Observation) -> Command:
        """Return the next command; zero at the goal."""
        assert self._limits is not None
        assert obs.truth is not None
        truth = obs.truth
        x, y, yaw = truth.pose
        dx, dy = obs.goal[0] - x, obs.goal[1] - y
        distance = math.hypot(dx, dy)
        if distance <= _ARRIVED:
            self._last = (0.0, 0.0)
            return Command(0.0, 0.0)
        v = truth.velocity[0] * math.cos(yaw) + truth.velocity[1] * math.sin(yaw)
        w = truth.velocity[2]
        top = min(
            self._spec.speed * self._limits.v_max, braking_speed(distance, self._limits.a_max)
        )
        wish = 2.0 * math.remainder(math.atan2(dy, dx) - yaw, 2.0 * math.pi)
        found = self._window(v, w, top, wish)
        people = self._people(truth)
        state = (x, y, yaw, v, w)
        walls = self._walls(obs, truth)
        index, cost = rollout.best(
            people, walls, self._p, self._core, state, obs.goal, found, self._last
        )
        self._last = (float(found[index, 0]), float(found[index, 1])) if index >= 0 else (0.0, 0.0)
        obs.log("oracle/cost", min(cost, 100.0))
        return Command(*self._last)

    def _people(self, truth: Truth) -> Array:
        """Return (N, 5) x, y (m), vx, vy (m/s), radius (m) of people who can come near in time."""
        gone = np.hypot(truth.people_velocity[:, 0], truth.people_velocity[:, 1])
        away = np.hypot(truth.people[:, 0] - truth.pose.x, truth.people[:, 1] - truth.pose.y)
        near = away < _REACH + gone * self._spec.horizon
        return np.column_stack([truth.people, truth.people_velocity, truth.people_radius])[near]

    def _walls(self, obs: Observation, truth: Truth) -> Array:
        """Return (P, 2) lidar points without people, world frame, m."""
        points = nearest_per_sector(
            self._lidars(obs.readings, obs.t, obs.twist, obs.vy), _SECTORS, _REACH
        )
        c, s = math.cos(truth.pose.yaw), math.sin(truth.pose.yaw)
        found = points @ np.array([[c, s], [-s, c]]) + (truth.pose.x, truth.pose.y)
        gap = np.hypot(*(found[:, None] - truth.people).T).T - truth.people_radius
        alone: Array = found[gap.min(axis=1, initial=math.inf) > _OWN]
        return alone

    def _window(self, v: float, w: float, top: float, wish: float) -> Array:
        """Return (C, 2) target velocities that the robot reaches within the window."""
        assert self._limits is not None
        spec, limits = self._spec, self._limits
        dv, dw = limits.a_max * spec.window, limits.alpha_max * spec.window
        low = min(max(v - dv, 0.0), top)
        high = max(min(v + dv, top), low)
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        aim = max(left, min(right, wish))
        return candidates(low, high, spec.speeds, left, right, spec.yaw_rates, aim)


def _parameters(spec: OracleSpec, limits: RobotLimits, rounding: float) -> Array:
    p = np.zeros(rollout.PARAMETERS)
    p[rollout.A_MAX], p[rollout.ALPHA_MAX] = limits.a_max, limits.alpha_max
    p[rollout.V_MAX], p[rollout.W_MAX] = limits.v_max, limits.w_max
    p[rollout.HORIZON], p[rollout.TURN_TIME] = spec.horizon, spec.turn_time
    p[rollout.RADIUS], p[rollout.MARGIN] = rounding, spec.margin
    p[rollout.COMFORT], p[rollout.PROGRESS] = spec.comfort, spec.progress
    p[rollout.CLEARANCE], p[rollout.IMPACT] = spec.clearance, spec.impact
    p[rollout.SMOOTHNESS], p[rollout.HEADING] = spec.smoothness, spec.heading
    return p


def build(spec: OracleSpec) -> Oracle:
    """Build a planner from its spec."""
    return Oracle(spec)
