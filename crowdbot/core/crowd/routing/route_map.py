"""RouteMap: corners and sight for bodies of one radius, and shortest paths among them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crowdbot.core.crowd.routing.corners import Corners, X, Y
from crowdbot.core.crowd.routing.free_space import FreeSpace, taken_by
from crowdbot.core.crowd.routing.sight import Sight, is_clear
from crowdbot.core.crowd.routing.trees import TO_GOAL, plan_tree
from crowdbot.core.types.arrays import Array, Indices
from crowdbot.errors import InputError

#: Distance of corners outside of a body's margin, so that sight along a margin is free, m.
_OUTSIDE = 0.01
#: People who were pushed use this share of their radius to look past edges.
_WIDER = 0.5
#: Largest number of corners; more take too long to link.
MOST_CORNERS = 12_000


@dataclass(frozen=True, slots=True)
class RouteMap:
    """Shortest paths for bodies of one radius.

    Attributes:
        space: free floor for their centres.
        corners: corners of shortest paths.
        sight, wider: edges at a body's margin, and nearer to the walls.
    """

    space: FreeSpace
    corners: Corners
    sight: Sight
    wider: Sight

    @classmethod
    def of(cls, walls: Array, pillars: Array, radius: float, points: Array) -> RouteMap:
        """Return the map of a place.

        Args:
            walls, pillars: (S, 4), (P, 3) obstacles, m.
            radius: radius of the bodies, m.
            points: (M, 2) positions that it has to contain, m.

        Raises:
            InputError: the place has too many corners.
        """
        space = FreeSpace.of(walls, pillars, radius, points)
        outer = FreeSpace(taken_by(walls, pillars, radius + _OUTSIDE), ())
        near = FreeSpace(taken_by(walls, pillars, _WIDER * radius), ())
        sight, rings = Sight.of(space.rings()), outer.rings()
        if (count := sum(map(len, rings))) > MOST_CORNERS:
            raise InputError(
                f"routing 'mesh': the place has {count} corners, more than {MOST_CORNERS}; "
                "simplify it, or let people walk straight (crowd.routing: {kind: straight})"
            )
        return cls(space, Corners.of(rings, sight), sight, Sight.of(near.rings()))

    @property
    def count(self) -> int:
        """Return the number of corners."""
        return len(self.corners.table)

    def plan(self, x: float, y: float, left: Array, after: Indices) -> None:
        """Write the shortest paths to a goal, see `plan_tree`."""
        heap, at = np.zeros(self.count, np.int64), np.zeros(self.count, np.int64)
        plan_tree(x, y, self.corners, self.sight, self.wider, left, after, heap, at)

    def way(self, start: tuple[float, float], goal: tuple[float, float]) -> Array:
        """Return the shortest path (K, 2), including both ends; straight if there is none."""
        if is_clear(*start, *goal, self.sight):
            return np.array([start, goal])
        left, after = np.zeros(self.count), np.zeros(self.count, np.int64)
        self.plan(*goal, left, after)
        table = self.corners.table
        length = left + np.hypot(table[:, X] - start[0], table[:, Y] - start[1])
        for sight in (self.sight, self.wider):
            for v in np.argsort(length, kind="stable").tolist():
                if not math.isfinite(length[v]):
                    break
                if is_clear(*start, table[v, X], table[v, Y], sight):
                    return self._along(start, v, after, goal)
        return np.array([start, goal])

    def _along(
        self, start: tuple[float, float], v: int, after: Indices, goal: tuple[float, float]
    ) -> Array:
        points = [start]
        while v != TO_GOAL:
            points.append((self.corners.table[v, X], self.corners.table[v, Y]))
            v = int(after[v])
        return np.array([*points, goal])
