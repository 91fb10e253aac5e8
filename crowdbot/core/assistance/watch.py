"""PersonWatch: decides when a task whose goal is a person is done."""

from __future__ import annotations

import numpy as np

from crowdbot.core.assistance.target import Target
from crowdbot.core.crowd import state as s
from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.geometry.polygon import inside
from crowdbot.core.geometry.stance import PersonCircle, in_place, off, together
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.task import Task

_ROUNDING = 1e-9


class PersonWatch:
    """Watches one robot and its person, sample by sample.

    Args:
        task: of the robot.
        target: its person or group.
        outline: of the robot.
    """

    def __init__(self, task: Task, target: Target, outline: Footprint) -> None:
        assert task.person is not None
        self._task, self._person = task, task.person
        self._target, self._outline = target, outline
        self._held, self._before = 0.0, 0.0

    def is_done(self, t: float, robot: RobotState, crowd: Array) -> bool:
        """Return True if the task is done at a sample.

        Args:
            t: s.
            crowd: the flat state of the crowd.
        """
        person = person_in(crowd, self._target)
        if self._person.kind == "lead":
            return self._led(robot, person)
        found = off(self._outline, *_arrays(robot), person)
        if bool(in_place(self._person, found)[0]):
            self._held += t - self._before
        elif self._person.in_a_row:
            self._held = 0.0
        self._before = t
        return self._held >= self._person.hold - _ROUNDING

    def _led(self, robot: RobotState, person: PersonCircle) -> bool:
        """Return True if the robot is in the zone, and the person near it."""
        if not inside(self._task.goal_zone, robot.x, robot.y):
            return False
        most = self._person.distance + self._person.tolerance
        return bool(off(self._outline, *_arrays(robot), person).gap[0] <= most)


def person_in(crowd: Array, target: Target) -> PersonCircle:
    """Return a target's person in the crowd's state as arrays (1,); NaN while absent."""
    rows = rows_in(crowd, target)
    x, y, facing = (rows[np.newaxis, :, k] for k in range(3))
    return together(x, y, facing, target.radius)


def rows_in(crowd: Array, target: Target) -> Array:
    """Return (M, 5) x, y, facing direction, vx, vy of a target's people; NaN if not there."""
    _, people = s.view(crowd)
    rows = people[target.rows]
    facing = np.arctan2(rows[:, s.DIR_Y], rows[:, s.DIR_X])
    found = np.column_stack([rows[:, s.X], rows[:, s.Y], facing, rows[:, s.VX], rows[:, s.VY]])
    found[rows[:, s.WAITING] != s.PRESENT] = np.nan
    return found


def seen_from(robot: Pose, people: Array) -> Array:
    """Return people (M, 5) of `rows_in` in the base frame of a robot."""
    c, sn = np.cos(robot.yaw), np.sin(robot.yaw)
    turn = np.array([[c, -sn], [sn, c]])
    at = (people[:, :2] - [robot.x, robot.y]) @ turn
    return np.column_stack([at, people[:, 2] - robot.yaw, people[:, 3:] @ turn])


def _arrays(robot: RobotState) -> tuple[Array, Array, Array]:
    return np.array([robot.x]), np.array([robot.y]), np.array([robot.yaw])
