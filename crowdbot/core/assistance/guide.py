"""PersonGuide: gives a planner the pose of its person and the place beside it to drive to."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from crowdbot.core.assistance.finder import PersonFinder, PersonSight, ToldFinder, TrackingFinder
from crowdbot.core.assistance.target import Target, lidars_of
from crowdbot.core.geometry.stance import SOCIAL, place_beside, together
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.person_task import PersonEstimate, PersonTask
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import InputError

#: Largest distance of the corners of a moving goal zone from the goal, m.
_ZONE = 0.3
_CORNERS = np.arange(8) * (0.25 * math.pi)


class Guidance(NamedTuple):
    """A planner's data on a task whose goal is a person: frames and units of `Observation`."""

    person: PersonEstimate
    goal: tuple[float, float]
    goal_zone: Array


class PersonGuide:
    """Estimates the person's pose from the robot's data, and the place where the robot should be.

    Args:
        task: of the robot, from `task_with_person`.
        target: the person or group.
        lidars: of the robot, used if it tracks the person.
        seed: of the random errors of poses.
    """

    def __init__(
        self, task: Task, target: Target, lidars: Mapping[str, SensorInfo], seed: int
    ) -> None:
        self._task, self._target = task, target
        rng = np.random.default_rng(seed)
        tracked = target.goal.knows == "tracked"
        self._finder: PersonFinder = (
            TrackingFinder(target, rng, lidars) if tracked else ToldFinder(target, rng)
        )
        self._last: tuple[float, Guidance] | None = None

    def update(self, sight: PersonSight) -> Guidance:
        """Return the planner's guidance for a step; repeated calls for one time return the same."""
        if self._last is None or self._last[0] != sight.t:
            self._finder.update(sight)
            self._last = sight.t, self._guidance(sight)
        return self._last[1]

    def _guidance(self, sight: PersonSight) -> Guidance:
        person = self._estimate(sight.t)
        goal = self._goal(person, sight.pose)
        if self._target.goal.kind == "lead":
            return Guidance(person, goal, self._task.goal_zone)
        return Guidance(person, goal, zone_around(goal, self._target.goal.tolerance))

    def _estimate(self, t: float) -> PersonEstimate:
        members = self._finder.members
        at = np.array([member.at(t) for member in members])
        facing = np.array([[member.heading for member in members]])
        whole = together(at[np.newaxis, :, 0], at[np.newaxis, :, 1], facing, self._target.radius)
        count = len(members)
        return PersonEstimate(
            x=float(whole.x[0]),
            y=float(whole.y[0]),
            heading=float(whole.heading[0]),
            vx=sum(member.vx for member in members) / count,
            vy=sum(member.vy for member in members) / count,
            age=max(0.0, t - min(member.seen for member in members)),
        )

    def _goal(self, person: PersonEstimate, robot: Pose) -> tuple[float, float]:
        task = self._task.person
        assert task is not None
        assert self._task.robot is not None
        if task.kind == "lead":  # wait for one who falls behind
            away = math.hypot(person.x - robot.x, person.y - robot.y)
            reach = task.radius + self._task.robot.back
            near = away - reach <= min(task.distance + task.tolerance, SOCIAL)
            return self._task.goal if near else (robot.x, robot.y)
        place = place_beside(task, self._task.robot, person.x, person.y, person.heading, robot)
        return place.x, place.y


def task_with_person(task: Task, target: Target) -> Task:
    """Return the robot's task, with the person's pose that its planner may know at the start.

    Args:
        task: task with the robot's body; for ``lead`` also with the goal zone.
        target: the person or group.
    """
    person: PersonTask = target.task()
    if person.kind == "lead":
        return _replaced(task, person, task.goal, task.goal_zone)
    assert task.robot is not None
    x, y, heading, _ = (float(part[0]) for part in target.at_start)
    place = place_beside(person, task.robot, x, y, heading, task.start)
    goal = (place.x, place.y)
    return _replaced(task, person, goal, zone_around(goal, person.tolerance))


def _replaced(task: Task, person: PersonTask, goal: tuple[float, float], zone: Array) -> Task:
    return Task(
        start=task.start,
        goal=goal,
        goal_zone=zone,
        time_limit=task.time_limit,
        robot=task.robot,
        person=person,
    )


def zone_around(goal: tuple[float, float], tolerance: float) -> Array:
    """Return a polygon (8, 2) around a goal, m."""
    radius = min(_ZONE, tolerance)
    return np.column_stack(
        [goal[0] + radius * np.cos(_CORNERS), goal[1] + radius * np.sin(_CORNERS)]
    )


def check_sees(
    scenario: str, robot: str, target: Target, sensors: Mapping[str, SensorInfo]
) -> None:
    """Raise an error if the robot has to track its person but has no lidar.

    Raises:
        InputError: it has none.
    """
    if target.goal.knows == "tracked" and not lidars_of(sensors):
        raise InputError(
            f"{scenario}: robot '{robot}' has to track {target.goal.person}, and has no lidar; "
            "give it one, or write 'knows: told' in its goal"
        )
