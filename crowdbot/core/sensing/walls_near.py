"""The walls that a sensor can see, found once for each square metre that it stands on."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.hidden_walls import hidden_walls
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


class _Cell(NamedTuple):
    """The standing walls of a cell.

    Attributes:
        near: all within reach of any point of it.
        seen: those of them that none of the others hides from a sensor between two heights.
        lowest, highest: these heights, m.
    """

    near: Walls
    seen: Walls
    lowest: float
    highest: float


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
        self._known: dict[tuple[int, int, float], _Cell] = {}

    def near(self, x: float, y: float, reach: float, z: float = math.nan) -> Walls:
        """Return at least all walls within ``reach`` (m) of a point that can be seen from there.

        Args:
            z: height of the point, m; without it, walls that others hide are returned, too.
        """
        if self._fixed < _FEW or not math.isfinite(reach):
            return self._all
        key = math.floor(x / _SIDE), math.floor(y / _SIDE), reach
        cell = self._known.get(key)
        if cell is None:
            if len(self._known) >= _MOST_CELLS:
                self._known.clear()
            cell = self._known[key] = self._within(*key)
        found = cell.seen if cell.lowest <= z <= cell.highest else cell.near
        moving = len(self._all.segments) - self._fixed
        return self._with_moving(found) if moving else found

    def _within(self, column: int, row: int, reach: float) -> _Cell:
        """Return the standing walls within reach of any point of a cell."""
        x, y = (column + 0.5) * _SIDE, (row + 0.5) * _SIDE
        ax, ay, bx, by = self._all.segments[: self._fixed].T
        ex, ey = bx - ax, by - ay
        square = ex * ex + ey * ey
        share = np.clip(((x - ax) * ex + (y - ay) * ey) / np.where(square > 0.0, square, 1.0), 0, 1)
        away = np.hypot(ax + share * ex - x, ay + share * ey - y)
        bound = np.maximum(0.0, away - _HALF_DIAGONAL * _SIDE)
        indices = np.flatnonzero(bound <= reach)
        near = self._chosen(indices, bound[indices])
        hidden = np.zeros(len(indices), np.bool_)
        half = 0.5 * _SIDE + _ROUNDING
        lowest, highest = hidden_walls(
            x, y, half, near.segments, near.heights, near.order, hidden
        )  # fmt: skip
        seen = self._chosen(indices[~hidden], bound[indices[~hidden]])
        return _Cell(near, seen, lowest, highest)

    def _with_moving(self, found: Walls) -> Walls:
        assert found.indices is not None
        moving = np.arange(self._fixed, len(self._all.segments))
        bound = np.zeros(len(found.indices) + len(moving))
        bound[found.order] = found.bound
        return self._chosen(np.concatenate([found.indices, moving]), bound)

    def _chosen(self, indices: Indices, bound: Array) -> Walls:
        segments, heights = self._all.segments[indices], self._all.heights[indices]
        for array in (segments, heights):  # as all walls, for which kernels are compiled
            array.setflags(write=False)
        order = np.argsort(bound, kind="stable")
        return Walls(segments, heights, indices, order, bound[order])


def in_scene(body: NDArray[np.int64], walls: Walls) -> None:
    """Change the numbers of walls that were hit, -(2 + index), to those of the scene, in place."""
    if walls.indices is None:
        return
    own = (body <= -2) & (body >= -1 - len(walls.indices))
    body[own] = -2 - walls.indices[-2 - body[own]]
