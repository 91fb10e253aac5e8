"""What a planner is given, sees and returns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import Reading, SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import hidden_character

#: Most characters of the name of a signal.
_LONGEST_NAME = 200


def _ignore(name: str, value: float) -> None:
    del name, value


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """What is, in the world frame: for planners that say ``privileged = True``, and no other.

    Attributes:
        pose: of the robot's base, m, rad.
        velocity: of the robot: x, y (m/s), yaw rate (rad/s).
        people: (N, 2) centres of all who are present, m, in no order that means anything.
        people_velocity: (N, 2), m/s.
        people_radius: (N,) radius of the disc that stands for each, m.
        people_id: (N,) the same person has the same number in all observations of a run.
    """

    pose: Pose
    velocity: tuple[float, float, float]
    people: Array
    people_velocity: Array
    people_radius: Array
    people_id: NDArray[np.int64]

    def copy(self) -> Truth:
        """The same with read-only arrays of its own."""
        arrays = {n: getattr(self, n).copy() for n in Truth.__slots__ if n.startswith("people")}
        for array in arrays.values():
            array.setflags(write=False)
        return Truth(pose=self.pose, velocity=self.velocity, **arrays)


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """What a planner sees in one step.

    Attributes:
        t: simulated time, s.
        pose: pose by wheel odometry (x, y, yaw).
        twist: forward speed (m/s) and yaw rate (rad/s) by wheel odometry.
        vy: speed to the left (m/s) by odometry that measures it (``holonomic_odometry``).
        goal, goal_zone: in the same frame as ``pose``.
        readings: latest reading of each sensor that was asked for.
        log: ``log(name, value)`` records a named signal of the run, a number.
        truth: None, but for a planner that is privileged.
    """

    t: float
    pose: Pose
    twist: tuple[float, float]
    goal: tuple[float, float]
    goal_zone: Array
    vy: float = 0.0
    readings: Mapping[str, Reading] = field(default_factory=lambda: MappingProxyType({}))
    log: Callable[[str, float], None] = _ignore
    truth: Truth | None = None


def named_signal(name: str, value: float) -> tuple[str, float]:
    """A signal that can be recorded.

    Raises:
        TypeError, ValueError: what the planner wants to log is not a named number.
    """
    if not isinstance(name, str) or not name:
        raise TypeError(f"log: the name of a signal is text, not {name!r}")
    if len(name) > _LONGEST_NAME or hidden_character(name, allowed=""):
        raise ValueError(
            f"log: the name of a signal is at most {_LONGEST_NAME} characters that are shown, "
            f"not {name[:40]!a}"
        )
    return name, float(value)


class NoValidCommand(Exception):  # noqa: N818 - a word of the planner contract
    """A planner may raise this when it knows no command; the robot is told to stop."""


class Planner(Protocol):
    """The thing under test. Made anew for each run, also for the one without people.

    Its spec class, or the class in a file, may say ``needs: ClassVar[tuple[str, ...]]``, the
    sensors that it reads, and ``privileged: ClassVar[bool]``, whether it may read the truth.
    """

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Called once, before the first step; the place to load models and to compile.

        Args:
            task: start and goal in the world frame, which the odometry frame equals at t = 0.
            limits: commands are clamped into them.
            sensors: name -> constant description of each sensor that it gets.
            seed: for its own random numbers; the same run has the same one.
        """
        ...

    def step(self, obs: Observation) -> Command:
        """Called at ``rates.planner``: return the command that holds until the next call.

        Raises:
            NoValidCommand: it knows none; the robot is told to stop, and the run goes on.
        """
        ...
