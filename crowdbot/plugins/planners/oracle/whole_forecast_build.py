"""WholeForecast: as `CrowdForecast`, of all who are near, for the whole of a plan.

It takes twice the time; `CrowdForecast` predicts the 20 nearest for two seconds. The reference
scores of `oracle` are with this one.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, Indices
from crowdbot.plugins.planners.crowd_prediction.forecast_build import CrowdForecast

#: Slower people are predicted to stand, m/s.
_STANDS = 0.2
#: Distance of the goals of people, m.
_FAR = 20.0
#: Steps between two decisions.
_STEPS = 2
#: Age at which a prediction is compared with the present, s.
_CHECKED = 1.0
#: Mean square error that both predictions have before there is any, m^2.
_DOUBT = 0.02


class _Checked(NamedTuple):
    """Predictions for a time, s: numbers of people (N,), and where they would be, (N, 2) m."""

    t: float
    numbers: Indices
    kept: Array
    crowd: Array


class WholeForecast(CrowdForecast):
    """Predicts the people of one run.

    Args:
        crowd: name of the crowd.
        settle_time: time over which wanted velocities are averaged, s.
        memory: time over which errors count, s.
    """

    def __init__(self, crowd: str, settle_time: float, memory: float) -> None:
        super().__init__(crowd, settle_time, memory)
        self._wishes: dict[int, Array] = {}
        self._due = deque[_Checked]()
        self._mean_errors = np.full(2, _DOUBT)

    @property
    def trust(self) -> float:
        """Return the weight of the crowd's prediction, 0 to 1."""
        kept, crowd = self._mean_errors
        return float(kept**2 / (kept**2 + crowd**2))

    def reset(self) -> None:
        """Forget the last run; compile what is not compiled yet."""
        super().reset()
        self._wishes, self._t = {}, -math.inf
        self._due.clear()
        self._mean_errors = np.full(2, _DOUBT)
        numbers, people = np.arange(2), np.array([[1.0, 0.0, 1.0, 0.0, 0.2], [3.0, 0, -1, 0, 0.2]])
        self.predict(0.0, numbers, people, np.zeros((3, 2)), 0.3, 0.16)
        self._wishes, self._t = {}, -math.inf
        self._due.clear()

    def predict(
        self,
        t: float,
        numbers: Indices,
        people: Array,
        path: Array,
        radius: float | None,
        step: float,
    ) -> Array:
        """Return where people will be after each step, (T, N, 2), m.

        Args:
            t: s.
            numbers: (N,) numbers of the people, the same for the same person.
            people: (N, 5) x, y, vx, vy, radius; m, m/s.
            path: (T + 1, 2) places of the robot now and after each step, m.
            radius: the robot's, m; None: people do not see it.
            step: length of a step, s.
        """
        self._check(t, numbers, people)
        wanted = self._settle(t, numbers, people)
        times = step * np.arange(1, len(path))[:, np.newaxis, np.newaxis]
        kept = people[:, :2] + times * people[:, 2:4]
        crowd = self._rolled(people, wanted, path, radius, step) if len(numbers) else kept
        at = round(_CHECKED / step) - 1
        if len(numbers) and at < len(kept):
            self._due.append(_Checked(t + step * (at + 1), numbers, kept[at], crowd[at]))
        return np.ascontiguousarray(kept + self.trust * (crowd - kept))

    def _check(self, t: float, numbers: Indices, people: Array) -> None:
        """Compare predictions that were for now with now."""
        while self._due and self._due[0].t <= t + 1e-9:
            due = self._due.popleft()
            _, then, now = np.intersect1d(due.numbers, numbers, return_indices=True)
            if not len(now):
                continue
            here = people[now, :2]
            off = [np.mean(np.sum((p[then] - here) ** 2, axis=1)) for p in (due.kept, due.crowd)]
            fresh = 1.0 - math.exp(-max(t - self._t, 0.0) / self._memory)
            self._mean_errors += fresh * (np.array(off) - self._mean_errors)

    def _settle(self, t: float, numbers: Indices, people: Array) -> Array:
        """Return the wanted velocities (N, 2), the mean of what each person did lately, m/s."""
        fresh = 1.0 - math.exp(-max(t - self._t, 0.0) / self._settle_time)
        found = {}
        for number, velocity in zip(numbers.tolist(), people[:, 2:4], strict=True):
            before = self._wishes.get(number)
            found[number] = velocity if before is None else before + fresh * (velocity - before)
        self._wishes, self._t = found, t
        return np.array(list(found.values())).reshape(-1, 2)

    def _rolled(
        self, people: Array, wanted: Array, path: Array, radius: float | None, step: float
    ) -> Array:
        """Return where people will be who decide as the crowd does, (T, N, 2), m."""
        assert self._crowd is not None
        speed = np.hypot(wanted[:, 0], wanted[:, 1])
        seats, taken = self._seats(speed)
        size = len(self._speeds)
        position, velocity = np.full((size, 2), 1e6), np.zeros((size, 2))
        goal, present = np.full((size, 2), 1e6 + 1.0), np.zeros(size, np.bool_)
        position[taken], velocity[taken] = people[seats, :2], people[seats, 2:4]
        goal[taken] = people[seats, :2] + _FAR * wanted[seats] / speed[seats, np.newaxis]
        present[taken] = True
        # The seats' speeds are a few per cent off; so is the way.
        off = (1.0 - self._speeds[taken] / speed[seats])[:, np.newaxis] * wanted[seats]
        out = people[:, :2] + step * np.arange(1, len(path))[:, None, None] * people[:, 2:4]
        robots = np.hstack([path[:-1], np.diff(path, axis=0) / step])[::_STEPS]
        dt, steps = _STEPS * step, np.arange(len(out))
        places, speeds, pulls = self._crowd.walk(
            position, velocity, goal, present, robots, radius, dt
        )
        since = ((steps % _STEPS + 1) / _STEPS)[:, np.newaxis, np.newaxis]
        before, pull = (a[:, taken][steps // _STEPS] for a in (speeds, pulls))
        middle = before + 0.5 * since * (before + dt * pull - before)
        moved = places[:, taken][steps // _STEPS] + since * dt * middle
        out[:, seats] = moved + step * (steps + 1)[:, np.newaxis, np.newaxis] * off
        return out

    def _seats(self, speed: Array) -> tuple[Indices, Indices]:
        """Return people who walk, and the imagined person of the nearest speed for each of them."""
        free = np.ones(len(self._speeds), np.bool_)
        people, seats = [], []
        for i in np.flatnonzero(speed >= _STANDS):
            if not free.any():
                break
            off = np.where(free, np.abs(self._speeds - speed[i]), np.inf)
            seat = int(np.argmin(off))
            free[seat] = False
            people.append(int(i))
            seats.append(seat)
        return np.array(people, np.int64), np.array(seats, np.int64)
