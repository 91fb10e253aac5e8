"""Path to the goal around static obstacles: the next point to head for."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable

import numpy as np

from crowdbot.plugin import Array, Indices, Mask, Pose, kernel
from crowdbot.plugins.planners.shared.local_map_build import kept_points, thinned, way_out

#: Period at which the map is renewed, s; what stands is remembered in this range, m.
_PERIOD, _REACH = 0.5, 6.0
#: What stands was seen at its place in this many renewals in a row; untracked people move on.
_TIMES, _CELL = 3, 0.15
#: On a way around something the robot heads for a point at most this far along, m.
_AHEAD = 1.2
#: Points this near to the goal do not block the line to it, m.
_AT_GOAL = 0.3
#: Difference of the numbers of cells that are neighbours along x.
_ROW = 1_000_003


class PathFinder:
    """Remembers static obstacles around the robot, and plans paths around them.

    Args:
        radius: radius of the disc that must stay free, m.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        self._memory = np.empty((0, 2))
        self._lately: deque[Array] = deque(maxlen=_TIMES - 1)
        self._renewed = -math.inf
        self._bearing: float | None = None
        _still_there(np.ones((1, 2)), [np.ones((1, 2))])
        is_blocked(np.ones((1, 2)), 0.0, 0.0, 1.0, 0.0, 1.0)
        way_out(np.ones((1, 2)), 0.0, 0.0, 9.0, 0.0, 99.0)  # no way at all is soon found

    def waypoint(
        self, t: float, pose: Pose, seen: Array, goal: tuple[float, float]
    ) -> tuple[float, float]:
        """Return the point to head for: the goal, or one on the shortest path to it, m.

        Args:
            t: now, s.
            pose: the robot's.
            seen: (Q, 2) points of what is not a person, in the frame of the pose, m.
            goal: in that frame, m.
        """
        if t - self._renewed >= _PERIOD:
            self._renewed = t
            self._renew(pose, seen, goal)
        if self._bearing is None:
            return goal
        ahead = min(_AHEAD, math.hypot(goal[0] - pose.x, goal[1] - pose.y))
        return (
            pose.x + ahead * math.cos(self._bearing),
            pose.y + ahead * math.sin(self._bearing),
        )

    def _renew(self, pose: Pose, seen: Array, goal: tuple[float, float]) -> None:
        stands = _still_there(seen, self._lately) if len(self._lately) == _TIMES - 1 else seen[:0]
        self._lately.append(seen)
        kept = kept_points(self._memory, seen, pose.x, pose.y, _REACH)
        self._memory = thinned(np.concatenate([stands, kept]))
        away = np.hypot(*(self._memory - (pose.x, pose.y)).T)
        self._memory = self._memory[away < 2.0 * _REACH]
        self._bearing = None
        if not is_blocked(self._memory, pose.x, pose.y, *goal, self.radius):
            return
        for radius in (self.radius, 0.7 * self.radius):
            found, bearing = way_out(self._memory, pose.x, pose.y, *goal, radius)
            if found:
                self._bearing = bearing
                return


def _still_there(seen: Array, before: Iterable[Array]) -> Array:
    """Return the points (K, 2) of which each earlier scan has one in the same cell or beside it."""
    for points in before:
        kept = np.empty(len(seen), np.bool_)
        _beside(_key(seen), np.sort(_key(points)), kept)
        seen = seen[kept]
    return seen


def _key(points: Array) -> Indices:
    """Return the numbers (N,) of the points' cells; those of neighbours along y are consecutive."""
    cells = np.floor(points / _CELL).astype(np.int64)
    return cells[:, 0] * _ROW + cells[:, 1]


@kernel
def _beside(cells: Indices, others: Indices, out: Mask) -> None:
    """Write for each cell (N,) if it or a neighbour is among others (M,), which ascend."""
    count = others.shape[0]
    for i in range(cells.shape[0]):
        out[i] = False
        for row in range(-1, 2):
            first = cells[i] + row * _ROW - 1
            low, high = 0, count
            while low < high:
                middle = (low + high) // 2
                if others[middle] < first:
                    low = middle + 1
                else:
                    high = middle
            if low < count and others[low] <= first + 2:
                out[i] = True


@kernel
def is_blocked(points: Array, x: float, y: float, gx: float, gy: float, radius: float) -> bool:
    """Return True if a point (P, 2) lies within a radius of the line from (x, y) to (gx, gy), m.

    Points around the robot itself and around the goal do not count.
    """
    dx, dy = gx - x, gy - y
    long = math.sqrt(dx * dx + dy * dy)
    if long < 1e-9:
        return False
    for i in range(points.shape[0]):
        px, py = points[i, 0] - x, points[i, 1] - y
        along = (px * dx + py * dy) / long
        if along <= 0.0 or along >= long - _AT_GOAL:
            continue
        if abs(px * dy - py * dx) / long < radius:
            return True
    return False
