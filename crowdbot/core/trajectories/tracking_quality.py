"""Quality of a planner's tracks of people, against the truth of the recording.

A track and a person within half a metre of each other may be a pair; the pairs of each instant have
the least sum of distances, as in CLEAR-MOT (Bernardin, Stiefelhagen, "Evaluating multiple object
tracking performance", EURASIP Journal on Image and Video Processing, 2008).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: Largest distance of a pair, m. False tracks are counted this far inside the distance in question.
PAIR = 0.5
#: The tracker has this time to begin, s.
_BEGIN = 1.0
#: Drawings: number, x, y, vx, vy in the robot's base frame.
_NUMBER, _PLACE, _VELOCITY = 0, slice(1, 3), slice(3, 5)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingQuality:
    """The quality of tracks of people within a distance of the robot, over all instants.

    Attributes:
        within: distance, m.
        people: pairs of an instant and a person within the distance.
        recall: share of them that have a track; None without any.
        false: share of the tracks within the distance that have no person; None without any.
        switches: how often a person's track got another number, for each minute of a person.
        position_error, velocity_error: of pairs, rms, m and m/s.
    """

    within: float
    people: int
    recall: float | None
    false: float | None
    switches: float | None
    position_error: float | None
    velocity_error: float | None


class _Instant(NamedTuple):
    """One drawing of tracks beside the true people, in the robot's base frame."""

    numbers: Array
    people: NDArray[np.int64]
    tracked_away: Array
    away: Array
    tracks: NDArray[np.int64]
    persons: NDArray[np.int64]
    gaps: Array
    velocity_gaps: Array


def tracking_quality(
    run: Trajectories, tracks: Sequence[tuple[float, Array]], within: Sequence[float]
) -> list[TrackingQuality]:
    """Return the quality of tracks within each of some distances.

    Args:
        run: with a robot and people.
        tracks: times (s) and rows (K, 5) of the drawing ``tracks``.
        within: distances from the robot, m.
    """
    instants = [_instant(run, t, rows) for t, rows in tracks if t >= _BEGIN]
    times = [t for t, _ in tracks]
    period = float(np.median(np.diff(times))) if len(times) > 1 else math.nan
    return [_quality(instants, distance, period) for distance in within]


def _instant(run: Trajectories, t: float, rows: Array) -> _Instant:
    """Return the pairs of one drawing and the nearest sample of the truth."""
    from scipy.optimize import linear_sum_assignment

    assert run.robot is not None
    assert run.agents is not None
    at = int(np.argmin(np.abs(run.t - t)))
    yaw = float(run.robot.theta[at])
    rotation = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    here = np.flatnonzero(np.isfinite(run.agents.x[at]))
    x, y = run.agents.x[at, here] - run.robot.x[at], run.agents.y[at, here] - run.robot.y[at]
    places = np.column_stack([x, y]) @ rotation
    going = np.column_stack([run.agents.vx[at, here], run.agents.vy[at, here]]) @ rotation
    gaps = np.hypot(*(rows[:, None, _PLACE] - places[None]).T).T
    tracked, persons = linear_sum_assignment(np.where(gaps <= PAIR, gaps, 1e3))
    pairs = gaps[tracked, persons] <= PAIR
    tracked, persons = tracked[pairs], persons[pairs]
    return _Instant(
        numbers=rows[:, _NUMBER],
        people=run.agents.id[here],
        tracked_away=np.hypot(*rows[:, _PLACE].T),
        away=np.hypot(*places.T),
        tracks=tracked,
        persons=persons,
        gaps=gaps[tracked, persons],
        velocity_gaps=np.hypot(*(rows[tracked, _VELOCITY] - going[persons]).T),
    )


def _quality(instants: Sequence[_Instant], within: float, period: float) -> TrackingQuality:
    people = met = tracks = false = switches = 0
    last: dict[int, float] = {}
    gaps: list[Array] = []
    velocity_gaps: list[Array] = []
    for one in instants:
        near = one.away <= within
        people += int(near.sum())
        inside = one.tracked_away <= max(0.0, within - PAIR)
        tracks += int(inside.sum())
        false += int(inside.sum() - inside[one.tracks].sum())
        pairs = near[one.persons]
        met += int(pairs.sum())
        gaps.append(one.gaps[pairs])
        velocity_gaps.append(one.velocity_gaps[pairs])
        for k in np.flatnonzero(pairs):
            person, number = int(one.people[one.persons[k]]), float(one.numbers[one.tracks[k]])
            switches += last.get(person, number) != number
            last[person] = number
    return TrackingQuality(
        within=within,
        people=people,
        recall=met / people if people else None,
        false=false / tracks if tracks else None,
        switches=switches / (people * period / 60.0) if people and period > 0.0 else None,
        position_error=_rms(gaps),
        velocity_error=_rms(velocity_gaps),
    )


def _rms(parts: Sequence[Array]) -> float | None:
    values = np.concatenate(parts) if parts else np.zeros(0)
    return float(np.sqrt(np.mean(values**2))) if len(values) else None
