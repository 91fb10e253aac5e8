"""ClearanceCache: spares looking at what is too far away to matter."""

from __future__ import annotations

import math


class ClearanceCache:
    """A place, and how far from it one can go before anything is in reach."""

    def __init__(self) -> None:
        self._x = self._y = 0.0
        self._length = -1.0

    def is_clear(self, x: float, y: float) -> bool:
        """Whether a point (m) is within the length of the place; never before `reset`."""
        return math.hypot(x - self._x, y - self._y) < self._length

    def reset(self, x: float, y: float, length: float) -> None:
        """Begin anew at a place; nothing is in reach within ``length``, m."""
        self._x, self._y, self._length = x, y, length
