"""Features of one encounter, the same for recorded and simulated people."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crowdbot.core.realism.near_robots.clip import gap_at
from crowdbot.core.realism.near_robots.encounters import BODY, RobotEncounter
from crowdbot.core.types.arrays import Array

#: Names and units of the features. Onsets are NaN where the person never evades, and
#: ``passes_first`` where person and robot do not cross.
FEATURES = {
    "gap": "m",
    "onset_ttc": "s",
    "onset_gap": "m",
    "deviation": "m",
    "lateral_acceleration": "m/s²",
    "braking": "m/s²",
    "slowest": "",
    "evades": "",
    "passes_first": "",
}
#: Features of which the mean counts, not the distribution.
SHARES = ("evades", "passes_first")
#: Least rise of the predicted gap that is an evasion, m; the share of it that marks the onset.
_RISE, _QUARTER = 0.1, 0.25


def features_of(encounters: Sequence[RobotEncounter], people: Sequence[Array]) -> Array:
    """Return (E, F) features of people in encounters, NaN where undefined.

    Args:
        encounters: what they meet.
        people: per encounter (K, 2) positions, smoothed, m: recorded or simulated.
    """
    rows = [_row(e, person) for e, person in zip(encounters, people, strict=True)]
    return np.array(rows).reshape(-1, len(FEATURES))


def _row(e: RobotEncounter, person: Array) -> list[float]:
    dt = float(e.t[1] - e.t[0])
    gap = e.gap(person)
    closest = int(np.argmin(gap))
    until = slice(0, max(closest, 3) + 1)
    velocity = np.gradient(person, dt, axis=0)
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    acceleration = np.gradient(velocity, dt, axis=0)
    facing = velocity / np.maximum(speed, 0.05)[:, np.newaxis]
    along = np.sum(acceleration * facing, axis=1)
    across = facing[:, 0] * acceleration[:, 1] - facing[:, 1] * acceleration[:, 0]
    onset = _onset(e, person, velocity, closest)
    return [
        float(gap.min()),
        math.nan if onset is None else _time_to_meet(e) - e.t[onset],
        math.nan if onset is None else float(gap[onset]),
        _deviation(e, person, until),
        float(np.quantile(np.abs(across[until]), 0.95)),
        float(max(0.0, np.quantile(-along[until], 0.95))),
        float(speed[until].min() / max(math.hypot(*e.velocity), 1e-6)),
        float(onset is not None),
        _passes_first(e, person),
    ]


def _time_to_meet(e: RobotEncounter) -> float:
    """Return when the person, walking straight on, would first come as near as it would, s."""
    gap = e.gap(e.straight)
    return float(e.t[np.argmax(gap <= max(0.0, float(gap.min()) + 1e-9))])


def _onset(e: RobotEncounter, person: Array, velocity: Array, closest: int) -> int | None:
    """Return the row at which a quarter of the rise of the predicted gap is done, if it rises."""
    if closest < 2:
        return None
    now, later = np.arange(closest + 1)[:, np.newaxis], np.arange(len(e.t))[np.newaxis]
    ahead = e.t[later] - e.t[now]
    x = person[: closest + 1, :1] + velocity[: closest + 1, :1] * ahead
    y = person[: closest + 1, 1:] + velocity[: closest + 1, 1:] * ahead
    gap = gap_at(e.pose[np.newaxis], e.footprint, x, y) - BODY
    predicted = np.where(ahead >= 0.0, gap, np.inf).min(axis=1)
    rise = predicted[-1] - predicted[0]
    if rise < _RISE:
        return None
    return int(np.argmax(predicted >= predicted[0] + _QUARTER * rise))


def _deviation(e: RobotEncounter, person: Array, until: slice) -> float:
    """Return the largest distance from the straight line, m."""
    dx, dy = (person[until] - person[0]).T
    size = math.hypot(*e.velocity)
    return float(np.abs(e.velocity[0] * dy - e.velocity[1] * dx).max() / size)


def _passes_first(e: RobotEncounter, person: Array) -> float:
    """Return 1 if the person crosses in front of the robot, 0 if behind it, else NaN."""
    if e.kind != "cross":
        return math.nan
    dx, dy = person[:, 0] - e.pose[:, 0], person[:, 1] - e.pose[:, 1]
    c, s = np.cos(e.pose[:, 2]), np.sin(e.pose[:, 2])
    ahead, aside = c * dx + s * dy, c * dy - s * dx
    change = np.flatnonzero(aside[:-1] * aside[1:] <= 0.0)
    if len(change):
        return float(ahead[change[0]] > 0.0)
    return 0.0 if ahead[-1] < 0.0 else math.nan
