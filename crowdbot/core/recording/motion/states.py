"""Samples of the log as messages: several per message, people packed by `MotionCodec`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.motion.candidates import CandidateGroup, GoalChanges, GoalsReader
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.recording.motion.codec import MotionCodec


class StateSample(NamedTuple):
    """One sample: time (s), the robot's row, (4, M) x, y, vx, vy, (M,) teleports.

    ``goals``: (2, M) goals in the last step; None: unknown.
    """

    t: float
    robot: Sequence[float] | None
    agents: Array | None
    jump: NDArray[np.bool_] | None
    goals: Array | None = None


@dataclass(frozen=True, slots=True)
class States:
    """K samples: t (K,), robot (K, R), agents (K, 4, M), jump (K, M), known where has_jump (K,)."""

    t: Array
    robot: Array
    agents: Array
    has_jump: NDArray[np.bool_]
    jump: NDArray[np.bool_]


class StatesWriter:
    """Builds ``crowdbot_msgs/RunStates`` from the samples of one run.

    Args:
        people: number of people.
        choosers: people with known candidates.
    """

    def __init__(self, people: int, choosers: Sequence[CandidateGroup] = ()) -> None:
        self._people, self._written = people, 0
        self._codec = _codec(people, choosers)
        self._changes = GoalChanges(people) if choosers else None

    def messages(self, samples: Sequence[StateSample]) -> tuple[Any | None, Any]:
        """Return ``PersonGoals`` (if any changed) and ``RunStates`` of ``crowdbot_msgs``.

        They hold the next samples.

        Args:
            samples: at least one.
        """
        t = np.array([s.t for s in samples], np.float64)
        absent, unknown = np.full((4, self._people), np.nan), np.zeros(self._people, np.bool_)
        agents = [absent if s.agents is None else s.agents for s in samples]
        jump = [unknown if s.jump is None else s.jump for s in samples]
        has_jump = np.array([s.jump is not None for s in samples], np.bool_)
        first, self._written = self._written, self._written + len(t)
        goals, changes = None, None
        if self._changes is not None:
            nowhere = np.zeros((2, self._people))
            goals = np.array([nowhere if s.goals is None else s.goals for s in samples])
            changes = self._changes.message(first, goals)
        packed = self._codec.pack(t, np.array(agents, np.float64), goals)
        return changes, ros.new(
            "crowdbot_msgs/RunStates",
            first=first,
            t=t,
            robot=np.array([() if s.robot is None else s.robot for s in samples]).ravel(),
            has_jump=has_jump,
            jump=np.packbits(np.array(jump)) if has_jump.any() else np.zeros(0, np.uint8),
            gain=packed.gain,
            agents=np.frombuffer(packed.data, np.uint8),
        )


class StatesReader:
    """Reassembles the samples of one run."""

    def __init__(
        self, people: int, candidates: Iterable[Any] = (), goals: Iterable[Any] = ()
    ) -> None:
        """Prepare for the samples of one run.

        Args:
            people: number of people.
            candidates, goals: all ``crowdbot_msgs/VelocityCandidates`` and ``.../PersonGoals``.

        Raises:
            InputError, ValueError: they are inconsistent, or do not match the number of people.
        """
        self._people, self._read = people, 0
        choosers = [CandidateGroup.from_message(message, people) for message in candidates]
        self._codec = _codec(people, choosers)
        self._goals = GoalsReader(people, goals) if choosers else None

    def states(self, messages: Iterable[Any]) -> States:
        """Return all samples of a run.

        Raises:
            InputError: parts of the recording are missing or inconsistent.
        """
        parts = [self._of_message(message) for message in messages]
        if len({part.robot.shape[1] for part in parts}) > 1:
            raise InputError("the samples of the robot do not have equally many numbers")
        t, robot, has_jump, jump = (
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("t", "robot", "has_jump", "jump")
        )
        agents = np.empty((4, len(t), self._people)).transpose(1, 0, 2)  # one table per number
        np.concatenate([part.agents for part in parts], out=agents)
        return States(t, robot, agents, has_jump, jump)

    def _of_message(self, message: Any) -> States:
        from crowdbot.core.recording.motion.codec import Packed  # like `_codec`

        if message.first != self._read:
            raise InputError(f"a part of the recording is missing: sample {self._read}")
        count = len(message.t)
        goals = None if self._goals is None else self._goals.goals(self._read, count)
        self._read += count
        has_jump = np.array(message.has_jump, np.bool_)
        bits = np.unpackbits(message.jump, count=count * self._people) if has_jump.any() else None
        zero = np.zeros((count, self._people), np.bool_)
        if count == 0 or len(has_jump) != count or len(message.robot) % count:
            raise InputError("parts of the recording are missing")
        return States(
            message.t,
            message.robot.reshape(count, -1),
            self._codec.unpack(message.t, Packed(message.gain, message.agents.tobytes()), goals),
            has_jump,
            zero if bits is None else bits.reshape(zero.shape).astype(np.bool_),
        )


class SeriesRows:
    """Values of named series that are not yet written."""

    def __init__(self) -> None:
        self._rows: dict[str, tuple[list[float], list[float]]] = {}

    def add(self, name: str, t: float, value: float) -> None:
        """Add one value; s."""
        times, values = self._rows.setdefault(name, ([], []))
        times.append(t)
        values.append(value)

    def messages(self) -> Iterable[tuple[float, Any]]:
        """Yield the time of the last value and ``crowdbot_msgs/Series`` per name; clears them."""
        rows, self._rows = self._rows, {}
        for name, (times, values) in rows.items():
            columns = {"t": np.array(times, np.float64), "value": np.array(values, np.float64)}
            yield times[-1], ros.new("crowdbot_msgs/Series", name=name, **columns)


def series(messages: Iterable[Any]) -> dict[str, Array]:
    """Return name -> (P, 2) times (s) and values, from the messages of one topic."""
    columns: dict[str, tuple[list[float], list[float]]] = {}
    for message in messages:
        times, values = columns.setdefault(message.name, ([], []))
        if len(np.atleast_1d(message.t)) != len(np.atleast_1d(message.value)):
            raise InputError(f"the series '{message.name}' has times and values of unequal number")
        times += np.atleast_1d(message.t).tolist()
        values += np.atleast_1d(message.value).tolist()
    return {
        name: np.array([times, values], np.float64).T.copy()
        for name, (times, values) in columns.items()
    }


def _codec(people: int, choosers: Sequence[CandidateGroup]) -> MotionCodec:
    """Return the codec; its module imports numba, which a search for runs does without."""
    from crowdbot.core.recording.motion.codec import MotionCodec

    return MotionCodec(people, choosers)
