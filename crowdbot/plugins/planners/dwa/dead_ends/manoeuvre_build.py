"""Plan manoeuvres of a long robot in narrow places: turn, go ahead, back off.

A disc can take any path that is wide enough. A wheelchair must first stand straight in front of a
door. So positions and headings are searched together, with the robot's outline at each (A*; Hart,
Nilsson, Raphael, IEEE Transactions on Systems Science and Cybernetics 4(2), 1968): 16 headings on a
small map, and from each pose a step ahead, a step back, or a turn on the spot.
"""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, array_kernel
from crowdbot.plugins.planners.shared.robot_outline_build import core_gap

#: Side of a cell (m), and cells from the middle of the map to its border.
CELL, HALF = 0.1, 45
_SIDE = 2 * HALF + 1
#: Quarters of a turn, as cosine and sine.
_TURNS = [(1, 0), (0, 1), (-1, 0), (0, -1)]
#: Cells of a step ahead, for each heading.
_QUARTER = [(1, 0), (2, 1), (1, 1), (1, 2)]
_STEPS = np.array([(a * x - b * y, b * x + a * y) for a, b in _TURNS for x, y in _QUARTER])
_HEADINGS = np.arctan2(_STEPS[:, 1], _STEPS[:, 0]).astype(np.float64)
_COUNT = 16
#: The headings, each followed by the middle of the turn to the next, which sweeps more space than
#: its ends.
_LOOKS = np.column_stack(
    [_HEADINGS, _HEADINGS + 0.5 * ((np.roll(_HEADINGS, -1) - _HEADINGS) % (2.0 * math.pi))]
).ravel()
#: Cost of a metre back, in metres ahead; and of a turn on the spot to the next heading, m.
_BACK, _TURN = 2.0, 0.25


@array_kernel
def blocked_poses(
    points: Array, core: Array, rounding: float, reach: float, margin: float
) -> NDArray[np.bool_]:
    """Return (32, S, S): headings and cells at which a point is closer than the margin.

    The 16 headings are each followed by the middle of the turn to the next.

    Args:
        points: (N, 2) relative to the middle of the map, m.
        core, rounding: of the outline, as `robot_outline_build.core_of`.
        reach: of the outline's farthest point from its origin, m.
        margin: m.
    """
    out = np.zeros((2 * _COUNT, _SIDE, _SIDE), dtype=np.bool_)
    wide = math.ceil((reach + margin) / CELL)
    for k in range(points.shape[0]):
        ci, cj = round(points[k, 0] / CELL) + HALF, round(points[k, 1] / CELL) + HALF
        for i in range(max(0, ci - wide), min(_SIDE, ci + wide + 1)):
            for j in range(max(0, cj - wide), min(_SIDE, cj + wide + 1)):
                dx, dy = points[k, 0] - (i - HALF) * CELL, points[k, 1] - (j - HALF) * CELL
                if math.hypot(dx, dy) >= reach + margin:
                    continue
                for h in range(2 * _COUNT):
                    c, s = math.cos(_LOOKS[h]), math.sin(_LOOKS[h])
                    gap = core_gap(core, c * dx + s * dy, c * dy - s * dx) - rounding
                    out[h, i, j] |= gap < margin
    return out


@array_kernel
def _after(at: int, move: int) -> tuple[int, int, int, float]:
    """Return heading, cell and cost after a move from a pose: 0 ahead, 1 back, 2 left, 3 right."""
    h, i, j = at // (_SIDE * _SIDE), at // _SIDE % _SIDE, at % _SIDE
    if move > 1:
        return (h + (1 if move == 2 else _COUNT - 1)) % _COUNT, i, j, _TURN
    way = 1 - 2 * move
    di, dj = _STEPS[h, 0], _STEPS[h, 1]
    length = CELL * math.hypot(di, dj) * (1.0 if move == 0 else _BACK)
    return h, i + way * di, j + way * dj, length


@array_kernel
def search(blocked: NDArray[np.bool_], yaw: float, gx: float, gy: float) -> NDArray[np.int64]:
    """Return poses from the middle of the map to the goal, or to the border on the path there.

    Args:
        blocked: from `blocked_poses`; the robot's own pose is free.
        yaw: the robot's yaw, rad; the search begins at the nearest heading.
        gx, gy: the goal, relative to the middle of the map, m.

    Returns:
        (L, 3) heading, row and column of each; empty if there is no path.
    """
    first = 0
    for h in range(_COUNT):
        if math.cos(_HEADINGS[h] - yaw) > math.cos(_HEADINGS[first] - yaw):
            first = h
    start = (first * _SIDE + HALF) * _SIDE + HALF
    cost = np.full(_COUNT * _SIDE * _SIDE, np.inf)
    before = np.full(_COUNT * _SIDE * _SIDE, -1)
    cost[start] = 0.0
    queue = [(math.hypot(gx, gy), start)]
    end = -1
    while len(queue) and end < 0:
        least, at = heapq.heappop(queue)
        i, j = at // _SIDE % _SIDE, at % _SIDE
        away = math.hypot(gx - (i - HALF) * CELL, gy - (j - HALF) * CELL)
        if least > cost[at] + away + 1e-9:
            continue  # a shorter path was found since
        if away < 2.0 * CELL or min(i, j) <= 1 or max(i, j) >= _SIDE - 2:
            end = at
        for move in range(4):
            h, p, q, more = _after(at, move)
            if not (0 <= p < _SIDE and 0 <= q < _SIDE) or blocked[2 * h, p, q]:
                continue
            if move > 1 and blocked[2 * (h if move == 3 else (h + _COUNT - 1) % _COUNT) + 1, p, q]:
                continue
            there = (h * _SIDE + p) * _SIDE + q
            if cost[at] + more < cost[there] - 1e-9:
                cost[there] = cost[at] + more
                before[there] = at
                away = math.hypot(gx - (p - HALF) * CELL, gy - (q - HALF) * CELL)
                heapq.heappush(queue, (cost[there] + away, there))
    way = [end]
    while way[-1] >= 0:
        way.append(before[way[-1]])
    out = np.empty((len(way) - 1, 3), dtype=np.int64)
    for k in range(len(way) - 1):
        at = way[len(way) - 2 - k]
        out[k] = (at // (_SIDE * _SIDE), at // _SIDE % _SIDE, at % _SIDE)
    return out


def manoeuvre(
    points: Array,
    pose: tuple[float, float, float],
    goal: tuple[float, float],
    core: Array,
    rounding: float,
    reach: float,
    margin: float,
) -> Array:
    """Return the legs of a path to the goal.

    Args:
        points: (N, 2) obstacles, world frame, m.
        pose: the robot's pose, world frame.
        goal: world frame, m.
        core, rounding, reach, margin: as `blocked_poses`.

    Returns:
        (L, 4) per leg: 1 (ahead), -1 (back) or 0 (turn on the spot), and the pose at its end, world
        frame; empty if there is no path.
    """
    x, y, yaw = pose
    around = points - (x, y)
    around = around[np.abs(around).max(axis=1, initial=0.0) < HALF * CELL + reach]
    blocked = blocked_poses(around, core, rounding, reach, margin)
    way = search(blocked, yaw, goal[0] - x, goal[1] - y)
    legs: list[list[float]] = []
    for k in range(len(way) if len(way) > 1 else 0):
        h, i, j = way[k].tolist()
        kind = 0.0
        if k and h == way[k - 1, 0]:
            step = way[k, 1:] - way[k - 1, 1:]
            kind = 1.0 if np.array_equal(step, _STEPS[h]) else -1.0
        leg = [kind, x + (i - HALF) * CELL, y + (j - HALF) * CELL, float(_HEADINGS[h])]
        if legs and legs[-1][0] == kind:
            legs[-1] = leg
        else:
            legs.append(leg)
    return np.reshape(np.array(legs, dtype=np.float64), (-1, 4))
