"""Find places for the people of one spawn, group by group."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.types.arrays import Array, Point
from crowdbot.dsl.spec.areas import Area

#: Attempts to place one person or group before the area counts as full.
ATTEMPTS = 1000
#: Attempts to place another member around the first; the disc grows in the first half.
_MEMBER_ATTEMPTS = 64


def group_reach(size: int, spacing: float) -> float:
    """Return the largest distance of a member from the first of its group, m.

    Discs ``spacing`` apart cover at most a quarter of a disc of this radius, few enough for random
    places to be found.
    """
    return spacing * (1.0 + math.sqrt(size))


class Placer:
    """People of one spawn, placed on free floor with their bodies inside the area.

    Attributes:
        places: (N, 2) positions of placed people, m.
    """

    def __init__(self, area: Area, radius: Array, spacing: float, occupancy: Occupancy) -> None:
        self._area, self._radius, self._spacing, self._occupancy = area, radius, spacing, occupancy
        self._since = occupancy.count
        self.places = np.empty((len(radius), 2))

    @property
    def placed(self) -> int:
        """Return the number of placed people."""
        return self._occupancy.count - self._since

    def put_group(self, members: range, rng: np.random.Generator) -> bool:
        """Place a group's first member anywhere and the others around; return False on failure."""
        before = self._occupancy.count
        spacing = max(self._spacing, 2.0 * float(np.max(self._radius[members])))
        for _ in range(ATTEMPTS):
            first = self._anywhere(members[0], rng)
            if self._put(members[0], first) and all(
                self._put_near(i, first, spacing, group_reach(len(members), spacing), rng)
                for i in members[1:]
            ):
                return True
            self._occupancy.count = before
        return False

    def _anywhere(self, i: int, rng: np.random.Generator) -> Point:
        """Return a random point of the area, one radius inside."""
        (width, height), radius = self._area.size, float(self._radius[i])
        u = (2.0 * rng.random() - 1.0) * (0.5 * width - radius)
        v = (2.0 * rng.random() - 1.0) * (0.5 * height - radius)
        return self._area.point(u, v)

    def _put_near(
        self, i: int, first: Point, spacing: float, reach: float, rng: np.random.Generator
    ) -> bool:
        """Place a member uniformly in a disc around the first, which grows to ``reach``."""
        for attempt in range(_MEMBER_ATTEMPTS):
            grown = min(1.0, 2.0 * (attempt + 1) / _MEMBER_ATTEMPTS)
            distance = (spacing + grown * (reach - spacing)) * math.sqrt(rng.random())
            angle = 2.0 * math.pi * rng.random()
            x, y = first[0] + distance * math.cos(angle), first[1] + distance * math.sin(angle)
            if self._put(i, (x, y)):
                return True
        return False

    def _put(self, i: int, point: Point) -> bool:
        """Place a person if the body lies inside the area and the place is free."""
        (width, height), radius = self._area.size, float(self._radius[i])
        u, v = self._area.own(*point)
        inside = max(abs(u) - 0.5 * width, abs(v) - 0.5 * height) <= 1e-9 - radius
        if not inside or not self._occupancy.is_free(*point, radius, self._spacing, self._since):
            return False
        self._occupancy.add(*point, radius)
        self.places[i] = point
        return True
