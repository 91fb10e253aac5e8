"""RDS: half-planes of velocities of a point ahead of the axle, one for each obstacle.

Gonon, Paez-Granados, Billard, "Reactive navigation in crowds for non-holonomic robots with convex
bounding shape", IEEE Robotics and Automation Letters 6(3), 2021. The velocity of any point of the
robot is a linear function of that of a reference point ahead of the axle. For each obstacle, the
nearest point of the capsule around the robot gets a half-plane of velocities, which is converted to
one of the reference point; the velocity nearest to the wanted one in all of them is driven. A point
on the axle cannot move sideways, so that its half-plane can only be kept by braking. A robot whose
outline is round about its axle would therefore never steer: its capsule reaches ahead of the axle,
with the centre of the front at the reference point, as that of the authors' robot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    InputError,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
    kernel,
)
from crowdbot.plugins.planners.rds.rds import RdsSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner
from crowdbot.plugins.planners.shared.half_planes_build import avoid, best_velocity, violation
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base
from crowdbot.plugins.planners.shared.user_input_build import JOYSTICK, UserInput

#: Things farther than this do not count, m; size of a lidar point, m.
_NEAR, _POINT = 4.0, 0.03
#: Time in which touching things part, s; yaw rate per heading error, 1/s.
_STEP, _GAIN = 0.25, 2.5
#: A half-plane whose normal is shorter says nothing; more than that beyond one is too fast, m/s.
_LEAST, _BEYOND = 1e-6, 1e-6
_MOST = 500


class Rds(VelocityPlanner):
    """The RDS planner, without memory."""

    def __init__(self, spec: RdsSpec) -> None:
        super().__init__(spec)
        self._spec, self._user, self._point = spec, UserInput(), spec.reference_point
        self._ends, self._round = np.zeros((2, 2)), self.radius
        self._lines, self._scratch = np.zeros((_MOST, 4)), np.zeros((_MOST, 4))

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits, outline, mounts and joystick; compile kernels.

        Raises:
            InputError: it assists a user, and the robot has no joystick.
        """
        if self._spec.wish == "user" and all(s.category != JOYSTICK for s in sensors.values()):
            raise InputError("planner 'rds': with wish 'user' the robot needs a joystick")
        self._user.reset(sensors, limits)
        super().reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the command nearest to the desired one, the planner's own or the user's."""
        if self._spec.wish == "goal":
            return super().step(obs)
        scene, user, reach = self._surroundings.see(obs), self._user.command(obs), self._point
        if self.limits.vy_max > 0.0:
            along, aside = self._nearest(obs, scene, (user.v, user.vy), self.limits.vy_max)
            return Command(along, user.w if along or aside else 0.0, aside)
        desired = user.v, user.w * reach
        along, aside = self._nearest(obs, scene, desired, self.limits.w_max * reach)
        return Command(along, aside / reach)

    def forget(self) -> None:
        """Compute the capsule around the robot; compile kernels."""
        discs = covering_discs(self._spec.robot_radius, self.body)
        self._ends = np.ascontiguousarray(discs[[0, -1], :2])
        self._round = float(discs[:, 2].max())
        if self.limits.vy_max == 0.0:
            self._ends, self._round = capsule_ahead(discs, self._point)
        things = np.array([[3.0, 0.0, 0.0, 0.0, 0.3]])
        self._choose(things, (0.0, 0.0, 0.0), (0.5, 0.0), np.zeros((0, 4)))

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity of the reference point, in the robot's own axes, m/s."""
        limits, reach = self.limits, self._spec.reference_point
        top = float(np.hypot(*wish))
        error = math.remainder(math.atan2(wish[1], wish[0]) - scene.pose.yaw, 2.0 * math.pi)
        if limits.vy_max > 0.0:
            desired = top * math.cos(error), top * math.sin(error)
            aside = limits.vy_max
        else:
            turn = max(-limits.w_max, min(limits.w_max, _GAIN * error))
            desired, aside = (top * max(0.0, math.cos(error)), turn * reach), limits.w_max * reach
        return self._nearest(obs, scene, desired, aside)

    def _nearest(
        self, obs: Observation, scene: PlannerScene, desired: tuple[float, float], aside: float
    ) -> tuple[float, float]:
        """Return the velocity of the reference point nearest to the wanted one, m/s."""
        bounds = _bounds(min(0.0, self.limits.v_min), self.limits.v_max, aside)
        chosen = self._choose(_things(scene), scene.twist, desired, bounds)
        obs.log("rds/change", math.hypot(chosen[0] - desired[0], chosen[1] - desired[1]))
        return chosen

    def pursue(self, obs: Observation, scene: PlannerScene, wish: Array, error: float) -> Command:
        """Return the command that gives the reference point its velocity."""
        along, aside = self.velocity(obs, scene, wish)
        ahead = np.array([self._spec.reference_point, 0.0])
        obs.draw("velocity", lambda: np.array([ahead, ahead + np.array([along, aside])]))
        if self.limits.vy_max > 0.0:
            turn = max(-self.limits.w_max, min(self.limits.w_max, _GAIN * error))
            return Command(along, turn if along or aside else 0.0, aside)
        return Command(along, aside / self._spec.reference_point)

    def _choose(
        self,
        things: Array,
        twist: tuple[float, float, float],
        desired: tuple[float, float],
        bounds: Array,
    ) -> tuple[float, float]:
        spec = self._spec
        sideways = self.limits.vy_max > 0.0
        count, rest = len(bounds), spec.basis == "rest"
        self._lines[:count] = bounds
        count = half_planes(
            things, self._ends, (self._round, spec.margin), (0.0, 0.0, 0.0) if rest else twist,
            (spec.time_horizon, 0.0 if sideways else spec.reference_point), rest, count,
            self._lines,
        )  # fmt: skip
        fastest = 10.0  # the bounds limit more
        found = best_velocity(self._lines, count, 0, fastest, desired, self._scratch)
        return found if allowed(self._lines, count, found) else (0.0, 0.0)


def _things(scene: PlannerScene) -> Array:
    """Return people and points (T, 5) x, y, vx, vy, radius in the robot's frame, nearest first."""
    people = scene.people
    places = np.vstack([people[:, :2], scene.points])
    c, s = math.cos(scene.pose.yaw), math.sin(scene.pose.yaw)
    found = np.zeros((len(places), 5))
    found[:, :2] = in_base(scene.pose, places)
    found[: len(people), 2:4] = people[:, 2:4] @ np.array([[c, -s], [s, c]])
    found[: len(people), 4], found[len(people) :, 4] = people[:, 4], _POINT
    away = np.hypot(found[:, 0], found[:, 1])
    order = np.argsort(away, kind="stable")
    return np.ascontiguousarray(found[order[away[order] < _NEAR]][: _MOST - 4])


def capsule_ahead(discs: Array, reach: float) -> tuple[Array, float]:
    """Return ends (2, 2) and radius of a capsule along the robot's axis that holds its discs.

    Args:
        discs: (K, 3) that together hold the robot, m.
        reach: least distance of the centre of its front ahead of the axle, m.
    """
    back, front = discs[:, 0].min(), max(float(discs[:, 0].max()), reach)
    return np.array([[back, 0.0], [front, 0.0]]), float(np.max(np.abs(discs[:, 1]) + discs[:, 2]))


def _bounds(slowest: float, fastest: float, aside: float) -> Array:
    """Return the half-planes (4, 4) of the drive's limits, m/s."""
    return np.array(
        [
            [slowest, 0.0, 0.0, -1.0], [fastest, 0.0, 0.0, 1.0],
            [0.0, -aside, 1.0, 0.0], [0.0, aside, -1.0, 0.0],
        ]
    )  # fmt: skip


@kernel
def half_planes(
    things: Array,
    ends: Array,
    sizes: tuple[float, float],
    twist: tuple[float, float, float],
    scales: tuple[float, float],
    rest: bool,
    count: int,
    out: Array,
) -> int:
    """Write a half-plane of velocities of the reference point for each obstacle.

    Args:
        things: (T, 5) x, y, vx, vy, radius, in the robot's frame.
        ends: (2, 2) ends of the capsule's segment, m.
        sizes: radius of the capsule, and margin, m.
        twist: the robot's velocity ahead, yaw rate, velocity aside, around which half-planes lie.
        scales: time horizon, s; distance of the reference point, m, 0 for a robot that goes
            sideways.
        rest: standing still is allowed in all.
        count: rows of ``out`` that are in use.
        out: (L, 4), as in `half_planes_build`.

    Returns:
        rows in use.
    """
    time, reach = scales
    sx, sy = ends[1, 0] - ends[0, 0], ends[1, 1] - ends[0, 1]
    long = sx * sx + sy * sy
    for i in range(things.shape[0]):
        if count >= out.shape[0]:
            break
        dx, dy = things[i, 0] - ends[0, 0], things[i, 1] - ends[0, 1]
        share = 0.0 if long == 0.0 else min(1.0, max(0.0, (dx * sx + dy * sy) / long))
        x, y = ends[0, 0] + share * sx, ends[0, 1] + share * sy
        line = out[count]
        place = things[i, 0] - x, things[i, 1] - y
        both = sizes[0] + sizes[1] + things[i, 4]
        own = twist[0] - twist[1] * y, twist[2] + twist[1] * x
        avoid(place, own, (things[i, 2], things[i, 3]), both, time, _STEP, 1.0, line)
        nx, ny = -line[3], line[2]
        least = nx * line[0] + ny * line[1]
        if rest:
            least = min(0.0, least)
        if reach > 0.0:
            nx, ny = nx, (ny * x - nx * y) / reach
        size = math.sqrt(nx * nx + ny * ny)
        if size < _LEAST:
            continue
        nx, ny, least = nx / size, ny / size, least / size
        line[0], line[1] = nx * least, ny * least
        line[2], line[3] = ny, -nx
        count += 1
    return count


@kernel
def allowed(lines: Array, count: int, velocity: tuple[float, float]) -> bool:
    """Return False if a velocity lies beyond one of the first ``count`` half-planes."""
    worst = 0.0
    for i in range(count):
        worst = max(worst, violation(lines[i], velocity[0], velocity[1]))
    return worst <= _BEYOND


build = Rds
