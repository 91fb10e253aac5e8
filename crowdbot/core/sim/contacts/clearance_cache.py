"""ClearanceCache: skips distance checks while nothing is in reach."""

from __future__ import annotations

import math


class ClearanceCache:
    """A position, and the distance from it within which nothing is in reach."""

    def __init__(self) -> None:
        self._x = self._y = 0.0
        self._length = -1.0

    def is_clear(self, x: float, y: float) -> bool:
        """Return True if a point (m) is within the clear distance; False before `reset`."""
        return math.hypot(x - self._x, y - self._y) < self._length

    def reset(self, x: float, y: float, length: float) -> None:
        """Set a new position; nothing is in reach within ``length``, m."""
        self._x, self._y, self._length = x, y, length
