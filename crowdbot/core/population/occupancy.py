"""Occupied floor while a crowd is sampled: the discs of all people placed so far."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.population.ground import Ground
from crowdbot.dsl.scenario.spawning import CLEAR_OF_ROBOT


class Occupancy:
    """Discs on free floor without overlap; the last ones can be removed."""

    def __init__(self, robots: Sequence[tuple[float, float]], ground: Ground | None = None) -> None:
        self.ground = ground or Ground()
        self._robots = np.array(robots, dtype=np.float64).reshape(-1, 2)
        self._discs = np.empty((64, 3))
        self.count = 0

    def add(self, x: float, y: float, radius: float) -> None:
        """Add a disc, regardless of overlaps."""
        if self.count == len(self._discs):
            self._discs = np.concatenate([self._discs, np.empty_like(self._discs)])
        self._discs[self.count] = x, y, radius
        self.count += 1

    def is_free(
        self, x: float, y: float, radius: float, spacing: float = 0.0, since: int = 0
    ) -> bool:
        """Return True if a disc fits.

        Args:
            x, y, radius: the disc, m.
            spacing: smallest distance from the centres of the last discs, m.
            since: index of the first of the last discs.
        """
        robots = (self._robots[:, 0] - x) ** 2 + (self._robots[:, 1] - y) ** 2
        if np.any(robots < CLEAR_OF_ROBOT**2):
            return False
        discs = self._discs[: self.count]
        away = (discs[:, 0] - x) ** 2 + (discs[:, 1] - y) ** 2
        reach = radius + discs[:, 2]
        if np.any(away < reach * reach):
            return False
        if np.any(away[since:] < spacing * spacing):
            return False
        return self.ground.is_free(x, y, radius)
