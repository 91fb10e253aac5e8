"""The floor where people can be placed, and places they can reach."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from crowdbot.core.types.arrays import Array, Point
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.crowd.routing.free_space import FreeSpace

#: Tolerance for touching a wall, m.
_SLACK = 1e-6
#: Width of a corner's margin beyond a body's radius, relative to it.
_CORNER = 0.45


class Ground:
    """The floor among walls, pillars and solids.

    Args:
        parts: the environment; None if unknown.
        crowd: crowd with people's height and path finding.
    """

    def __init__(self, parts: EnvironmentParts | None = None, crowd: Crowd | None = None) -> None:
        self._walls, self._pillars = np.zeros((0, 4)), np.zeros((0, 3))
        self._solids: tuple[Array, ...] = ()
        if parts is not None and crowd is not None:
            self._walls, self._pillars, self._solids = parts.in_the_way(crowd.body.height)
        routing = None if crowd is None or parts is None else crowd.routing
        self.finds_way = routing is not None and routing.kind == "mesh"
        self._space = cache(self._free_space)

    def is_free(self, x: float, y: float, radius: float) -> bool:
        """Return True if a body fits here without touching an obstacle."""
        ax, ay, bx, by = self._walls.T
        ex, ey = bx - ax, by - ay
        share = ((x - ax) * ex + (y - ay) * ey) / np.maximum(ex * ex + ey * ey, 1e-300)
        share = np.clip(share, 0.0, 1.0)
        away = np.hypot(x - ax - share * ex, y - ay - share * ey)
        if np.any(away < radius - _SLACK):
            return False
        px, py, pr = self._pillars.T
        if np.any(np.hypot(px - x, py - y) < pr + radius - _SLACK):
            return False
        return not any(_inside(outline, x, y) for outline in self._solids)

    def reaches(self, start: Point, goal: Point, radius: float) -> bool:
        """Return True if a person can get from one place to another; always without path finding.

        Margins of corners are a little wider than a body: a body that stands there is counted to
        the part of the floor beside it.
        """
        if not self.finds_way:
            return True
        space = self._space(radius)
        begin, end = space.part_of(np.array([start, goal]))
        if begin < 0 and self.is_free(*start, radius):  # beside a corner, whose margin is wider
            begin = space.nearest_part(start, _CORNER * radius)
        return bool(begin == end >= 0)

    def check_route(self, name: str, start: Point, route: Sequence[Point], radius: float) -> None:
        """Refuse a route without a path from one point to the next.

        Raises:
            InputError: there is no path; with the positions.
        """
        for goal in route:
            if goal != start and not self.reaches(start, goal, radius):
                raise InputError(
                    f"{name}: no way leads from ({start[0]:g}, {start[1]:g}) to the goal "
                    f"({goal[0]:g}, {goal[1]:g}) for a body of radius {radius:g} m"
                )
            start = goal

    def _free_space(self, radius: float) -> FreeSpace:
        from crowdbot.core.crowd.routing.free_space import FreeSpace  # imports the engine

        everything = np.concatenate([self._walls.reshape(-1, 2), self._pillars[:, :2]])
        far = np.zeros((0, 2))
        if len(everything):
            low, high = everything.min(axis=0), everything.max(axis=0)
            size = high - low + 1e3  # outside the walls is floor
            far = np.array([low - size, high + size])
        return FreeSpace.of(self._walls, self._pillars, radius, far)


def _inside(outline: Array, x: float, y: float) -> bool:
    """Return True if a point is inside a convex, counter-clockwise outline."""
    (ax, ay), (bx, by) = outline.T, np.roll(outline, -1, axis=0).T
    return bool(np.all((bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0))
