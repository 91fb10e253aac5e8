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
)
from crowdbot.plugins.planners.goal_seek_build import bearing
from crowdbot.plugins.planners.rpp.rpp import RppSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.stopping_build import arc_gap_moving, compile_stopping
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
        compile_stopping()

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the command along the arc to a point."""
        spec, limits = self._spec, self.limits
        far, error = bearing(scene.pose, waypoint)
        obs.draw("aim", lambda: [[0.0, 0.0], [far * math.cos(error), far * math.sin(error)]])
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
        near = _gap(_bodies(scene), self._robot, 0.0, 0.0, 0.0)
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
        obs.draw("plan", lambda: driven(np.tile((v, w, 0.0), (steps, 1)), _STEP))
        bodies = _bodies(scene)
        now = _gap(bodies, self._robot, v, w, 0.0)
        if _gap(bodies, self._robot, v, w, self._spec.collision_time) < min(0.0, now - 1e-3):
            raise NoValidCommand
        return Command(v, w)


def _gap(bodies: Array, robot: Array, v: float, w: float, time: float) -> float:
    """Return the least gap on an arc of some length, s, which ends at once, m."""
    return float(arc_gap_moving(bodies, robot, v, w, time, math.inf))


def _bodies(scene: PlannerScene) -> Array:
    """Return what is around as bodies that stand, (N, 5), see `arc_gap_moving`."""
    discs = scene.discs
    x, y = discs[:, 0] - scene.pose.x, discs[:, 1] - scene.pose.y
    c, s = math.cos(scene.pose.yaw), math.sin(scene.pose.yaw)
    still = np.zeros((len(discs), 2))
    return np.column_stack([c * x + s * y, c * y - s * x, still, discs[:, 2]])


def _clamped(value: float, most: float) -> float:
    return max(-most, min(most, value))


build = Rpp
