"""Observation of the nearest people."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, Indices, kernel
from crowdbot.plugin.for_learning import LearningContext, RobotInputs
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion
from crowdbot.plugins.observations.tracks import TracksSpec

_COLUMNS = 6


class TrackRows:
    """Sorts people by distance; keeps no memory but scratch."""

    def __init__(self, spec: TracksSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        self._away, self._which = np.zeros(spec.people), np.zeros(spec.people, np.int64)
        row = ((1, 0.0, 1.0), (4, -1.0, 1.0), (1, 0.0, 2.0))
        self.low, self.high = bounds(*row * spec.people, (1, 0.0, 1.0), (SIZE - 1, -1.0, 1.0))

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): people, goal, motion."""
        spec, worlds = self._spec, len(seen.pose)
        found = np.zeros((worlds, len(self.low)), np.float32)
        yaw = seen.pose[:, 2]
        _write_tracks(
            seen.people, seen.pose, np.cos(yaw), np.sin(yaw), spec.range, spec.fastest,
            self._away, self._which, found,
        )  # fmt: skip
        found[:, _COLUMNS * spec.people :] = goal_and_motion(seen, self._limits, spec.goal_range)
        return found


@kernel
def _write_tracks(
    people: Array, pose: Array, cos: Array, sin: Array, most: float, fastest: float, away: Array,
    which: Indices, found: NDArray[np.float32],
) -> None:  # fmt: skip
    """Write the rows of the nearest people to ``found``; the rest of it is unchanged.

    Args:
        people, pose: as in `RobotInputs`.
        cos, sin: (W,) of the headings.
        most, fastest: range, m, and speed that is shown as 1, m/s.
        away, which: (K,) scratch.
        found: (W, >= 6 K) output.
    """
    for w in range(people.shape[0]):
        count = _nearest(people[w], pose[w, 0], pose[w, 1], most, away, which)
        c, s = cos[w], sin[w]
        for k in range(count):
            person, first = people[w, which[k]], _COLUMNS * k
            dx, dy, vx, vy = person[0] - pose[w, 0], person[1] - pose[w, 1], person[2], person[3]
            found[w, first] = 1.0
            found[w, first + 1] = (c * dx + s * dy) / most
            found[w, first + 2] = (c * dy - s * dx) / most
            found[w, first + 3] = max(-1.0, min(1.0, (c * vx + s * vy) / fastest))
            found[w, first + 4] = max(-1.0, min(1.0, (c * vy - s * vx) / fastest))
            found[w, first + 5] = person[4]


@kernel
def _nearest(people: Array, x: float, y: float, most: float, away: Array, which: Indices) -> int:
    """Write distances and rows of the nearest people (M, 5) within range; return their number.

    At equal distances, earlier rows come first.
    """
    count, room = 0, away.shape[0]
    for j in range(people.shape[0]):
        distance = math.hypot(people[j, 0] - x, people[j, 1] - y)
        if not distance <= most or (count == room and distance >= away[room - 1]):
            continue  # NaN: absent
        count = min(count + 1, room)
        k = count - 1
        while k > 0 and away[k - 1] > distance:
            away[k], which[k] = away[k - 1], which[k - 1]
            k -= 1
        away[k], which[k] = distance, j
    return count


build = TrackRows
