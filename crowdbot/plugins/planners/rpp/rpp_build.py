"""RPP: pure pursuit of a path, slower in bends and near obstacles.

Macenski, Singh, Martín, Ginés, "Regulated pure pursuit for robot path tracking", Autonomous Robots
47, 2023. People count as static obstacles, as in nav2's costmap.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    NoValidCommand,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
    kernel,
)
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.rpp.rpp import RppSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder
from crowdbot.plugins.planners.shared.robot_outline_build import swept_half_width
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, PlannerSurroundings

_ARRIVED, _BESIDE = 0.1, 0.12
#: Time step of the arc that is tested for collisions, s.
_STEP = 0.1


class Rpp:
    """Follows the path that `PathFinder` plans around static obstacles."""

    def __init__(self, spec: RppSpec) -> None:
        self._spec = spec
        self._surroundings = PlannerSurroundings(spec, leaves=True)
        self._limits: RobotLimits | None = None
        self._robot = covering_discs(spec.robot_radius, None)
        self._path_finder = PathFinder(1.0)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits, outline and mounts; compile kernels that are not compiled yet."""
        del seed
        self._limits = limits
        self._surroundings.reset(sensors, task.robot)
        self._robot = covering_discs(self._spec.robot_radius, task.robot)
        self._path_finder = PathFinder(
            swept_half_width(self._spec.robot_radius, task.robot) + _BESIDE
        )
        arc_gap(np.ones((1, 3)), self._robot, 0.1, 0.0, 0.1)

    def step(self, obs: Observation) -> Command:
        """Return the next command; zero at the goal."""
        assert self._limits is not None
        spec, limits = self._spec, self._limits
        scene = self._surroundings.see(obs)
        distance, _ = bearing(scene.pose, obs.goal)
        if distance <= _ARRIVED:
            return Command(0.0, 0.0)
        if self._surroundings.away is not None:
            return self._surroundings.away
        waypoint = self._path_finder.waypoint(obs.t, scene.pose, scene.seen, obs.goal)
        far, error = bearing(scene.pose, waypoint)
        obs.draw("aim", [[0.0, 0.0], [far * math.cos(error), far * math.sin(error)]])
        if abs(error) > spec.turn_in_place:
            return self._checked(obs, scene, 0.0, _clamped(spec.turn_gain * error, limits.w_max))
        ahead = max(spec.look_ahead_min, abs(scene.twist[0]) * spec.look_ahead_time)
        ahead = min(ahead, spec.look_ahead_max, max(far, 1e-3))
        curvature = 2.0 * math.sin(error) / ahead
        v = self._regulated(curvature, scene)
        v = min(v, braking_speed(distance, limits.a_max))
        obs.log("rpp/speed", v)
        return self._checked(obs, scene, v, _clamped(v * curvature, limits.w_max))

    def _regulated(self, curvature: float, scene: PlannerScene) -> float:
        """Return the speed for a bend (1/m) and the nearest obstacle, m/s."""
        spec, limits = self._spec, self._limits
        assert limits is not None
        top = spec.speed * limits.v_max
        bend = top
        if abs(curvature) * spec.bend_radius > 1.0:
            bend = top / (abs(curvature) * spec.bend_radius)
        near = arc_gap(_discs(scene), self._robot, 0.0, 0.0, 0.0)
        close = top
        if near < spec.proximity:
            close = top * spec.proximity_gain * max(near, 0.0) / spec.proximity
        return max(min(bend, close), min(spec.min_speed, top))

    def _checked(self, obs: Observation, scene: PlannerScene, v: float, w: float) -> Command:
        """Return the command, and draw its arc as far as it is checked.

        Raises:
            NoValidCommand: its arc hits something.
        """
        steps = max(1, math.ceil(self._spec.collision_time / _STEP))
        obs.draw("plan", driven(np.tile((v, w, 0.0), (steps, 1)), _STEP))
        discs = _discs(scene)
        now = arc_gap(discs, self._robot, v, w, 0.0)
        if arc_gap(discs, self._robot, v, w, self._spec.collision_time) < min(0.0, now - 1e-3):
            raise NoValidCommand
        return Command(v, w)


def _discs(scene: PlannerScene) -> Array:
    """Return what is around, (N, 3) x, y, radius in the robot's frame, m."""
    points = np.column_stack([scene.points, np.zeros(len(scene.points))])
    discs = np.concatenate([scene.people[:, [0, 1, 4]], points])
    x, y = discs[:, 0] - scene.pose.x, discs[:, 1] - scene.pose.y
    c, s = math.cos(scene.pose.yaw), math.sin(scene.pose.yaw)
    return np.column_stack([c * x + s * y, c * y - s * x, discs[:, 2]])


def _clamped(value: float, most: float) -> float:
    return max(-most, min(most, value))


@kernel
def arc_gap(discs: Array, robot: Array, v: float, w: float, time: float) -> float:
    """Return the least gap to anything along an arc, m; infinite if there is nothing.

    Args:
        discs: (N, 3) x, y, radius in the robot's frame, m.
        robot: (K, 3) discs that hold the robot, m.
        v, w: of the arc, m/s, rad/s.
        time: length of the arc, s.
    """
    best, x, y, yaw, t = math.inf, 0.0, 0.0, 0.0, 0.0
    while True:
        c, s = math.cos(yaw), math.sin(yaw)
        for k in range(robot.shape[0]):
            px = x + c * robot[k, 0] - s * robot[k, 1]
            py = y + s * robot[k, 0] + c * robot[k, 1]
            for i in range(discs.shape[0]):
                dx, dy = discs[i, 0] - px, discs[i, 1] - py
                best = min(best, math.sqrt(dx * dx + dy * dy) - robot[k, 2] - discs[i, 2])
        if t >= time:
            return best
        x += v * _STEP * math.cos(yaw + 0.5 * w * _STEP)
        y += v * _STEP * math.sin(yaw + 0.5 * w * _STEP)
        yaw += w * _STEP
        t += _STEP


build = Rpp
