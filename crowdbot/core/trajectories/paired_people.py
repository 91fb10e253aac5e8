"""The same people with and without the robot: each person's displacement and delay.

People are matched by id, their trips by number. A trip with the robot is compared with the same
trip without it: sideways distance from that path is displacement, lag along it is delay. So a
person who walks the same path later is delayed but not displaced.

A crowd is chaotic: two runs that differ by 2 cm at the start are unrelated after a minute, even
without a robot. So people are compared over the whole run and, separately, over their first meeting
with the robot, if until then they walked as they do without it. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.encounters import encounter, people
from crowdbot.core.trajectories.path_overlay import follow, longest_parts
from crowdbot.core.trajectories.preprocess import inf_to_nan, valid_agent_steps
from crowdbot.core.trajectories.trajectories import Trajectories, cached_beside
from crowdbot.core.trajectories.trips import trip_samples
from crowdbot.core.types.arrays import Array, Mask

#: Number of samples before and after the last match in which a person is searched.
WINDOW = 48
#: Time shift beyond which a person counts as affected, s.
SAME_PACE = 0.1
#: Tolerances for who is near and who is unaffected, m and s.
_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Effects:
    """The effect on each person, (P,), by id.

    Attributes:
        displacement: largest distance from the path without the robot, m.
        delay: time lost, s; negative: gained.
        speed: mean walking speed without the robot, m/s.
        left_out: number of trips, or people met, not compared because they start elsewhere.
    """

    displacement: Array
    delay: Array
    speed: Array
    left_out: int

    def __len__(self) -> int:
        """Return the number of people."""
        return len(self.speed)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pairing:
    """Rules for the people and times that are compared.

    Attributes:
        same_start: largest distance between the starts with and without the robot, m.
        reach: distance between centres within which a person meets the robot, m.
        after: time that a meeting continues after the person is out of reach, s.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """

    same_start: float
    reach: float
    after: float
    jump_speed: float


@dataclass(frozen=True, slots=True)
class _TripSamples:
    """One trip: its samples; (3, K) x, y and time since its start; its duration."""

    rows: slice
    column: int
    path: Array
    seconds: float
    reached: bool


@dataclass(frozen=True)
class _Pair:
    """One trip of a person with and without the robot."""

    person: int
    one: _TripSamples
    two: _TripSamples

    @cached_property
    def laid(self) -> tuple[Array, Array]:
        """Return `_laid_over` of both trips; not called for trips that are left out."""
        return _laid_over(self.one, self.two)


def whole_effects(run: Trajectories, alone: Trajectories, pairing: Pairing) -> Effects:
    """Return the effects on all people, over trips that exist and start alike in both runs.

    Args:
        run: the whole run.
        alone: the same people without robot.
        pairing: who is compared.
    """
    key = "whole_effects", pairing
    return cached_beside(run, alone, key, lambda: _whole_effects(run, alone, pairing))


def meeting_effects(run: Trajectories, alone: Trajectories, pairing: Pairing) -> Effects:
    """Return the effects on people who meet the robot, over their first meeting.

    Only people who until then walk as without the robot count: the others were disturbed before,
    for unknown reasons. The run must have a robot; otherwise as `whole_effects`.
    """
    key = "meeting_effects", pairing
    return cached_beside(run, alone, key, lambda: _meeting_effects(run, alone, pairing))


def _whole_effects(run: Trajectories, alone: Trajectories, pairing: Pairing) -> Effects:
    found: dict[int, list[tuple[float, float, float, float]]] = {}
    left_out = 0
    for pair in _pairs(run, alone, pairing.jump_speed):
        if _starts_apart(pair, pairing):
            left_out += 1
            continue
        effect = float(pair.laid[0].max()), _delay(pair)
        found.setdefault(pair.person, []).append((*effect, *_walked(pair.two)))
    people = [np.array(trips) for trips in found.values()]
    return Effects(
        displacement=np.array([trips[:, 0].max() for trips in people]),
        delay=np.array([trips[:, 1].sum() for trips in people]),
        speed=np.array([trips[:, 2].sum() / trips[:, 3].sum() for trips in people]),
        left_out=left_out,
    )


def _meeting_effects(run: Trajectories, alone: Trajectories, pairing: Pairing) -> Effects:
    distance = encounter(run, pairing.jump_speed).distance
    near = np.ascontiguousarray((distance <= pairing.reach + _TOLERANCE).T)
    rows, met, left_out = [], set[int](), 0
    for pair in _pairs(run, alone, pairing.jump_speed):
        one = pair.one
        first, last = _meeting(near[one.column, one.rows], run.t[one.rows], pairing)
        if pair.person in met or first < 0:
            continue
        met.add(pair.person)
        if _starts_apart(pair, pairing) or _walks_otherwise(pair, first, pairing):
            left_out += 1
            continue
        beside, late = pair.laid
        length, seconds = _walked(pair.two)
        most = float(beside[first : last + 1].max() - beside[first])
        rows.append((most, float(late[last] - late[first]), length / seconds))
    table = np.array(rows).reshape(-1, 3)
    return Effects(
        displacement=table[:, 0], delay=table[:, 1], speed=table[:, 2], left_out=left_out
    )


def _pairs(run: Trajectories, alone: Trajectories, jump_speed: float) -> list[_Pair]:
    """Return trips that exist in both runs, by person and number."""

    def match() -> list[_Pair]:
        ways, others = _ways(run, jump_speed), _ways(alone, jump_speed)
        both = sorted(ways.keys() & others.keys())
        return [_Pair(k[0], ways[k], others[k]) for k in both]

    return cached_beside(run, alone, ("pairs", jump_speed), match)


def _starts_apart(pair: _Pair, pairing: Pairing) -> bool:
    one, two = pair.one.path, pair.two.path
    apart = math.hypot(one[0, 0] - two[0, 0], one[1, 0] - two[1, 0])
    return apart > pairing.same_start + _TOLERANCE


def _walks_otherwise(pair: _Pair, sample: int, pairing: Pairing) -> bool:
    """Return True if a person is elsewhere than without the robot, or there at another time."""
    beside, late = pair.laid
    moved = beside[sample] > pairing.same_start + _TOLERANCE
    return bool(moved or abs(late[sample]) > SAME_PACE + _TOLERANCE)


def _meeting(within: Mask, t: Array, pairing: Pairing) -> tuple[int, int]:
    """Return first and last sample (of a trip) of the first meeting; -1, -1 if there is none.

    Args:
        within: (K,) samples at which the person is within reach; t: (K,), s.
    """
    near = within.nonzero()[0]
    if not len(near):
        return -1, -1
    ends = np.flatnonzero(np.diff(t[near]) > pairing.after + _TOLERANCE)
    out = near[ends[0]] if len(ends) else near[-1]
    last = int(np.searchsorted(t, t[out] + pairing.after + _TOLERANCE, side="right")) - 1
    return int(near[0]), last


def _delay(pair: _Pair) -> float:
    """Return the time lost on a whole trip, s."""
    one, two = pair.one, pair.two
    if one.reached and two.reached:
        return one.seconds - two.seconds
    if one.reached:  # only the other one is cut off
        return -float(_laid_over(two, one)[1][-1])
    return float(pair.laid[1][-1])


def _laid_over(one: _TripSamples, two: _TripSamples) -> tuple[Array, Array]:
    """Return, at each sample (K,), the distance from the other path (m) and the delay there (s)."""
    beside, late = np.empty((2, one.path.shape[1]))
    follow(one.path, two.path, WINDOW, beside, late)
    return beside, late


def _ways(run: Trajectories, jump_speed: float) -> dict[tuple[int, int], _TripSamples]:
    """Return person and number of the trip -> its path; with at least two samples."""
    agents, trips = people(run), run.trips
    if trips is None or not agents.x.size:
        return {}
    x, y = inf_to_nan(agents.x), inf_to_nan(agents.y)
    parts = _continuous(run, jump_speed).tolist()
    found: dict[tuple[int, int], _TripSamples] = {}
    count: dict[int, int] = {}
    for k in np.lexsort((trips.t0, trips.agent)).tolist():
        person, (first, end, column) = int(trips.agent[k]), parts[k]
        count[person] = count.get(person, 0) + 1
        if end - first < 2:
            continue
        rows, path = slice(first, end), np.empty((3, end - first))
        path[0], path[1] = x[rows, column], y[rows, column]
        np.subtract(run.t[rows], trips.t0[k], out=path[2])
        found[person, count[person]] = _TripSamples(
            rows=rows,
            column=column,
            path=path,
            seconds=float(trips.t1[k] - trips.t0[k]),
            reached=bool(trips.reached[k]),
        )
    return found


def _continuous(run: Trajectories, jump_speed: float) -> NDArray[np.int64]:
    """Return, for each trip (K, 3), the longest part without teleport or absence.

    Its first sample, the one after its last, and the person's column; no samples without a column.
    """
    valid = valid_agent_steps(run.t, people(run), jump_speed)
    first, last, column = trip_samples(run)
    parts = np.zeros((len(column), 3), np.int64)
    parts[:, 2] = column
    longest_parts(valid, first, last, column, parts)
    return parts


def _walked(way: _TripSamples) -> tuple[float, float]:
    """Return length (m) and duration (s) of the observed part of a trip."""
    x, y, t = way.path
    length = np.hypot(x[1:] - x[:-1], y[1:] - y[:-1]).sum()
    return float(length), float(t[-1] - t[0])
