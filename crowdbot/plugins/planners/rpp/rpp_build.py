"""RPP: pure pursuit of a path, slower in bends and near obstacles.

Macenski, Singh, Martín, Ginés, "Regulated pure pursuit for robot path tracking", Autonomous Robots
47, 2023. People count as static obstacles, as in nav2's costmap.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    NoValidCommand,
    Observation,
    Task,
    kernel,
)
from crowdbot.plugins.planners.goal_seek_build import bearing
from crowdbot.plugins.planners.rpp.rpp import RppSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene

#: Time step of the arc that is tested for collisions, s.
_STEP = 0.1


class Rpp(PathPlanner):
    """Follows the path that `PathFinder` plans around static obstacles."""

    def __init__(self, spec: RppSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._robot = covering_discs(spec.robot_radius, None)

    def prepare(self, task: Task, seed: int) -> None:
        """Store the outline; compile kernels that are not compiled yet."""
        del seed
        self._robot = covering_discs(self._spec.robot_radius, task.robot)
        arc_gap(np.ones((1, 3)), self._robot, 0.1, 0.0, 0.1)

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the command along the arc to a point."""
        spec, limits = self._spec, self.limits
        far, error = bearing(scene.pose, waypoint)
        obs.draw("aim", [[0.0, 0.0], [far * math.cos(error), far * math.sin(error)]])
        if abs(error) > spec.turn_in_place:
            return self._checked(obs, scene, 0.0, _clamped(spec.turn_gain * error, limits.w_max))
        ahead = max(spec.look_ahead_min, abs(scene.twist[0]) * spec.look_ahead_time)
        ahead = min(ahead, spec.look_ahead_max, max(far, 1e-3))
        curvature = 2.0 * math.sin(error) / ahead
        v = min(self._regulated(curvature, scene), top)
        obs.log("rpp/speed", v)
        return self._checked(obs, scene, v, _clamped(v * curvature, limits.w_max))

    def _regulated(self, curvature: float, scene: PlannerScene) -> float:
        """Return the speed for a bend (1/m) and the nearest obstacle, m/s."""
        spec = self._spec
        top = spec.speed * self.limits.v_max
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
    discs = scene.discs
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
