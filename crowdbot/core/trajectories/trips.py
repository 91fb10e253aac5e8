"""Trips of people: durations, Kaplan-Meier means, and walked distances.

K trips, N samples, M people; SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.encounters import encounter, people
from crowdbot.core.trajectories.preprocess import (
    TIME_TOLERANCE,
    inf_to_nan,
    present,
    valid_agent_steps,
)
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask

#: Durations are compared after rounding to this many decimals of a second.
DECIMALS = 9
#: Tolerance of the neighbour rule, m.
DISTANCE_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Durations:
    """Durations (K,) of trips, s, and if each was completed; otherwise it lasted longer."""

    seconds: Array
    reached: Mask

    def __len__(self) -> int:
        """Return the number of trips."""
        return len(self.seconds)

    @property
    def longest(self) -> float:
        """Return the longest duration of all trips, completed or not, s."""
        return float(self.seconds.max())

    @property
    def open_ended(self) -> bool:
        """Return True if an unfinished trip is among the longest, so that the mean is unknown."""
        return bool(np.any(~self.reached & (self.seconds == self.longest)))

    def completed_mean(self) -> float | None:
        """Return the arithmetic mean of completed trips, s; None without any."""
        return float(self.seconds[self.reached].mean()) if self.reached.any() else None

    def restricted_mean(self, limit: float) -> float:
        """Return the area under the product-limit (Kaplan-Meier) curve up to ``limit`` (s), in s.

        At ties, completions come before censorings.
        """
        events = np.unique(self.seconds[self.reached & (self.seconds <= limit)])
        ordered = np.sort(self.seconds)
        at_risk = len(ordered) - np.searchsorted(ordered, events, side="left")
        done = np.sort(self.seconds[self.reached])
        ended = np.searchsorted(done, events, "right") - np.searchsorted(done, events, "left")
        survival = np.concatenate([[1.0], np.cumprod(1.0 - ended / at_risk)])
        return float(survival @ np.diff(np.concatenate([[0.0], events, [limit]])))

    def select(self, rows: Mask) -> Durations:
        """Return some of the trips."""
        return Durations(self.seconds[rows], self.reached[rows])


@dataclass(frozen=True, slots=True)
class MeanPace:
    """Time (s) and displacement (m) of a number of trips, summed up."""

    trips: int
    seconds: float
    metres: float

    @property
    def value(self) -> float | None:
        """Return the pace, s/m; None where there was no displacement."""
        return self.seconds / self.metres if self.metres > DISTANCE_TOLERANCE else None


def durations(run: Trajectories) -> Durations:
    """Return durations of all trips of a run that ends at the arrival."""
    trips = run.trips
    if trips is None:
        return Durations(np.empty(0), np.empty(0, dtype=bool))
    return Durations(np.round(trips.t1 - trips.t0, DECIMALS), trips.reached)


def meets_robot(run: Trajectories, radius: float) -> Mask:
    """Return trips (K,) that bring the person within ``radius`` (m) of the robot at some sample."""
    if run.trips is None:
        return np.empty(0, dtype=bool)
    # teleports do not affect distances, so any jump speed works
    near = encounter(run, np.inf).distance <= radius + DISTANCE_TOLERANCE
    first, last, column = trip_samples(run)
    seen = np.concatenate([np.zeros((1, near.shape[1]), dtype=np.int64), near.cumsum(axis=0)])
    met = np.zeros(len(column), dtype=bool)
    known = (column >= 0) & (last >= first)
    met[known] = (seen[last + 1, column] > seen[first, column])[known] if near.size else False
    return met


def walked_distances(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    """Return path length and straight displacement of each trip (K,), (K,), m.

    Both from the samples inside the trip; teleports add no length.
    """
    return run.cached(("walked_distances", jump_speed), lambda: _walked_distances(run, jump_speed))


def _walked_distances(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    agents = people(run)
    first, last, column = trip_samples(run)
    length, displacement = np.zeros(len(column)), np.zeros(len(column))
    known = (column >= 0) & (last > first)
    if not known.any():
        return length, displacement
    valid = valid_agent_steps(run.t, agents, jump_speed)
    a, b, c = first[known], last[known], column[known]
    x, y = inf_to_nan(agents.x), inf_to_nan(agents.y)
    steps = np.where(valid, np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)), 0.0)
    so_far = np.concatenate([np.zeros((1, steps.shape[1])), steps.cumsum(axis=0)])
    length[known] = so_far[b, c] - so_far[a, c]
    displacement[known] = _displacement(x, y, valid, (a, b, c))
    return length, displacement


def mean_pace(run: Trajectories, jump_speed: float, trips: Mask | None = None) -> MeanPace:
    """Return the mean pace of people on their trips, finished or not: time over displacement.

    The displacement of a trip is the straight distance from its first to its last sample, so that
    a detour counts as a delay. A trip without two samples is left out.

    Args:
        trips: (K,) which trips; None: all.
    """
    _, straight = walked_distances(run, jump_speed)
    first, last, column = trip_samples(run)
    seen = (column >= 0) & (last > first)
    seen = seen if trips is None else seen & trips
    seconds = float((run.t[last[seen]] - run.t[first[seen]]).sum())
    return MeanPace(int(seen.sum()), seconds, float(straight[seen].sum()))


def displacement(x: Array, y: Array) -> float:
    """Return the distance of a body's last known position from its first one (N,), (N,), m."""
    known = np.flatnonzero(present(x, y))
    if not len(known):
        return 0.0
    first, last = known[0], known[-1]
    return float(np.hypot(x[last] - x[first], y[last] - y[first]))


def _displacement(
    x: Array,
    y: Array,
    valid: Mask,
    rows: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]],
) -> Array:
    """Return the distance from the first to the last known position between two samples, m."""
    first, last, column = rows
    here = present(x, y)
    index = np.arange(len(x))[:, None]
    before = np.maximum.accumulate(np.where(here, index, -1), axis=0)
    after = np.minimum.accumulate(np.where(here, index, len(x))[::-1], axis=0)[::-1]
    a, b = after[first, column], before[last, column]
    seen = a < b
    a, b = np.where(seen, a, 0), np.where(seen, b, 1)
    # two trips may share the sample at a portal: it belongs to the trip on its side of the jump
    teleport = here[1:] & here[:-1] & ~valid
    a, b = a + teleport[a, column], b - teleport[b - 1, column]
    straight = np.hypot(x[b, column] - x[a, column], y[b, column] - y[a, column])
    return np.where(seen & (a < b), straight, 0.0)


def trip_samples(
    run: Trajectories,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return first and last sample of each trip, and the person's column (-1: unknown)."""
    trips, ids = run.trips, people(run).id
    if trips is None:
        none = np.empty(0, dtype=np.int64)
        return none, none, none
    first = np.searchsorted(run.t, trips.t0 - TIME_TOLERANCE, side="left")
    last = np.searchsorted(run.t, trips.t1 + TIME_TOLERANCE, side="right") - 1
    column = np.full(len(trips.agent), -1)
    if len(ids):
        order = np.argsort(ids)
        slot = np.clip(np.searchsorted(ids[order], trips.agent), 0, len(ids) - 1)
        column = np.where(ids[order][slot] == trips.agent, order[slot], -1)
    return first, last, column
