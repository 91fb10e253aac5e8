"""A grid of walls for sums over their nearest points, each of which counts once.

Walls share corners, and seen from most places a shared corner is the nearest point of all walls
that meet there. A cell lists the walls near it without those whose nearest point is that of an
earlier one everywhere in the cell, and the pairs of others whose nearest points may be equal.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.geometry.segment_grid import Same, SegmentGrid, grid_of
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: Points nearer to each other than this in x and in y count once, m.
SAME_POINT = 1e-9
#: Walls nearer to each other than this may have such points, m: more than `SAME_POINT`, and than
#: rounding of coordinates up to 1e6 m.
_TOUCHING = 1e-8
#: Largest number of cells, each of which has its own copy of the walls near it.
_MOST_CELLS = 4096
#: Walls that are farther than this many times the length in which they fade count as if there.
_FADINGS = 20.0


class PointGrid(NamedTuple):
    """Walls by cells.

    Attributes:
        frame: (5,) as in `SegmentGrid`.
        first: (C + 1,) where each cell's rows of ``walls`` begin.
        walls: (K, 4) both ends, m; in each cell in the order of the floor's walls.
        first_pair: (C + 1,) where each cell's rows of ``pairs`` begin.
        pairs: (P, 2) a wall and an earlier one that it may touch, as rows from the cell's first.
        beyond: (C,) the number of walls that a cell does not list, each with the weight
            exp(-d / fading), if its distance from the cell's middle is d more than the reach and
            half a side: it is not less.
    """

    frame: Array
    first: Indices
    walls: Array
    first_pair: Indices
    pairs: Indices
    beyond: Array


def point_grid(walls: Array, reach: float, fading: float) -> PointGrid:
    """Return the grid with all nearest points within reach (m) of any point of each cell.

    Args:
        walls: (S, 4), m; an array that does not change.
        reach, fading: m.
    """
    return _point_grid(Same(walls), reach, fading)


@lru_cache(maxsize=16)
def _point_grid(same: Same, reach: float, fading: float) -> PointGrid:
    walls, grid = same.segments, grid_of(same.segments, reach, _MOST_CELLS)
    points, numbers = np.unique(walls.reshape(-1, 2), axis=0, return_inverse=True)
    numbers = numbers.reshape(-1, 2).astype(np.int64)
    cells = len(grid.first) - 1
    cell, wall = np.repeat(np.arange(cells), np.diff(grid.first)), grid.near
    corner = _corners_nearest(grid, cell, walls, numbers)
    kept = np.flatnonzero(_is_first(cell, corner) & _first_of_twins(numbers)[wall])
    cell, wall, corner = cell[kept], wall[kept], corner[kept]
    first = np.searchsorted(cell, np.arange(cells + 1))
    later, earlier = _pairs(cell * len(walls) + wall, wall, _touching(walls))
    apart = np.abs(points[corner[later]] - points[corner[earlier]]).max(axis=1) > _TOUCHING
    possible = (corner[later] < 0) | (corner[earlier] < 0) | ~apart
    later, earlier = later[possible], earlier[possible]
    first_pair = np.searchsorted(cell[later], np.arange(cells + 1))
    pairs = np.stack([later, earlier], axis=1) - first[cell[later]][:, np.newaxis]
    beyond = np.zeros(cells)
    if grid.frame[2] > 0.0:
        _count_beyond(*grid, walls, reach, fading, beyond)
    return PointGrid(grid.frame, first, walls[wall], first_pair, pairs, beyond)


def _first_of_twins(numbers: Indices) -> NDArray[np.bool_]:
    """Return a mask (S,) of the walls that are not equal to an earlier one, nor its reverse.

    Args:
        numbers: (S, 2) of both ends; equal points have equal numbers.
    """
    first = np.zeros(len(numbers), np.bool_)
    if len(numbers):
        first[np.unique(np.sort(numbers, axis=1), axis=0, return_index=True)[1]] = True
    return first


def _corners_nearest(grid: SegmentGrid, cell: Indices, walls: Array, numbers: Indices) -> Indices:
    """Return the number of the end of a wall that is nearest to a whole cell, or -1, for each row.

    Args:
        grid: of the walls.
        cell: (K,) of each row of ``grid.near``.
        numbers: (S, 2) of both ends.
    """
    if grid.frame[2] == 0.0:
        return np.full(len(cell), -1)
    side, columns = 1.0 / grid.frame[2], int(grid.frame[3])
    middle = grid.frame[:2] + (np.stack([cell % columns, cell // columns], axis=1) + 0.5) * side
    near, ends = walls[grid.near], numbers[grid.near]
    along = near[:, 2:] - near[:, :2]
    at = np.sum((middle - near[:, :2]) * along, axis=1)
    spread = 0.5 * side * np.sum(np.abs(along), axis=1)
    second = np.where(at - spread >= np.sum(along * along, axis=1), ends[:, 1], -1)
    return np.where(at + spread <= 0.0, ends[:, 0], second)


@kernel
def _count_beyond(
    frame: Array, first: Indices, near: Indices, walls: Array, reach: float, fading: float,
    beyond: Array,
) -> None:  # fmt: skip
    """Write ``beyond`` of a `PointGrid`; the first arguments are the `SegmentGrid`."""
    side, columns = 1.0 / frame[2], int(frame[3])
    least = reach + 0.5 * side
    seen = least + _FADINGS * fading
    for cell in range(beyond.shape[0]):
        x = frame[0] + (cell % columns + 0.5) * side
        y = frame[1] + (cell // columns + 0.5) * side
        total, k = math.exp(-_FADINGS) * walls.shape[0], first[cell]
        for s in range(walls.shape[0]):
            if k < first[cell + 1] and near[k] == s:
                k += 1
                continue
            ax, ay, bx, by = walls[s, 0] - x, walls[s, 1] - y, walls[s, 2] - x, walls[s, 3] - y
            if min(ax, bx) > seen or max(ax, bx) < -seen:
                continue
            if min(ay, by) > seen or max(ay, by) < -seen:
                continue
            nx, ny = nearest_on_segment(0.0, 0.0, ax, ay, bx, by)
            distance = math.sqrt(nx * nx + ny * ny)
            if distance < seen:
                total += math.exp((least - distance) / fading)
        beyond[cell] = total


def _is_first(cell: Indices, corner: Indices) -> NDArray[np.bool_]:
    """Return a mask (K,) of the rows whose corner, if there is one, is the cell's first such."""
    fixed = np.flatnonzero(corner >= 0)
    keys = cell[fixed] * (int(corner.max(initial=0)) + 1) + corner[fixed]
    first = corner < 0
    first[fixed[np.unique(keys, return_index=True)[1]]] = True
    return first


def _pairs(
    keys: Indices, wall: Indices, touching: tuple[Indices, Indices]
) -> tuple[Indices, Indices]:
    """Return the pairs (P,), (P,) of rows of one cell whose walls may touch, by the later row.

    Args:
        keys: (K,) ascending: cell times number of walls plus wall.
        wall: (K,).
        touching: as from `_touching`.
    """
    begins, others = touching
    count = np.diff(begins)[wall]
    later = np.repeat(np.arange(len(wall)), count)
    within = np.arange(len(later)) - np.repeat(np.cumsum(count) - count, count)
    wanted = keys[later] - wall[later] + others[begins[wall[later]] + within]
    earlier = np.minimum(np.searchsorted(keys, wanted), max(0, len(keys) - 1))
    there = keys[earlier] == wanted
    return later[there], earlier[there]


def _touching(walls: Array) -> tuple[Indices, Indices]:
    """Return for each wall the earlier ones that may touch it.

    Returns:
        (S + 1,) where the entries of each wall begin; (T,) the earlier walls.
    """
    if not len(walls):
        return np.zeros(1, np.int64), np.zeros(0, np.int64)
    order = np.argsort(np.minimum(walls[:, 0], walls[:, 2]), kind="stable")
    found = np.zeros((2, _write_touching(walls, order, np.zeros((2, 0), np.int64))), np.int64)
    _write_touching(walls, order, found)
    later, earlier = found[:, np.argsort(found[0], kind="stable")]
    return np.searchsorted(later, np.arange(len(walls) + 1)), earlier


@kernel
def _write_touching(walls: Array, order: Indices, found: Indices) -> int:
    """Write the pairs of walls that may touch, the later one and the earlier; return their number.

    Args:
        order: (S,) walls by their left end.
        found: (2, T) output; with T = 0, nothing is written.
    """
    count = 0
    for a in range(order.shape[0]):
        s = order[a]
        right = max(walls[s, 0], walls[s, 2]) + _TOUCHING
        for b in range(a + 1, order.shape[0]):
            other = order[b]
            if min(walls[other, 0], walls[other, 2]) > right:
                break
            if not (_is_beside(walls, s, other) or _is_beside(walls, other, s)):
                if found.shape[1] > 0:
                    found[0, count], found[1, count] = max(s, other), min(s, other)
                count += 1
    return count


@kernel
def _is_beside(walls: Array, s: int, other: int) -> bool:
    """Return True if the other wall clearly is above wall s, or on one side of its line."""
    ax, ay, by = walls[s, 0], walls[s, 1], walls[s, 3]
    if max(ay, by) + _TOUCHING < min(walls[other, 1], walls[other, 3]):
        return True
    ex, ey = walls[s, 2] - ax, by - ay
    c = ex * (walls[other, 1] - ay) - ey * (walls[other, 0] - ax)
    d = ex * (walls[other, 3] - ay) - ey * (walls[other, 2] - ax)
    width = 2.0 * _TOUCHING * math.hypot(ex, ey)
    return bool(min(c, d) > width or max(c, d) < -width)
