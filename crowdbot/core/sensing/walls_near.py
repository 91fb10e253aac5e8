"""The walls that a sensor can see, cached for each square metre of its position."""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.hidden_walls import hidden_walls
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: With fewer walls all are tried.
_FEW = 64
#: Side of a cell, m; and the distance from its centre to a corner, with something for rounding.
_SIDE = 1.0
_HALF_DIAGONAL = 0.7072
#: Points of a cell may lie this far outside of it by rounding, m.
_ROUNDING = 1e-9
#: Largest number of cells that are remembered.
_MOST_CELLS = 2048


class Walls(NamedTuple):
    """Some walls of a scene, in their order.

    Attributes:
        segments, heights: (S, 4), (S, 2) as in `crowdbot.core.sensing.scene.Scene`, m.
        indices: (S,) of these in the scene; None: all of them.
        order, bound: (S,) these walls, about nearest first, and lower bounds of their distances
            from any point of the cell, m; 0 where nothing is known.
    """

    segments: Array
    heights: Array
    indices: Indices | None
    order: Indices
    bound: Array


class WallsNear:
    """Walls that can be seen from a point; others are never hit, so results stay the same.

    Args:
        segments, heights: (S, 4), (S, 2) all walls, m.
        fixed: number of those that stand still, which are the first ones.
    """

    def __init__(self, segments: Array, heights: Array, fixed: int) -> None:
        count = len(segments)
        self._all = Walls(segments, heights, None, np.arange(count), np.zeros(count))
        self._fixed = fixed
        self._standing: Indices = np.arange(fixed)
        #: Heights between which the same walls begin and end.
        self._levels = [-math.inf, math.inf]
        if fixed >= _FEW:
            self._standing = _first_of_equal(np.column_stack([segments, heights])[:fixed])
            self._levels[1:1] = np.unique(heights[:fixed]).tolist()
        start, end = segments[self._standing, :2].T, segments[self._standing, 2:].T
        square = ((end - start) ** 2).sum(0)
        self._lines = start, end - start, np.where(square > 0.0, square, 1.0)
        self._known: dict[tuple[int, int, float, int], Walls] = {}

    def near(self, x: float, y: float, reach: float, z: float = math.nan) -> Walls:
        """Return at least all walls within ``reach`` (m) of a point that can be seen from there.

        Args:
            z: height of the point, m; without it, walls that others hide are returned, too.
        """
        if self._fixed < _FEW or not math.isfinite(reach):
            return self._all
        level = bisect_right(self._levels, z) if math.isfinite(z) else 0
        key = math.floor(x / _SIDE), math.floor(y / _SIDE), reach, level
        found = self._known.get(key)
        if found is None:
            if len(self._known) >= _MOST_CELLS:
                self._known.clear()
            found = self._known[key] = self._within(*key)
        moving = len(self._all.segments) - self._fixed
        return self._with_moving(found) if moving else found

    def _within(self, column: int, row: int, reach: float, level: int) -> Walls:
        """Return the standing walls that can be within reach of a point of a cell.

        Args:
            level: number of `_levels` that are not above the sensor; 0: unknown.
        """
        x, y = (column + 0.5) * _SIDE, (row + 0.5) * _SIDE
        (ax, ay), (ex, ey), square = self._lines
        share = np.clip(((x - ax) * ex + (y - ay) * ey) / square, 0.0, 1.0)
        away = np.hypot(ax + share * ex - x, ay + share * ey - y)
        bound = np.maximum(0.0, away - _HALF_DIAGONAL * _SIDE)
        within = bound <= reach
        indices, bound = self._standing[within], bound[within]
        near = self._chosen(indices, bound)
        if level == 0:
            return near
        hidden = np.zeros(len(indices), np.bool_)
        hidden_walls(
            (x, y, 0.5 * _SIDE + _ROUNDING), (self._levels[level - 1], self._levels[level]),
            near.segments, near.heights, near.order, hidden,
        )  # fmt: skip
        return self._chosen(indices[~hidden], bound[~hidden])

    def _with_moving(self, walls: Walls) -> Walls:
        assert walls.indices is not None
        moving = np.arange(self._fixed, len(self._all.segments))
        bound = np.zeros(len(walls.indices) + len(moving))
        bound[walls.order] = walls.bound
        return self._chosen(np.concatenate([walls.indices, moving]), bound)

    def _chosen(self, indices: Indices, bound: Array) -> Walls:
        segments, heights = self._all.segments[indices], self._all.heights[indices]
        for array in (segments, heights):  # as all walls, for which kernels are compiled
            array.setflags(write=False)
        order = np.argsort(bound, kind="stable")
        return Walls(segments, heights, indices, order, bound[order])


def _first_of_equal(rows: Array) -> Indices:
    """Return the indices (N,) of rows that equal no earlier row, in order.

    If walls lie on each other, rays hit the first.
    """
    return np.sort(np.unique(rows, axis=0, return_index=True)[1])


def in_scene(body: NDArray[np.int64], walls: Walls) -> None:
    """Change the numbers of walls that were hit, -(2 + index), to those of the scene, in place."""
    if walls.indices is not None and body.size:
        _renumber(body.reshape(-1), walls.indices)


@kernel
def _renumber(body: Indices, indices: Indices) -> None:
    least = -1 - indices.shape[0]
    for k in range(body.shape[0]):
        if least <= body[k] <= -2:
            body[k] = -2 - indices[-2 - body[k]]
