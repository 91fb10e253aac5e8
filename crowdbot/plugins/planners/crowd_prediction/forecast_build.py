"""CrowdForecast: predicts people by the crowd engine, weighted by its recent accuracy.

Each person gets a wanted velocity, the mean of the last second, and decides by the crowd engine
among the others and the robot, which drives along its last plan. Two predictions made a second ago,
by the crowd engine and by constant velocity, are compared with people's present positions; their
mean square errors of the last seconds give the weights.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, ImaginedCrowd, Indices
from crowdbot.plugins.planners.crowd_prediction.seats_build import (
    leave_seats,
    mean_errors,
    seated,
    settle,
)

#: Preferred speeds of imagined people, m/s, and how many there are of each.
_SPEEDS, _EACH = np.linspace(0.3, 1.96, 12), 4
#: Slower people are predicted to stand, m/s.
STANDS = 0.2
#: Steps between two decisions.
STEPS = 2
#: Decisions that are predicted, and people at most, the nearest; the rest keep their velocity.
_DECISIONS, _MOST = 6, 20
#: Age at which a prediction is compared with the present, s.
_CHECKED = 1.0
#: Mean square error that both predictions have before there is any, m^2.
_DOUBT = 0.02
#: Numbers of people (M,), and what they want, (M, 2) m/s.
_NO_ONE = (np.zeros(0, np.int64), np.zeros((0, 2)))


class CheckedPrediction(NamedTuple):
    """Predictions for a time, s: numbers of people (N,), and where they would be, (N, 2) m."""

    t: float
    numbers: Indices
    kept: Array
    crowd: Array


class CrowdForecast:
    """Predicts the people of one run.

    Args:
        crowd: name of the crowd.
        settle_time: time over which wanted velocities are averaged, s.
        memory: time over which errors count, s.
    """

    def __init__(self, crowd: str, settle_time: float, memory: float) -> None:
        self._speeds = np.repeat(_SPEEDS, _EACH)
        self._crowd: ImaginedCrowd | None = None
        self._name, self._settle_time, self._memory = crowd, settle_time, memory
        self._wanted = _NO_ONE
        self._checked = deque[CheckedPrediction]()
        self._errors, self._t = (_DOUBT, _DOUBT), -math.inf

    @property
    def trust(self) -> float:
        """Return the weight of the crowd engine's prediction, 0 to 1."""
        kept, crowd = self._errors
        return kept**2 / (kept**2 + crowd**2)

    def reset(self) -> None:
        """Forget the last run; compile kernels."""
        if self._crowd is None:
            self._crowd = ImaginedCrowd(self._name, self._speeds)
        self._wanted, self._t = _NO_ONE, -math.inf
        self._checked.clear()
        numbers, people = np.arange(2), np.array([[1.0, 0.0, 1.0, 0.0, 0.2], [3.0, 0, -1, 0, 0.2]])
        for t in (0.0, _CHECKED):  # the second one checks the first
            self.predict(t, numbers, people, np.zeros((3, 2)), 0.3, _CHECKED)
        self._wanted, self._t = _NO_ONE, -math.inf
        self._checked.clear()
        self._errors = _DOUBT, _DOUBT

    def predict(
        self,
        t: float,
        numbers: Indices,
        people: Array,
        path: Array,
        radius: float | None,
        step: float,
    ) -> Array:
        """Return people's positions after each step, (T, N, 2), m.

        Args:
            t: s.
            numbers: (N,) numbers of the people, the same for the same person.
            people: (N, 5) x, y, vx, vy, radius; m, m/s.
            path: (T + 1, 2) places of the robot now and after each step, m.
            radius: the robot's, m; None: people do not see it.
            step: length of a step, s.
        """
        self._check(t, numbers, people)
        velocities = self._settle(t, numbers, people)
        times = step * np.arange(1, len(path))[:, np.newaxis, np.newaxis]
        kept = people[:, :2] + times * people[:, 2:4]
        crowd = self._roll(people, velocities, path, radius, step, kept) if len(numbers) else kept
        at = round(_CHECKED / step) - 1
        if len(numbers) and at < len(kept):
            self._checked.append(
                CheckedPrediction(t + step * (at + 1), numbers, kept[at], crowd[at])
            )
        return np.ascontiguousarray(kept + self.trust * (crowd - kept))

    def _check(self, t: float, numbers: Indices, people: Array) -> None:
        """Compare the predictions due now with people's present positions."""
        while self._checked and self._checked[0].t <= t + 1e-9:
            due = self._checked.popleft()
            count, kept, crowd = self._mean_errors(numbers, people, due)
            if count:
                fresh = 1.0 - math.exp(-max(t - self._t, 0.0) / self._memory)
                before = self._errors
                self._errors = (
                    before[0] + fresh * (kept - before[0]),
                    before[1] + fresh * (crowd - before[1]),
                )

    def _mean_errors(
        self, numbers: Indices, people: Array, due: CheckedPrediction
    ) -> tuple[int, float, float]:
        """Return the number of predicted people still present, and the mean square errors, m^2."""
        return mean_errors(numbers, people, due.numbers, due.kept, due.crowd)

    def _settle(self, t: float, numbers: Indices, people: Array) -> Array:
        """Return the wanted velocities (N, 2), the mean of what each person did lately, m/s."""
        fresh = 1.0 - math.exp(-max(t - self._t, 0.0) / self._settle_time)
        found = np.empty((len(numbers), 2))
        settle(numbers, people, *self._wanted, fresh, found)
        self._wanted, self._t = (numbers, found), t
        return found

    def _roll(
        self, people: Array, desired: Array, path: Array, radius: float | None, step: float,
        kept: Array,
    ) -> Array:  # fmt: skip
        """Return the positions (T, N, 2) of people predicted by the crowd engine, m.

        Those who stand, and those far away, keep their velocity, as in ``kept``.
        """
        assert self._crowd is not None
        taken, seats, slips = seated(people, desired, path[0], STANDS, _MOST, self._speeds)
        robots = np.hstack([path[:-1], np.diff(path, axis=0) / step])[::STEPS][:_DECISIONS]
        walked = self._crowd.walk(*taken, robots, radius, STEPS * step)
        out = kept.copy()
        leave_seats(*walked, seats, slips, (step, STEPS), out)
        return out
