"""DWA: perceive, choose a direction, choose a velocity of the dynamic window.

The textbook's part is this file with `window_build`, `rollouts_build`, `cost_build` and
`direction_build`; `scene_build` makes moving points of lidar scans. The behaviour of a robot
without progress is in ``dead_ends``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Observation,
    Pose,
    Reading,
    RobotBody,
    RobotLimits,
    SensorInfo,
    Task,
    immutable,
)
from crowdbot.plugins.planners.dwa.cost_build import evaluate
from crowdbot.plugins.planners.dwa.dead_ends.dead_ends_build import DeadEnds, Detour, compile_map
from crowdbot.plugins.planners.dwa.dead_ends.lidar_views_build import LidarViews
from crowdbot.plugins.planners.dwa.dead_ends.manoeuvring_build import Manoeuvring
from crowdbot.plugins.planners.dwa.direction_build import choose_direction
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from crowdbot.plugins.planners.dwa.parameters_build import PARAMETERS, PERIOD, parameters_of
from crowdbot.plugins.planners.dwa.rollouts_build import STEP
from crowdbot.plugins.planners.dwa.scene_build import REACH, PerceivedScene
from crowdbot.plugins.planners.dwa.window_build import candidates, candidates_aside
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.heading_by_walls_build import HeadingByWalls, compile_heading
from crowdbot.plugins.planners.shared.near_points_build import NearPoints
from crowdbot.plugins.planners.shared.robot_outline_build import (
    core_of,
    disc_radius,
    swept_half_width,
)
from crowdbot.plugins.planners.shared.stuck_build import Stuck, compile_stuck

_ARRIVED = 0.1
#: A direction must be wider than the margin by this, m; that of a robot with an outline, which is
#: as wide only if it heads there, by this.
_LEEWAY, _OUTLINED_LEEWAY = 0.05, 0.01
#: Speed of the way back out of a dead end, m/s.
_REVERSE = -0.2


class Dwa:
    """The DWA planner; remembers its last choice.

    `PerceivedScene` remembers scans and `DeadEnds` a small map.
    """

    _limits: RobotLimits  # from `reset` on

    def __init__(self, spec: DwaSpec) -> None:
        self._spec = spec
        self._lidars, self._near = LidarPoints({}), NearPoints({})
        self._core, _ = core_of(spec.robot_radius, None)
        self._half_width = disc_radius(spec.robot_radius, None)
        self._reach = self._half_width
        self._sideways = False
        self._manoeuvring: Manoeuvring | None = None
        self._p: Array = np.zeros(PARAMETERS)
        self._sensors: Mapping[str, SensorInfo] = {}
        self._body: RobotBody | None = None
        self._forget()

    def _forget(self) -> None:
        self._stuck = Stuck(self._spec.robot_radius, self._body, self._sensors)
        self._heading_by_walls = HeadingByWalls()
        self._scene = PerceivedScene(self._spec, splits=self._manoeuvring is not None)
        self._dead_ends = DeadEnds(
            self._spec, self._half_width, self._reach,
            outlined=len(self._core) > 0, manoeuvring=self._manoeuvring,
        )  # fmt: skip
        self._last = (0.0, 0.0, 0.0)
        self._heading: float | None = None
        self._time: float | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        del seed
        spec = self._spec
        self._limits, self._body, self._sensors = limits, task.robot, sensors
        self._lidars, self._near = LidarPoints(sensors), NearPoints(sensors)
        self._half_width = swept_half_width(spec.robot_radius, task.robot)
        self._core, rounding = core_of(spec.robot_radius, task.robot)
        self._sideways = limits.vy_max > 0.0
        self._reach = disc_radius(spec.robot_radius, task.robot)
        self._p = parameters_of(spec, limits, rounding, self._reach)
        long = len(self._core) > 0 and not self._sideways  # it does not fit in every heading
        views, person = LidarViews(sensors), spec.person_radius
        made = Manoeuvring(self._core, self._p, limits, views, person, REACH) if long else None
        self._manoeuvring = made
        self._forget()
        self._warm_up(task, sensors)
        self._forget()

    def _warm_up(self, task: Task, sensors: Mapping[str, SensorInfo]) -> None:
        """Run two steps in a made-up world, so that no step of the run waits for compilation."""
        compile_map()
        compile_heading()
        compile_stuck()
        for t in (0.0, self._spec.look_back):
            readings = {
                n: Reading(t, immutable(np.full(s.shape, 1.0 + t))) for n, s in sensors.items()
            }
            self.step(
                Observation(
                    t=t,
                    pose=Pose(0.0, 0.0, 0.0),
                    twist=(0.0, 0.0),
                    goal=(9.0, 0.0),
                    goal_zone=task.goal_zone,
                    readings=readings,
                )
            )

    def step(self, obs: Observation) -> Command:
        """Return the next command, and draw where it leads; zero at the goal."""
        command = self._command(obs)
        obs.draw("plan", lambda: self._path(command))
        return command

    def _path(self, command: Command) -> Array:
        """Return where a command leads within the horizon, (T, 2), m."""
        turning, steps = round(self._spec.turn_time / STEP), round(self._spec.horizon / STEP)
        rows = np.empty((max(steps, 1), 3))
        rows[:] = command
        rows[turning:, 1] = 0.0
        return driven(rows, STEP)

    def _command(self, obs: Observation) -> Command:
        """Return the next command; zero at the goal."""
        seen = self._lidars(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._heading_by_walls.pose(obs.pose, seen)
        if len(self._near):
            seen = np.concatenate([seen, self._near(obs, seen)])
        pose, seen = self._stuck.see(obs, pose, seen)
        distance, goal = bearing(pose, obs.goal)
        period = 1.0 / 16.0 if self._time is None else max(1e-3, obs.t - self._time)
        self._time = obs.t
        self._p[PERIOD] = period
        if distance <= _ARRIVED:
            return Command(0.0, 0.0)
        points, velocities = self._scene.see(obs.t, pose, seen, period)
        away = self._stuck.way_back(obs, pose, seen)
        if away is not None:
            self._dead_ends.lose_way(obs.t, distance)
            self._last = (away.v, away.w, away.vy)
            return away
        detour = self._dead_ends.detour(obs, pose, goal, distance, self._scene, period)
        if detour.command is not None:
            self._last = detour.command
            return Command(*detour.command)
        if len(detour.beside):
            points = np.concatenate([points, detour.beside])
            velocities = np.concatenate([velocities, np.zeros_like(detour.beside)])
        direction, free = self._choose_direction(pose, detour, points, velocities)
        self._last = self._choose_velocity(obs, distance, detour, direction, points, velocities)
        obs.draw("direction", lambda: [[0.0, 0.0], [math.cos(direction), math.sin(direction)]])
        obs.log("dwa/direction", direction)
        obs.log("dwa/free_time", free)
        return self._stuck.commanded(Command(*self._last), period)

    def _choose_direction(
        self, pose: Pose, detour: Detour, points: Array, velocities: Array
    ) -> tuple[float, float]:
        """Return the direction in which to go on (rad) and for how long it is free (s)."""
        spec, walking = self._spec, self._scene.walking
        speed = spec.speed * self._limits.v_max
        leeway = _OUTLINED_LEEWAY if len(self._core) else _LEEWAY
        previous = detour.goal if self._heading is None else self._heading - pose.yaw
        direction, free = choose_direction(
            points,
            velocities,
            detour.goal,
            previous,
            speed,
            self._half_width + spec.margin + (0.0 if detour.mapped else leeway),
            min(spec.look_ahead, detour.room / speed + 0.1),
            0.2 if detour.escaping else 1.0,
            spec.swerve if walking and not detour.escaping else math.pi,
            spec.hold if walking else 0.5 * spec.hold,
        )
        self._heading = direction + pose.yaw
        return direction, free

    def _choose_velocity(
        self,
        obs: Observation,
        distance: float,
        detour: Detour,
        direction: float,
        points: Array,
        velocities: Array,
    ) -> tuple[float, float, float]:
        """Return v, w and vy of the best candidate; zeros if none is safe."""
        limits = self._limits
        top = min(self._spec.speed * limits.v_max, braking_speed(distance, limits.a_max))
        if self._sideways:
            window, facing = self._window_aside(obs, direction, detour.goal, top), detour.goal
        else:
            window, facing = self._window(obs.twist, direction, top, detour.escaping), direction
        now = (*obs.twist, obs.vy)
        index, _ = evaluate(
            points, velocities, self._p, self._core, now, window, direction, facing, self._last
        )
        chosen = window[index].tolist() if index >= 0 else [0.0, 0.0]
        return chosen[0], chosen[1], chosen[2] if len(chosen) > 2 else 0.0

    def _window(
        self, twist: tuple[float, float], direction: float, top: float, escaping: bool
    ) -> Array:
        """Return (C, 2) target velocities that the robot reaches within the window."""
        spec, limits = self._spec, self._limits
        v, w = twist
        dv, dw = limits.a_max * spec.window, limits.alpha_max * spec.window
        bottom = max(limits.v_min, _REVERSE) if escaping else 0.0
        low = min(max(v - dv, bottom), top)
        high = max(min(v + dv, top), low)
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        wish = max(left, min(right, 1.5 * direction_error(direction)))
        return candidates(low, high, spec.speeds, left, right, spec.yaw_rates, wish)

    def _window_aside(self, obs: Observation, direction: float, goal: float, top: float) -> Array:
        """Return (C, 3) target velocities of a robot that goes sideways and looks to the goal."""
        spec, limits, w = self._spec, self._limits, obs.twist[1]
        dw = limits.alpha_max * spec.window
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        wish, still = (max(left, min(right, r)) for r in (1.5 * direction_error(goal), 0.0))
        now, change = (obs.twist[0], obs.vy), limits.a_max * spec.window
        rates = np.array([wish, still, left, right])
        return candidates_aside(now, change, top, spec.speeds, direction, rates)


def direction_error(direction: float) -> float:
    """Return a bearing in [-pi, pi]."""
    return math.remainder(direction, 2.0 * math.pi)


build = Dwa
