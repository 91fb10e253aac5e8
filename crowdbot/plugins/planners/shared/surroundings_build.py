"""Surroundings: a planner's knowledge of people, walls and its own pose, on each rung."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    Indices,
    LidarPoints,
    Observation,
    PeopleTracker,
    Pose,
    RobotBody,
    SensorInfo,
    Truth,
    array_kernel,
)
from crowdbot.plugins.planners.shared.heading_by_walls_build import HeadingByWalls, compile_heading
from crowdbot.plugins.planners.shared.near_points_build import NearPoints
from crowdbot.plugins.planners.shared.people_build import people_in
from crowdbot.plugins.planners.shared.people_motion_build import PeopleMotion
from crowdbot.plugins.planners.shared.points_build import nearest_per_sector
from crowdbot.plugins.planners.shared.rungs import LadderSpec
from crowdbot.plugins.planners.shared.stuck_build import Stuck, compile_stuck

#: Lidar points farther away play no part, m; in each sector the nearest one counts.
REACH, SECTORS = 6.0, 180
#: A lidar point this near to a person's disc belongs to that person, m.
_OWN = 0.12
#: Age of the scan that shows how people move where there is no tracker, s.
_LOOK_BACK = 0.3
#: Columns of people.
X, Y, VX, VY, RADIUS = range(5)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerScene:
    """The robot's surroundings in one step, in the fixed frame of odometry.

    Attributes:
        pose: the robot's.
        twist: v, w and vy of the robot, m/s, rad/s, m/s.
        people: (N, 5) x, y, vx, vy, radius; m, m/s.
        points: (P, 2) lidar points of what is not a person, the nearest in each direction, m.
        seen: (Q, 2) all of them, m.
        tracks: (N, 5) number, x, y, vx, vy of people.
    """

    pose: Pose
    twist: tuple[float, float, float]
    people: Array
    points: Array
    seen: Array
    tracks: Array

    @property
    def discs(self) -> Array:
        """Return people and points as discs, (N + P, 3) x, y, radius, m."""
        points = np.column_stack([self.points, np.zeros(len(self.points))])
        return np.concatenate([self.people[:, [0, 1, RADIUS]], points])


class PlannerSurroundings:
    """Computes a `PlannerScene` from each observation; has the lifetime of a planner.

    Args:
        spec: of the planner.
        leaves: True if the planner obeys `away`, so that the robot leaves barriers that no lidar
            sees.

    Attributes:
        away: command that leads away from such a barrier in this step; None: there is none.
    """

    def __init__(self, spec: LadderSpec, *, leaves: bool = False) -> None:
        self._spec, self._leaves = spec, leaves
        self._stuck, self._near = Stuck(), NearPoints({})
        self.away: Command | None = None
        self._lidars = LidarPoints({})
        self._tracker: PeopleTracker | None = None
        self._heading, self._motion = HeadingByWalls(), PeopleMotion(_LOOK_BACK)

    def reset(self, sensors: Mapping[str, SensorInfo], body: RobotBody | None = None) -> None:
        """Reset the memory; compile kernels.

        Args:
            sensors: description of each sensor that the planner gets.
        """
        truth = self._spec.localisation == "truth"
        self._stuck = Stuck(self._spec.robot_radius, body, sensors, slips=not truth)
        self.away = None
        self._near = NearPoints(sensors)
        compile_stuck()
        self._lidars = LidarPoints(sensors)
        compile_heading()
        self._heading, self._motion = HeadingByWalls(), PeopleMotion(_LOOK_BACK)
        if self._tracker is None and self._spec.tracks == "tracker":
            self._tracker = PeopleTracker()
        if self._tracker is not None:
            self._tracker.reset()
        people_in(np.ones((1, 2)), REACH)
        others(np.ones((1, 2)), np.ones((1, 5)), _OWN)
        nearest_per_sector(np.ones((1, 2)), SECTORS, REACH)
        for t in (0.0, _LOOK_BACK):
            self._motion.velocities(t, Pose(0.0, 0.0, 0.0), np.ones((1, 2)))
        self._motion = PeopleMotion(_LOOK_BACK)

    def see(self, obs: Observation) -> PlannerScene:
        """Return the surroundings at the time of an observation."""
        points = self._lidars(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._pose(obs, points)
        if len(self._near):
            points = np.concatenate([points, self._near(obs, points)])
        if self._leaves:
            pose, points = self._stuck.see(obs, pose, points)
            self.away = self._stuck.way_back(obs, pose, points)
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        to_world = np.array([[c, s], [-s, c]])  # of row vectors
        here = np.array([pose.x, pose.y])
        tracks = self._people(obs, pose, points, to_world)
        obs.draw("tracks", lambda: _from_robot(tracks, here, to_world))
        people = np.column_stack([tracks[:, 1:], self._radii(obs, len(tracks))])
        seen = others(points @ to_world + here, people, _OWN)
        near = nearest_per_sector((seen - here) @ to_world.T, SECTORS, REACH)
        return PlannerScene(
            pose=pose, twist=(*obs.twist, obs.vy), people=people, seen=seen,
            points=near @ to_world + here, tracks=tracks,
        )  # fmt: skip

    def _pose(self, obs: Observation, points: Array) -> Pose:
        if self._spec.localisation == "truth":
            return _truth(obs).pose
        return (
            obs.pose
            if self._spec.localisation == "odometry"
            else self._heading.pose(obs.pose, points)
        )

    def _people(self, obs: Observation, pose: Pose, points: Array, to_world: Array) -> Array:
        """Return (N, 5) number, place (m) and velocity (m/s) of people."""
        if self._spec.tracks == "truth":
            return true_people(_truth(obs), pose)
        if self._tracker is not None:
            return self._tracker.update(obs.t, pose, points).rows
        found, _ = people_in(points, REACH)
        going = self._motion.velocities(obs.t, pose, found)
        places = found @ to_world + (pose.x, pose.y)
        return np.column_stack([np.arange(len(found)), places, going @ to_world])

    def _radii(self, obs: Observation, count: int) -> Array:
        if self._spec.tracks == "truth":
            return _truth(obs).people_radius
        return np.full(count, self._spec.person_radius)


def _from_robot(tracks: Array, here: Array, to_world: Array) -> Array:
    """Return (N, 5) number, place and velocity in the base frame of the robot."""
    back = to_world.T
    return np.column_stack([tracks[:, 0], (tracks[:, 1:3] - here) @ back, tracks[:, 3:] @ back])


def in_base(pose: Pose, places: Array) -> Array:
    """Return points (K, 2) of a pose's frame in the base frame, m."""
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    return np.asarray((places - (pose.x, pose.y)) @ np.array([[c, -s], [s, c]]))


def people_near(scene: PlannerScene, speed: float, horizon: float, most: int) -> Array:
    """Return the people (N, 5) who can come near in time; of more than ``most`` the nearest.

    Args:
        scene: the surroundings.
        speed: largest speed of the robot, m/s.
        horizon: s.
        most: how many.
    """
    return np.ascontiguousarray(scene.people[rows_near(scene, speed, horizon, most)])


def rows_near(scene: PlannerScene, speed: float, horizon: float, most: int) -> Indices:
    """Return the rows (N,) of people who can come near in time; as `people_near`."""
    people = scene.people
    away = np.hypot(people[:, 0] - scene.pose.x, people[:, 1] - scene.pose.y)
    reach = (np.hypot(people[:, 2], people[:, 3]) + speed) * horizon + 1.0
    near = np.flatnonzero(away < reach)
    return near[np.argsort(away[near], kind="stable")[:most]] if len(near) > most else near


def _truth(obs: Observation) -> Truth:
    assert obs.truth is not None  # since the spec says that it is privileged
    return obs.truth


def true_people(truth: Truth, pose: Pose) -> Array:
    """Return (N, 5) number, x, y, vx, vy of all people, placed relative to a pose.

    Args:
        truth: in the world frame.
        pose: the robot's estimated pose.
    """
    turn = pose.yaw - truth.pose.yaw
    c, s = math.cos(turn), math.sin(turn)
    rotation = np.array([[c, s], [-s, c]])
    places = (truth.people - (truth.pose.x, truth.pose.y)) @ rotation + (pose.x, pose.y)
    return np.column_stack([truth.people_id, places, truth.people_velocity @ rotation])


@array_kernel
def others(points: Array, people: Array, own: float) -> Array:
    """Return the points (Q, 2) that are farther than ``own`` from the discs of people (N, 5)."""
    out, count = np.empty(points.shape), 0
    for i in range(points.shape[0]):
        alone = True
        for k in range(people.shape[0]):
            dx, dy = points[i, 0] - people[k, 0], points[i, 1] - people[k, 1]
            most = people[k, 4] + own
            if dx * dx + dy * dy < most * most:
                alone = False
                break
        if alone:
            out[count, 0], out[count, 1] = points[i, 0], points[i, 1]
            count += 1
    return out[:count]


def bodies_in_base(scene: PlannerScene) -> Array:
    """Return all bodies around, (N, 5) x, y, vx, vy, radius in the base frame; m, m/s."""
    c, s = math.cos(scene.pose.yaw), math.sin(scene.pose.yaw)
    to_base = np.array([[c, -s], [s, c]])  # of row vectors
    still = np.zeros((len(scene.points), 3))
    rows = np.concatenate([scene.people, np.column_stack([scene.points, still])])
    here = scene.pose.x, scene.pose.y
    return np.column_stack(
        [(rows[:, :2] - here) @ to_base, rows[:, VX : VY + 1] @ to_base, rows[:, RADIUS]]
    )
