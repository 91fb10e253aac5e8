"""Velocity candidates and goals of people, from which the codec predicts their motion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.candidates import VelocityCandidates
from crowdbot.errors import InputError

#: Largest number of candidates: a choice is stored in seven bits.
MOST_CANDIDATES = 120


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateGroup:
    """People who choose among the same candidate velocities.

    Attributes:
        candidates: their candidate velocities.
        rows: (P,) their rows in the samples.
        preferred_speed, radius, max_acceleration: (P,) m/s, m, m/s^2.
    """

    candidates: VelocityCandidates
    rows: NDArray[np.int64]
    preferred_speed: Array
    radius: Array
    max_acceleration: Array

    @property
    def fits(self) -> bool:
        """True if choices can be recorded as one byte."""
        return 0 < len(self.candidates.unit) <= MOST_CANDIDATES

    def to_message(self) -> Any:
        """Return ``crowdbot_msgs/VelocityCandidates``."""
        return ros.new(
            "crowdbot_msgs/VelocityCandidates",
            unit=ros.table(self.candidates.unit),
            relaxation_time=self.candidates.relaxation_time,
            person=self.rows.astype(np.uint32),
            preferred_speed=np.asarray(self.preferred_speed, np.float64),
            radius=np.asarray(self.radius, np.float64),
            max_acceleration=np.asarray(self.max_acceleration, np.float64),
        )

    @classmethod
    def from_message(cls, message: Any, people: int) -> CandidateGroup:
        """Read ``crowdbot_msgs/VelocityCandidates``.

        Raises:
            ValueError: the message is inconsistent, or there are fewer people.
        """
        unit, rows = ros.from_table(message.unit), message.person.astype(np.int64)
        columns = (message.preferred_speed, message.radius, message.max_acceleration)
        if unit is None or any(len(column) != len(rows) for column in columns):
            raise ValueError("candidates and those who choose among them do not fit each other")
        if len(rows) and rows.max() >= people:
            raise ValueError(f"person {rows.max()} of {people} chooses among candidates")
        found = cls(
            candidates=VelocityCandidates(unit, message.relaxation_time),
            rows=rows,
            preferred_speed=message.preferred_speed,
            radius=message.radius,
            max_acceleration=message.max_acceleration,
        )
        if not found.fits:
            raise ValueError(f"{len(unit)} candidates")
        return found


class CandidateTable(NamedTuple):
    """Candidates of all people, for compiled code.

    Attributes:
        unit: (C, 2) the candidates of all groups, one group after the other.
        first, choices: (M,) index and number of each person's candidates; 0 choices: unknown.
        speed, radius, limit, relaxation: (M,) preferred speed (m/s), radius (m), largest
            acceleration (m/s^2), relaxation time (s).
    """

    unit: Array
    first: NDArray[np.int64]
    choices: NDArray[np.int64]
    speed: Array
    radius: Array
    limit: Array
    relaxation: Array


def candidate_table(people: int, choosers: Sequence[CandidateGroup]) -> CandidateTable:
    """Return the table of some groups among this many people."""
    first, count = np.zeros(people, np.int64), np.zeros(people, np.int64)
    speed, radius, limit = np.zeros(people), np.zeros(people), np.zeros(people)
    relaxation, units = np.ones(people), [np.zeros((0, 2))]
    for group in choosers:
        rows = group.rows
        first[rows], count[rows] = sum(map(len, units)), len(group.candidates.unit)
        speed[rows], radius[rows] = group.preferred_speed, group.radius
        limit[rows] = group.max_acceleration
        relaxation[rows] = group.candidates.relaxation_time
        units.append(np.asarray(group.candidates.unit, np.float64))
    return CandidateTable(np.concatenate(units), first, count, speed, radius, limit, relaxation)


class GoalChanges:
    """Builds ``crowdbot_msgs/PersonGoals``: people whose goal changed since the last sample."""

    def __init__(self, people: int) -> None:
        self._last = np.zeros((2, people))

    def message(self, first: int, goals: Array) -> Any | None:
        """Return the changes within the samples from ``first``, (K, 2, M); None without any."""
        with_last = np.concatenate([self._last[np.newaxis], goals]).view(np.int64)
        self._last = goals[-1].copy()
        changed = with_last[1:] != with_last[:-1]
        sample, person = np.nonzero(changed[:, 0] | changed[:, 1])
        if not len(sample):
            return None
        return ros.new(
            "crowdbot_msgs/PersonGoals",
            sample=(first + sample).astype(np.uint32),
            person=person.astype(np.uint32),
            x=goals[sample, 0, person],
            y=goals[sample, 1, person],
        )


class GoalsReader:
    """Goals at each sample, from all changes in a recording."""

    def __init__(self, people: int, messages: Iterable[Any]) -> None:
        """Read the changes.

        Raises:
            InputError: they are inconsistent, or do not match the number of people.
        """
        self._now = np.zeros((2, people))
        columns: list[tuple[Array, ...]] = [(m.sample, m.person, m.x, m.y) for m in messages]
        for sample, *others in columns:
            if any(len(other) != len(sample) for other in others):
                raise InputError("changes of goals have columns of unequal length")
        empty = (np.zeros(0),) * 4
        joined = [np.concatenate(c) for c in zip(empty, *columns, strict=True)]
        self._sample, self._person = joined[0].astype(np.int64), joined[1].astype(np.int64)
        self._x, self._y = joined[2], joined[3]
        if np.any(np.diff(self._sample) < 0) or np.any(self._person >= people):
            raise InputError("changes of goals are out of order, or of people who are not there")
        edges = np.flatnonzero(np.diff(self._sample, prepend=-1, append=-1)).tolist()
        self._changes = {int(self._sample[a]): slice(a, b) for a, b in pairwise(edges)}

    def goals(self, first: int, count: int) -> Array:
        """Return (K, 2, M) of the next ``count`` samples; call in order."""
        found = np.repeat(self._now[np.newaxis], count, axis=0)
        for k in range(count):
            here = self._changes.get(first + k)
            if here is not None:
                person = self._person[here]
                found[k:, 0, person], found[k:, 1, person] = self._x[here], self._y[here]
                self._now = found[-1].copy()
        return found
