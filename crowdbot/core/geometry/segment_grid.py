"""Segments sorted into the cells of a grid, to find those near a point without trying all."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: With fewer segments all are tried: that costs less than finding the cell.
_FEW = 12
#: Largest number of cells; more take too long to fill.
_MOST_CELLS = 16384
#: Added to the reach against rounding, m.
_SLACK = 1e-6


class SegmentGrid(NamedTuple):
    """Grid over segments; each cell lists the segments near it.

    Attributes:
        frame: (5,) x and y of the lower left corner, m; cells per metre; columns and rows. With 0
            cells per metre a single cell covers the whole floor.
        first: (C + 1,) where each cell's rows of ``near`` begin, row by row of cells.
        near: (K,) indices of segments, ascending within a cell.
    """

    frame: Array
    first: Indices
    near: Indices


def segment_grid(segments: Array, reach: float, most_cells: int = _MOST_CELLS) -> SegmentGrid:
    """Return a grid with all segments (S, 4) within reach (m) of any point of each cell.

    Points outside of the grid have no segment within reach. The segments of a cell keep their
    order, so that sums over them have the same bits as sums over all, where those beyond reach add
    nothing.
    """
    count = len(segments)
    if count < _FEW or not math.isfinite(reach):
        return SegmentGrid(np.zeros(5), np.array([0, count]), np.arange(count))
    far = reach + _SLACK
    ends = segments.reshape(-1, 2)
    low, high = ends.min(axis=0) - far, ends.max(axis=0) + far
    width, height = (high - low).tolist()
    side = max(0.2 * reach, math.sqrt(width * height / most_cells), max(width, height) / 4096.0)
    columns, rows = math.ceil(width / side), math.ceil(height / side)
    cells, items = [], []
    for s, (ax, ay, bx, by) in enumerate(segments.tolist()):
        i0, i1 = int((min(ax, bx) - far - low[0]) / side), int((max(ax, bx) + far - low[0]) / side)
        j0, j1 = int((min(ay, by) - far - low[1]) / side), int((max(ay, by) + far - low[1]) / side)
        x = low[0] + (np.arange(i0, min(i1, columns - 1) + 1) + 0.5) * side
        y = low[1] + (np.arange(j0, min(j1, rows - 1) + 1) + 0.5) * side
        j, i = np.nonzero(_within(x, y, (ax, ay, bx, by), far + 0.7072 * side))
        cells.append((j + j0) * columns + i + i0)
        items.append(np.full(len(i), s))
    cell, near = np.concatenate(cells), np.concatenate(items)
    order = np.argsort(cell, kind="stable")
    first = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=columns * rows))])
    frame = np.array([low[0], low[1], 1.0 / side, columns, rows], np.float64)
    return SegmentGrid(frame, first.astype(np.int64), near[order].astype(np.int64))


class Same:
    """A cache key that compares an array by identity, and keeps it so that its id is not reused."""

    __slots__ = ("segments",)

    def __init__(self, segments: Array) -> None:
        self.segments = segments

    def __hash__(self) -> int:
        return id(self.segments)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and self.segments is other.segments


def grid_of(segments: Array, reach: float, most_cells: int = _MOST_CELLS) -> SegmentGrid:
    """Return the cached `segment_grid` of an array that does not change."""
    return _grid_of(Same(segments), reach, most_cells)


@lru_cache(maxsize=16)
def _grid_of(same: Same, reach: float, most_cells: int) -> SegmentGrid:
    return segment_grid(same.segments, reach, most_cells)


def _within(x: Array, y: Array, segment: tuple[float, float, float, float], far: float) -> Array:
    """Return a mask (J, I) of the points of a mesh, x (I,) and y (J,), near a segment."""
    ax, ay, bx, by = segment
    ex, ey = bx - ax, by - ay
    square = ex * ex + ey * ey or 1.0
    dx, dy = x[np.newaxis] - ax, y[:, np.newaxis] - ay
    share = np.clip((dx * ex + dy * ey) / square, 0.0, 1.0)
    return np.asarray((dx - share * ex) ** 2 + (dy - share * ey) ** 2 <= far * far)


@kernel
def cell_of(frame: Array, x: float, y: float) -> int:
    """Return the index of the cell of a point, or -1 outside of the grid."""
    if frame[2] == 0.0:
        return 0
    i, j = math.floor((x - frame[0]) * frame[2]), math.floor((y - frame[1]) * frame[2])
    if i < 0.0 or j < 0.0 or i >= frame[3] or j >= frame[4]:
        return -1
    return int(j * frame[3] + i)
