"""A small local map for finding a path out of dead ends."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, array_kernel

#: Side of a cell (m), and cells from the centre of the map to its border.
CELL, HALF = 0.1, 60
_SIDE = 2 * HALF + 1
_SECTORS = 180
#: A remembered point is removed if its sector is seen to be free this far behind it, m.
_BEHIND = 0.4
#: Distance along the path of the point that the robot heads for, m.
AIM = 0.7


def remembered(memory: Array, seen: Array, x: float, y: float, reach: float) -> Array:
    """Return the points of the map, updated with a new scan.

    Args:
        memory: (N, 2) points seen before, world frame, m.
        seen: (K, 2) points seen now, world frame, m.
        x: the robot's position, m.
        y: the robot's position, m.
        reach: the sensors' range, m.

    Returns:
        (N', 2) points seen now, and those hidden, out of range or still there; one point per cell.
    """
    kept = kept_points(memory, seen, x, y, reach)
    return thinned(np.concatenate([seen, kept]))  # a new point replaces an old one


def kept_points(memory: Array, seen: Array, x: float, y: float, reach: float) -> Array:
    """Return the map's points that are hidden, out of range or still there.

    Arguments as for `remembered`.
    """
    view = np.full(_SECTORS, reach)
    at, gap = _polar(seen, x, y)
    np.minimum.at(view, at, gap)
    # Some rays always pass a body's outline: only a wide gap shows that the body is gone.
    view = np.min([np.roll(view, k) for k in range(-3, 4)], axis=0)
    at, gap = _polar(memory, x, y)
    return np.asarray(memory[(gap + _BEHIND > view[at]) | (gap > reach)])


def thinned(points: Array) -> Array:
    """Return the points (N, 2) with only the first one in each cell."""
    cells = np.round(points / CELL)
    order = np.lexsort((cells[:, 1], cells[:, 0]))
    cells, first = cells[order], np.ones(len(points), np.bool_)
    first[1:] = (cells[1:] != cells[:-1]).any(axis=1)
    return points[order[first]]


@array_kernel
def islands(points: Array, link: float, size: float) -> Array:
    """Return the centres (K, 2) of small isolated obstacles: pillars and standing people.

    Args:
        points: (N, 2) m.
        link: largest distance between points of one obstacle, m.
        size: largest size that counts as small, along x and y, m.
    """
    count = points.shape[0]
    left, queue = np.ones(count, dtype=np.bool_), np.empty(count, dtype=np.int64)
    out, found = np.empty((count, 2)), 0
    for first in range(count):
        if not left[first]:
            continue
        left[first], queue[0] = False, first
        begin, end = 0, 1
        low_x = high_x = points[first, 0]
        low_y = high_y = points[first, 1]
        while begin < end:
            x, y = points[queue[begin], 0], points[queue[begin], 1]
            low_x, high_x = min(low_x, x), max(high_x, x)
            low_y, high_y = min(low_y, y), max(high_y, y)
            begin += 1
            for k in range(count):
                if left[k] and math.hypot(points[k, 0] - x, points[k, 1] - y) <= link:
                    left[k], queue[end] = False, k
                    end += 1
        if max(high_x - low_x, high_y - low_y) <= size:
            out[found, 0], out[found, 1] = 0.5 * (low_x + high_x), 0.5 * (low_y + high_y)
            found += 1
    return out[:found]


def _polar(points: Array, x: float, y: float) -> tuple[NDArray[np.int64], Array]:
    dx, dy = points[:, 0] - x, points[:, 1] - y
    turn = np.arctan2(dy, dx) / (2.0 * np.pi) + 0.5
    return (turn * _SECTORS).astype(np.int64) % _SECTORS, np.hypot(dx, dy)


@array_kernel
def _blocked(points: Array, x: float, y: float, radius: float) -> NDArray[np.bool_]:
    """Return the cells around (x, y) in which the centre of a disc would touch a point."""
    out = np.zeros((_SIDE, _SIDE), dtype=np.bool_)
    wide = math.ceil(radius / CELL)
    for k in range(points.shape[0]):
        px, py = (points[k, 0] - x) / CELL + HALF, (points[k, 1] - y) / CELL + HALF
        ci, cj = round(px), round(py)
        for i in range(max(0, ci - wide), min(_SIDE, ci + wide + 1)):
            for j in range(max(0, cj - wide), min(_SIDE, cj + wide + 1)):
                if math.hypot(i - px, j - py) * CELL < radius:
                    out[i, j] = True
    return out


@array_kernel
def _relax(cost: Array, blocked: NDArray[np.bool_], i: int, j: int) -> bool:
    """Update a cell from its best neighbour's cost plus the step; return True if it decreased."""
    if blocked[i, j]:
        return False
    best = cost[i, j]
    for a in range(max(0, i - 1), min(_SIDE, i + 2)):
        for b in range(max(0, j - 1), min(_SIDE, j + 2)):
            best = min(best, cost[a, b] + CELL * math.hypot(a - i, b - j))
    if best < cost[i, j] - 1e-9:
        cost[i, j] = best
        return True
    return False


@array_kernel
def _cost_to_go(blocked: NDArray[np.bool_], gx: float, gy: float) -> Array:
    """Return the path length from each free cell to the goal, by sweeps in four orders, m.

    Beyond the border of the map the path is assumed straight. Blocked cells stay at infinity.
    """
    cost = np.full((_SIDE, _SIDE), np.inf)
    for i in range(_SIDE):
        for j in range(_SIDE):
            away = math.hypot(gx - (i - HALF) * CELL, gy - (j - HALF) * CELL)
            border = i in (0, _SIDE - 1) or j in (0, _SIDE - 1)
            if (border or away < CELL) and not blocked[i, j]:
                cost[i, j] = away
    changed = True
    while changed:
        changed = False
        for order in range(4):
            for p in range(_SIDE):
                for q in range(_SIDE):
                    i = p if order % 2 == 0 else _SIDE - 1 - p
                    j = q if order < 2 else _SIDE - 1 - q
                    changed |= _relax(cost, blocked, i, j)
    return cost


@array_kernel
def way_out(
    points: Array, x: float, y: float, gx: float, gy: float, radius: float
) -> tuple[bool, float]:
    """Return a point on the shortest path to the goal, to head for.

    Args:
        points: (N, 2) obstacles, world frame, m.
        x: of the robot, m.
        y: of the robot, m.
        gx: of the goal, m.
        gy: of the goal, m.
        radius: radius of the disc that must stay free, m.

    Returns:
        True if there is a path; its first bearing in the world frame, rad.
    """
    blocked = _blocked(points, x, y, radius)
    for i in range(HALF - 1, HALF + 2):  # the robot's own cells are free
        for j in range(HALF - 1, HALF + 2):
            blocked[i, j] = False
    cost = _cost_to_go(blocked, gx - x, gy - y)
    i = j = HALF
    while math.hypot(i - HALF, j - HALF) * CELL < AIM:
        bi, bj, least = i, j, math.inf
        for a in range(max(0, i - 1), min(_SIDE, i + 2)):
            for b in range(max(0, j - 1), min(_SIDE, j + 2)):
                through = cost[a, b] + CELL * math.hypot(a - i, b - j)
                if cost[a, b] < cost[i, j] and through < least:
                    bi, bj, least = a, b, through
        if bi == i and bj == j:
            break
        i, j = bi, bj
    return (i != HALF or j != HALF), math.atan2(j - HALF, i - HALF)
