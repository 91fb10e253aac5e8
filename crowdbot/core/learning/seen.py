"""Arrays of many robots' inputs at one time, and of the changes in one step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class LearningContext:
    """Constant data of the observing robots, which are all of one model.

    Attributes:
        worlds: number of worlds, W.
        limits, body: of the robot.
        sensors: its sensors that are read, by name.
        step: time between two commands, s.
    """

    worlds: int
    limits: RobotLimits
    body: RobotBody
    sensors: Mapping[str, SensorInfo] = field(default_factory=lambda: MappingProxyType({}))
    step: float = 0.0625


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotInputs:
    """Inputs of W robots at one time; SI units, arrays are not to be changed.

    Attributes:
        fresh: (W,) True where an episode begins.
        stepped: (W,) True where a step was made since the last observation; elsewhere an observer
            with memory repeats its last result, unless an episode begins.
        pose: (W, 3) x, y, yaw by odometry, m and rad.
        twist: (W, 3) v, w, vy by odometry, m/s and rad/s.
        goal: (W, 2) in the frame of ``pose``, m.
        readings: latest readings of each sensor (W, ...), by name; inf for no return.
        people: (W, M, 5) x, y, vx, vy, radius of the people who are present, m and m/s, the rest
            NaN; in any order. Only for observations whose spec is ``privileged``, else (W, 0, 5).
    """

    fresh: Mask
    stepped: Mask
    pose: Array
    twist: Array
    goal: Array
    readings: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    people: Array = field(default_factory=lambda: np.zeros((1, 0, 5)))


@dataclass(frozen=True, slots=True, kw_only=True)
class StepChange:
    """Changes of W robots in one step; SI units.

    Attributes:
        progress: (W,) how much nearer the goal is, m.
        distance: (W,) to the goal at the end, m.
        arrived: (W,) True in the step in which a robot enters its goal zone.
        contact, wall: (W,) share of the step in which a person touched the robot, and in which a
            wall stopped it, 0 to 1.
        gap: (W,) from the robot's outline to the nearest person, m; inf without any.
        advance: (W,) distance driven towards people, weighted by the room that they lack, m, as in
            the metric ``intrusion``.
        work: (W,) work that people need against the robot to keep room, J, as in the metric
            ``push_work``.
        forced: (W,) work, per mass, against people who evade the robot at the last moment, J/kg, as
            in the metric ``safe_efficiency``, where more than 0.25 J/kg against one person halves
            the score.
        aside: (W,) people driven aside in the step: each adds, up to 1, the square of the share of
            the limit that is reached, so that an episode's sum is close to the score's number.
        command, before: (W, 3) v, w, vy of this step and of the one before, m/s and rad/s.
    """

    progress: Array
    distance: Array
    arrived: Mask
    contact: Array
    wall: Array
    gap: Array
    advance: Array
    work: Array
    forced: Array
    aside: Array
    command: Array
    before: Array


def sensor_named(sensors: Mapping[str, SensorInfo], name: str) -> str:
    """Return the name of the first sensor of a name or category.

    Raises:
        InputError: there is none.
    """
    for own, info in sensors.items():
        if name in (own, info.category):
            return own
    raise InputError(
        f"there is no sensor '{name}'; those that are read: {', '.join(sensors) or 'none'}"
    )
