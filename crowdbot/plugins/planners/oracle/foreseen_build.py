"""The people of a run as they were foreseen last, moved to where they are by now."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Truth
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP


class Foreseen:
    """People as if the robot was not there.

    Args:
        horizon: s.
        again: time after which the crowd is asked again, s.
    """

    def __init__(self, horizon: float, again: float) -> None:
        self._again, self._steps = again, round(horizon / STEP)
        self._more = math.ceil(again / STEP) + 1
        self._t, self._numbers, self._places = -math.inf, np.zeros(0, np.int64), np.zeros((1, 0, 2))

    def look(self, t: float, truth: Truth) -> bool:
        """Ask the crowd if that is due; return True if it was asked.

        Args:
            t: s.
            truth: of a crowd that can be foreseen.
        """
        numbers = truth.people_id
        if t < self._t + self._again - 1e-9 and np.array_equal(numbers, self._numbers):
            return False
        assert truth.foresee is not None
        ahead = truth.foresee(self._steps + self._more, STEP, None)
        self._t, self._numbers = t, numbers.copy()
        self._places = np.concatenate([truth.people[np.newaxis], ahead])
        return True

    def places(self, t: float, truth: Truth) -> Array:
        """Return where people will be after each `STEP` from now on, (T, N, 2) m."""
        at = (t - self._t) / STEP
        k, part = int(at), at - int(at)
        now, later = (self._places[n : n + self._steps + 1] for n in (k, k + 1))
        found = (1.0 - part) * now + part * later
        return np.asarray(found[1:] + (truth.people - found[0]))


__all__ = ["Foreseen"]
