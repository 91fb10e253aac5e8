"""Manoeuvres of a long robot without progress, planned on its own map."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

import crowdbot.plugins.planners.dwa.parameters_build as parameters
from crowdbot.plugin import Array, Observation, Pose, Reading, RobotLimits
from crowdbot.plugins.planners.dwa.cost_build import evaluate
from crowdbot.plugins.planners.dwa.dead_ends.legs_build import Legs
from crowdbot.plugins.planners.dwa.dead_ends.lidar_views_build import LidarViews
from crowdbot.plugins.planners.dwa.dead_ends.manoeuvre_build import manoeuvre
from crowdbot.plugins.planners.shared.local_map_build import islands
from crowdbot.plugins.planners.shared.people_build import carry, with_discs
from crowdbot.plugins.planners.shared.points_build import nearest_per_sector

#: Period of map updates, s; cell size, m; and distance beside the robot within which remembered
#: points are obstacles although no lidar may see them, m.
_PERIOD, _CELL, _BESIDE = 0.5, 0.03, 0.4
#: Map points closer than this are one object, m; it is small up to this size, m.
_LINK, _SMALL = 0.25, 0.6
#: Preferred clearance when a manoeuvre is planned, and clearance when it is driven, m.
_TIGHT, _TIGHTEST = 0.04, 0.02
#: Shares of the desired speed that are tried if a person is in the way.
_SLOWER = (1.0, 0.5, 0.2)
#: After this long without any of them, the robot replans if the path is old, and backs off at this
#: speed: s, m/s.
_HELD, _BACK_OFF = 1.0, -0.1
_SECTORS = 240
_NONE = np.empty((0, 2))


class Manoeuvring:
    """Plans and drives manoeuvres; remembers static obstacles and the remaining legs.

    Pieces of walls seen at an angle are as narrow as legs, and a false person would block a door:
    only isolated points in the map count as standing people.

    Args:
        core: of the robot's outline, as `robot_outline_build.core_of`.
        p: parameters of `parameters_build`.
        limits: the robot's.
        lidars: views of the robot's lidars.
        person_radius: disc that is kept clear around people, m.
        reach: range up to which lidar returns are used, m.
    """

    def __init__(
        self,
        core: Array,
        p: Array,
        limits: RobotLimits,
        lidars: LidarViews,
        person_radius: float,
        reach: float,
    ) -> None:
        self._core, self._p, self._limits, self._lidars = core, p, limits, lidars
        self._person, self._reach = person_radius, reach
        self._beside = float(p[parameters.REACH]) + _BESIDE
        self.forget()
        self._plan(np.ones((1, 2)), Pose(0.0, 0.0, 0.0), (9.0, 0.0))  # compiles
        islands(np.ones((1, 2)), _LINK, _SMALL)

    def forget(self) -> None:
        """Drop the manoeuvre, since the robot advances again."""
        self._map, self._alone = _NONE, _NONE
        self._legs, self._held = Legs(), 0.0
        self._mapped_at = -math.inf

    def __bool__(self) -> bool:
        """Return True during a manoeuvre."""
        return bool(self._legs)

    def command(
        self, obs: Observation, stands: Array, walkers: Array
    ) -> tuple[float, float, float] | None:
        """Return the next v (m/s), w (rad/s) and vy, which is 0; None if there is no path.

        Args:
            stands: (P, 2) lidar points except those of walking people, base frame, m.
            walkers: (K, 4) x, y, vx, vy of walking people, base frame.
        """
        if obs.t - self._mapped_at >= _PERIOD:
            self._mapped_at = obs.t
            self._remember(obs.pose, stands, obs.readings)
            # A path that can be driven is kept: in a door, a new one may begin by backing off.
            if not self._legs or (self._held > _HELD and self._legs.old(obs.t)):
                discs = with_discs(_NONE, _into(self._alone, obs.pose), self._person)
                around = np.concatenate([self._map, _out_of(discs, obs.pose)])
                found = self._plan(around, obs.pose, obs.goal)
                if len(found):
                    self._legs.begin(found, obs.t)
        return self._drive(obs, stands, walkers) if self._legs else None

    def beside(self, pose: Pose) -> Array:
        """Return remembered points (K, 2) so near that no lidar may see them, base frame, m."""
        points = _into(self._map, pose)
        return points[np.hypot(points[:, 0], points[:, 1]) < self._beside]

    def _remember(self, pose: Pose, stands: Array, readings: Mapping[str, Reading]) -> None:
        """Add the points seen now, and keep those hidden or outside the lidars' views."""
        seen = _out_of(nearest_per_sector(stands, _SECTORS, self._reach), pose)
        near = np.hypot(self._map[:, 0] - pose.x, self._map[:, 1] - pose.y) < self._reach
        kept = self._map[near & ~self._lidars.past(readings, pose, self._map)]
        points = np.concatenate([seen, kept])  # a new point replaces an old one
        _, first = np.unique(np.round(points / _CELL), axis=0, return_index=True)
        self._map = points[first]
        self._alone = islands(self._map, _LINK, _SMALL)

    def _plan(self, around: Array, pose: Pose, goal: tuple[float, float]) -> Array:
        """Return legs of a manoeuvre among points (N, 2), world frame.

        Empty if there is no path.
        """
        rounding, reach = float(self._p[parameters.RADIUS]), float(self._p[parameters.REACH])
        found = manoeuvre(around, pose, goal, self._core, rounding, reach, _TIGHT)
        if len(found) == 0:  # the memory is blurred, as odometry drifts
            found = manoeuvre(around, pose, goal, self._core, rounding, reach, _TIGHTEST)
        return found

    def _drive(self, obs: Observation, stands: Array, walkers: Array) -> tuple[float, float, float]:
        """Continue along the legs, slower or not at all if a person is in the way."""
        v, w = self._legs.velocity(obs.pose, self._limits)
        wishes = [(share * v, share * w) for share in _SLOWER]
        wishes += [(_BACK_OFF, 0.0)] if self._held > _HELD else []
        points, velocities = self._around(obs.pose, stands, walkers)
        tight, now = self._p.copy(), (*obs.twist, obs.vy)
        tight[parameters.MARGIN] = _TIGHTEST
        self._held += float(self._p[parameters.PERIOD])
        for k, (v, w) in enumerate(wishes):
            index, _ = evaluate(
                points, velocities, tight, self._core, now, np.array([[v, w]]), 0.0, 0.0, now
            )
            if index == 0:
                self._held = 0.0 if k < len(_SLOWER) else self._held
                return v, w, 0.0
        return 0.0, 0.0, 0.0

    def _around(self, pose: Pose, stands: Array, walkers: Array) -> tuple[Array, Array]:
        """Return points and velocities (K, 2) of everything seen or remembered, base frame."""
        alone = _into(self._alone, pose)
        people = np.concatenate([alone, walkers[:, :2]])
        going = np.concatenate([np.zeros_like(alone), walkers[:, 2:]])
        known = np.concatenate([stands, _into(self._map, pose)])
        points = nearest_per_sector(with_discs(known, people, self._person), _SECTORS, self._reach)
        velocities = np.zeros_like(points)
        carry(points, velocities, people, going, self._person)
        return points, velocities


def _into(points: Array, pose: Pose) -> Array:
    """Transform points (N, 2) from the world to the robot's frame, m."""
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    turned: Array = (points - (pose.x, pose.y)) @ np.array([[c, -s], [s, c]])
    return turned


def _out_of(points: Array, pose: Pose) -> Array:
    """Transform points (N, 2) from the robot's frame to the world, m."""
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    turned: Array = points @ np.array([[c, s], [-s, c]]) + (pose.x, pose.y)
    return turned
