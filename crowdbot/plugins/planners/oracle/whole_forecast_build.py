"""WholeForecast: `CrowdForecast` for all people nearby and the whole plan.

It takes twice the time; `CrowdForecast` predicts the 20 nearest for two seconds. The reference
scores of `oracle` are with this one. Its sums are kept in numpy's order: the compiled ones of
`CrowdForecast` differ in the last bits, and seats go to the nearest first there.
"""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array, Indices
from crowdbot.plugins.planners.crowd_prediction.forecast_build import (
    STANDS,
    STEPS,
    CheckedPrediction,
    CrowdForecast,
)

#: Distance of the goals of people, m.
_FAR = 20.0


class WholeForecast(CrowdForecast):
    """Predicts all people of one run, for the whole of a plan; arguments as in `CrowdForecast`."""

    def _mean_errors(
        self, numbers: Indices, people: Array, due: CheckedPrediction
    ) -> tuple[int, float, float]:
        _, then, now = np.intersect1d(due.numbers, numbers, return_indices=True)
        if not len(now):
            return 0, 0.0, 0.0
        here = people[now, :2]
        kept, crowd = (
            float(np.mean(np.sum((p[then] - here) ** 2, axis=1))) for p in (due.kept, due.crowd)
        )
        return len(now), kept, crowd

    def _roll(
        self, people: Array, desired: Array, path: Array, radius: float | None, step: float,
        kept: Array,
    ) -> Array:  # fmt: skip
        assert self._crowd is not None
        speed = np.hypot(desired[:, 0], desired[:, 1])
        seats, taken = self._seats(speed)
        size = len(self._speeds)
        position, velocity = np.full((size, 2), 1e6), np.zeros((size, 2))
        goal, present = np.full((size, 2), 1e6 + 1.0), np.zeros(size, np.bool_)
        position[taken], velocity[taken] = people[seats, :2], people[seats, 2:4]
        goal[taken] = people[seats, :2] + _FAR * desired[seats] / speed[seats, np.newaxis]
        present[taken] = True
        # The seats' speeds are a few per cent off; so is the way.
        off = (1.0 - self._speeds[taken] / speed[seats])[:, np.newaxis] * desired[seats]
        robots = np.hstack([path[:-1], np.diff(path, axis=0) / step])[::STEPS]
        dt, steps = STEPS * step, np.arange(len(kept))
        places, speeds, pulls = self._crowd.walk(
            position, velocity, goal, present, robots, radius, dt
        )
        since = ((steps % STEPS + 1) / STEPS)[:, np.newaxis, np.newaxis]
        before, pull = (a[:, taken][steps // STEPS] for a in (speeds, pulls))
        middle = before + 0.5 * since * (before + dt * pull - before)
        moved = places[:, taken][steps // STEPS] + since * dt * middle
        out = kept.copy()
        out[:, seats] = moved + step * (steps + 1)[:, np.newaxis, np.newaxis] * off
        return out

    def _seats(self, speed: Array) -> tuple[Indices, Indices]:
        """Return people who walk, and the imagined person of the nearest speed for each of them."""
        free = np.ones(len(self._speeds), np.bool_)
        people, seats = [], []
        for i in np.flatnonzero(speed >= STANDS):
            if not free.any():
                break
            off = np.where(free, np.abs(self._speeds - speed[i]), np.inf)
            seat = int(np.argmin(off))
            free[seat] = False
            people.append(int(i))
            seats.append(seat)
        return np.array(people, np.int64), np.array(seats, np.int64)
