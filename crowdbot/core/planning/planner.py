"""Input and output of a planner."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.planning.drawn import Draw, Drawn, DrawnRows, texts_of_rows
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.person_task import PersonEstimate
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import Reading, SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError, hidden_character

#: Largest length of a signal's name, and numbers of names and values in a run.
_LONGEST_NAME, _MOST_SIGNALS, _MOST_VALUES = 200, 1000, 2_000_000
#: Largest shape of a drawing, and number of their numbers in a run.
_MOST_ROWS, _MOST_COLUMNS, _MOST_DRAWN = 2000, 16, 20_000_000


def _ignore(name: str, value: object, /, text: object = None) -> None:
    del name, value, text


#: Name of the drawing with the people that a planner tracks, and number of its columns.
TRACKS, TRACK_COLUMNS = "tracks", 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """Ground truth in the world frame, only for planners with ``privileged = True``.

    Attributes:
        pose: pose of the robot's base, m, rad.
        velocity: the robot's velocity: x, y (m/s), yaw rate (rad/s).
        people: (N, 2) centres of all people present, m, in arbitrary order.
        people_velocity: (N, 2), m/s.
        people_radius: (N,) radius of each person's disc, m.
        people_id: (N,) a person's number, constant in a run.
        people_notice: (N,) time to contact from which a person responds to a robot that moves, s:
            infinite for people who notice as soon as it is within sight, 0 for those who never do
            and for robots; empty if it is not known.
        foresee: ``foresee(steps, step, path)`` simulates these people ahead, and returns their
            positions (T, N, 2), m, after each of ``steps`` steps of ``step`` s; 1e6 for those who
            have left. ``path``: (T + 1, 3) x, y, yaw of the robot now and after each step, m, rad;
            None: without a robot. ``foresee`` is None in a separate process, with several robots,
            and if a hook or a policy of a plugin moves people.
    """

    pose: Pose
    velocity: tuple[float, float, float]
    people: Array
    people_velocity: Array
    people_radius: Array
    people_id: NDArray[np.int64]
    people_notice: Array = field(default_factory=lambda: np.zeros(0))
    foresee: Callable[[int, float, Array | None], Array] | None = None

    def copy(self) -> Truth:
        """Return a copy with its own read-only arrays."""
        arrays = {n: getattr(self, n).copy() for n in Truth.__slots__ if n.startswith("people")}
        for array in arrays.values():
            array.setflags(write=False)
        return Truth(pose=self.pose, velocity=self.velocity, foresee=self.foresee, **arrays)


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """The planner's input in one step.

    Attributes:
        t: simulated time, s.
        pose: pose by wheel odometry (x, y, yaw).
        twist: forward speed (m/s) and yaw rate (rad/s) by wheel odometry.
        vy: speed to the left (m/s), if the odometry measures it (``holonomic_odometry``).
        goal, goal_zone: in the same frame as ``pose``.
        readings: latest reading of each requested sensor.
        log: ``log(name, value)`` records a named signal of the run, a number.
        truth: ground truth for a privileged planner, else None.
        person: what the robot knows of its person, if its task is about one
            (``task.person``); ``goal`` is then where the robot's place beside the person is now.
        draw: ``draw(name, rows)`` records what the planner thinks, as numbers in the robot's base
            frame, m: rows (K, 2) of a path. Names that begin with ``points`` are dots, with
            ``arrows`` an arrow from each row to the next, two rows each. ``tracks`` has rows
            (K, 5) of people: number, x, y, vx, vy. ``draw(name, rows, text)`` shows a text at
            each row: one for all, or a list of one each. The replay shows it. ``rows`` may be a
            function that returns them, called only if the drawing is kept: it must not change the
            planner.
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
    draw: Draw = _ignore
    person: PersonEstimate | None = None


def named_drawing(name: str, rows: DrawnRows, text: str | Sequence[str] | None = None) -> Drawn:
    """Return a valid drawing for the recording; a function of rows is called.

    Raises:
        TypeError, ValueError: it is not a named table of finite numbers, a text has another type,
            or it is too large.
    """
    table = _table(name, rows() if callable(rows) else rows)
    if text is None:
        return Drawn(name, table)
    if name == TRACKS:
        raise ValueError(f"draw: '{TRACKS}' are people, without texts; give these another name")
    return Drawn(name, table, texts_of_rows(name, len(table), text))


def _table(name: str, rows: ArrayLike) -> NDArray[np.float32]:
    named_signal(name, 0.0)
    table = np.array(rows, np.float32)
    if table.size == 0:
        usual = TRACK_COLUMNS if name == TRACKS else 2  # messages lose the columns of no rows
        table = table.reshape(0, table.shape[1] if table.ndim == 2 else usual)
    if table.ndim != 2 or not 2 <= table.shape[1] <= _MOST_COLUMNS or len(table) > _MOST_ROWS:
        raise ValueError(
            f"draw: '{name}' has rows of 2 to {_MOST_COLUMNS} numbers, at most {_MOST_ROWS} of "
            f"them, not the shape {table.shape}"
        )
    if name == TRACKS and table.shape[1] != TRACK_COLUMNS:
        raise ValueError(f"draw: rows of '{TRACKS}' are number, x, y, vx, vy, not {table.shape[1]}")
    # Its sum of squares is finite if all are, or else too large.
    if not math.isfinite(np.vdot(table, table)) and not np.isfinite(table).all():
        raise ValueError(f"draw: '{name}' holds a number that is not finite")
    return table


def named_signal(name: str, value: float) -> tuple[str, float]:
    """Return a valid signal for the recording.

    Raises:
        TypeError, ValueError: it is not a named number.
    """
    if not isinstance(name, str) or not name:
        raise TypeError(f"log: the name of a signal is text, not {name!r}")
    if len(name) > _LONGEST_NAME or hidden_character(name, allowed=""):
        raise ValueError(
            f"log: the name of a signal is at most {_LONGEST_NAME} characters that are shown, "
            f"not {name[:40]!a}"
        )
    return name, float(value)


class SignalBounds:
    """Limits the signals of one run, since recordings and pages have to hold them."""

    def __init__(
        self, subject: str = "log", kind: str = "signals", most: int = _MOST_VALUES
    ) -> None:
        self._names, self._values = set[str](), 0
        self._subject, self._kind, self._most = subject, kind, most

    def check(self, name: str, values: int = 1) -> None:
        """Count some values of a signal.

        Raises:
            PlannerError: the run has too many.
        """
        self._names.add(name)
        self._values += values
        if len(self._names) > _MOST_SIGNALS:
            limit = f"{_MOST_SIGNALS} names of {self._kind}"
            raise PlannerError(f"{self._subject}: more than {limit} in a run")
        if self._values > self._most:
            limit = f"{self._most} values of {self._kind}"
            raise PlannerError(f"{self._subject}: more than {limit} in a run")


def drawing_bounds() -> SignalBounds:
    """Return bounds for the drawings of one run."""
    return SignalBounds("draw", "drawings", _MOST_DRAWN)


class NoValidCommand(Exception):  # noqa: N818 - a word of the planner contract
    """A planner may raise this if it has no valid command; the robot is stopped."""


class Planner(Protocol):
    """The planner under test. A new one is built for each run, including the run without people.

    Its spec class, or the class in a file, may declare ``needs: ClassVar[tuple[str, ...]]``, the
    sensors that it reads, and ``privileged: ClassVar[bool]``, True to read the ground truth.
    """

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Called once before the first step; load models and compile here.

        Args:
            task: start and goal in the world frame, which the odometry frame equals at t = 0.
            limits: commands are clamped to them.
            sensors: name -> constant description of each requested sensor.
            seed: seed for its random numbers; the same in equal runs.
        """
        ...

    def step(self, obs: Observation) -> Command:
        """Called at ``rates.planner``: return the command that holds until the next call.

        Raises:
            NoValidCommand: it has no valid command; the robot is stopped, and the run continues.
        """
        ...
