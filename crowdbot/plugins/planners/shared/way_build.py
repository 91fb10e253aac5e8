"""The way to the goal past what stands: where to head for when the straight line is blocked."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable

import numpy as np

from crowdbot.plugin import Array, Indices, Pose, kernel
from crowdbot.plugins.planners.shared.local_map_build import kept_points, thinned, way_out

#: Period at which the map is renewed, s; what stands is remembered in this range, m.
_PERIOD, _REACH = 0.5, 6.0
#: What stands was seen at its place in this many renewals in a row; untracked people move on.
_TIMES, _CELL = 3, 0.15
#: On a way around something the robot heads for a point at most this far along, m.
_AHEAD = 1.2
#: Points this near to the goal do not block the line to it, m.
_AT_GOAL = 0.3
#: Steps to a cell itself and its neighbours.
_BESIDE = np.array([[i, j] for i in (-1, 0, 1) for j in (-1, 0, 1)])


class Way:
    """Remembers what stands around the robot, and leads past it.

    Args:
        radius: radius of the disc that must stay free, m.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        self._memory = np.empty((0, 2))
        self._lately: deque[Array] = deque(maxlen=_TIMES - 1)
        self._renewed = -math.inf
        self._bearing: float | None = None
        is_blocked(np.ones((1, 2)), 0.0, 0.0, 1.0, 0.0, 1.0)
        way_out(np.ones((1, 2)), 0.0, 0.0, 9.0, 0.0, 99.0)  # no way at all is soon found

    def aim(
        self, t: float, pose: Pose, seen: Array, goal: tuple[float, float]
    ) -> tuple[float, float]:
        """Return the point to head for: the goal, or one on the shortest way to it.

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
    cells = np.floor(seen / _CELL).astype(np.int64)
    for points in before:
        old = np.floor(points / _CELL).astype(np.int64)
        around = (old[:, None] + _BESIDE).reshape(-1, 2)
        kept = np.isin(_key(cells), _key(around))
        cells, seen = cells[kept], seen[kept]
    return seen


def _key(cells: Indices) -> Indices:
    return np.asarray(cells[:, 0] * 1_000_003 + cells[:, 1])


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
