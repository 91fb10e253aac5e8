"""Line of sight between points, along which people can walk: edges in the cells of a grid."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: Average number of edges per cell; smallest size of cells, m.
_EDGES_PER_CELL, _LEAST_CELL = 2.0, 0.5
#: Largest number of cells along one axis.
_MOST_CELLS = 512


class Sight(NamedTuple):
    """Blocking edges, sorted into square cells.

    Attributes:
        edges: (E, 4) x0, y0, x1, y1, m.
        start, listed: rows of ``edges`` in cell c are ``listed[start[c]:start[c + 1]]``; cells go
            along x first.
        frame: (3,) x and y of the grid's corner, side of a cell, m.
        shape: (2,) cells along x and y.
    """

    edges: Array
    start: Indices
    listed: Indices
    frame: Array
    shape: Indices

    @classmethod
    def of(cls, rings: list[Array]) -> Sight:
        """Return the edges of closed outlines (K, 2)."""
        closed = [np.concatenate([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings]
        edges = np.concatenate([np.zeros((0, 4)), *closed])
        ends = edges.reshape(-1, 2)
        low, high = (ends.min(axis=0), ends.max(axis=0)) if len(ends) else (np.zeros(2),) * 2
        size = np.maximum(high - low, 1.0)
        side = math.sqrt(float(size[0] * size[1]) * _EDGES_PER_CELL / max(1, len(edges)))
        side = max(side, _LEAST_CELL, float(size.max()) / _MOST_CELLS)
        shape = np.floor(size / side).astype(np.int64) + 1
        frame = np.array([low[0], low[1], side])
        count = np.zeros(shape[0] * shape[1] + 1, np.int64)
        _count(edges, frame, shape, count)
        start = np.concatenate([[0], np.cumsum(count[:-1])])
        listed = np.zeros(int(start[-1]), np.int64)
        _list(edges, frame, shape, start[:-1].copy(), listed)
        return cls(edges, start, listed, frame, shape)


@kernel
def _cell_range(a: float, b: float, low: float, side: float, count: int) -> tuple[int, int]:
    first = math.floor((min(a, b) - low) / side - 1e-9)
    last = math.floor((max(a, b) - low) / side + 1e-9)
    return max(0, first), min(count - 1, last)


@kernel
def _count(edges: Array, frame: Array, shape: Indices, count: Indices) -> None:
    for e in range(edges.shape[0]):
        i0, i1 = _cell_range(edges[e, 0], edges[e, 2], frame[0], frame[2], shape[0])
        j0, j1 = _cell_range(edges[e, 1], edges[e, 3], frame[1], frame[2], shape[1])
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                count[j * shape[0] + i] += 1


@kernel
def _list(edges: Array, frame: Array, shape: Indices, at: Indices, listed: Indices) -> None:
    for e in range(edges.shape[0]):
        i0, i1 = _cell_range(edges[e, 0], edges[e, 2], frame[0], frame[2], shape[0])
        j0, j1 = _cell_range(edges[e, 1], edges[e, 3], frame[1], frame[2], shape[1])
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                c = j * shape[0] + i
                listed[at[c]] = e
                at[c] += 1


@kernel
def crosses(px: float, py: float, qx: float, qy: float, edge: Array) -> bool:
    """Return True if segment p-q crosses an edge; each end of an edge is on one side of p-q."""
    dx, dy = qx - px, qy - py
    one = dx * (edge[1] - py) - dy * (edge[0] - px) > 0.0
    if one == (dx * (edge[3] - py) - dy * (edge[2] - px) > 0.0):
        return False
    ex, ey = edge[2] - edge[0], edge[3] - edge[1]
    begin = ex * (py - edge[1]) - ey * (px - edge[0]) > 0.0
    return bool(begin != (ex * (qy - edge[1]) - ey * (qx - edge[0]) > 0.0))


@kernel
def is_clear(px: float, py: float, qx: float, qy: float, sight: Sight) -> bool:
    """Return True if the straight way from p to q crosses nothing.

    Cells are visited in order along the path, as in Amanatides and Woo (Eurographics 1987).
    """
    side, nx, ny = sight.frame[2], sight.shape[0], sight.shape[1]
    x, y = (px - sight.frame[0]) / side, (py - sight.frame[1]) / side
    ex, ey = (qx - sight.frame[0]) / side, (qy - sight.frame[1]) / side
    i, j, last_i, last_j = math.floor(x), math.floor(y), math.floor(ex), math.floor(ey)
    dx, dy = ex - x, ey - y
    step_i, step_j = (1 if dx > 0.0 else -1), (1 if dy > 0.0 else -1)
    span_x = abs(1.0 / dx) if dx != 0.0 else math.inf
    span_y = abs(1.0 / dy) if dy != 0.0 else math.inf
    next_x = span_x * ((i + 1 - x) if dx > 0.0 else (x - i)) if dx != 0.0 else math.inf
    next_y = span_y * ((j + 1 - y) if dy > 0.0 else (y - j)) if dy != 0.0 else math.inf
    for _ in range(abs(last_i - i) + abs(last_j - j) + 1):
        if 0 <= i < nx and 0 <= j < ny:
            c = j * nx + i
            for k in range(sight.start[c], sight.start[c + 1]):
                if crosses(px, py, qx, qy, sight.edges[sight.listed[k]]):
                    return False
        if next_x < next_y:
            next_x, i = next_x + span_x, i + step_i
        else:
            next_y, j = next_y + span_y, j + step_j
    return True
