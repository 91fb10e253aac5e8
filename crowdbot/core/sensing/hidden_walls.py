"""Find walls that are hidden by others from every point of a square; compiled.

All lines of sight from a square to a straight wall lie in the convex hull of both. Connected walls
that reach from one side of the hull to the other, without touching the square or the wall, block
them all.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: What crosses or lies within does so this far from all ends, as shares of lengths, so that
#: rounding decides nothing.
_MARGIN = 1e-6
#: An end this near to another wall touches it, as a share of its own wall's length; rays meet walls
#: a little beyond their ends, see `crowdbot.core.sensing.ray_grid.OVERLAP`.
_TOUCH = 1e-12
#: Largest number of walls that hide others, and of places per wall where two of them touch.
_MOST_HIDERS, _JOINTS = 256, 4
#: Parts of a chain: not of it, of neither flank yet, connected to the first, crossing the second.
_REFUSED, _FREE, _LEFT, _RIGHT = -1, 0, 1, 2
#: Flanks that are crossed: both by one wall, each by some wall, not both.
_BOTH, _EACH, _NEITHER = 2, 1, 0


@kernel
def _side(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Return a number above 0 if a point is to the left of the line from a to b, m^2."""
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)


@kernel
def _crosses(flank: Array, wall: Array) -> bool:
    """Return True if two segments cross clearly within both."""
    dx, dy = flank[2] - flank[0], flank[3] - flank[1]
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = wall[0] - flank[0], wall[1] - flank[1]
    across = dx * ey - dy * ex
    if across == 0.0:
        return False
    way, along = (px * ey - py * ex) / across, (px * dy - py * dx) / across
    return bool(_MARGIN < way < 1.0 - _MARGIN and _MARGIN < along < 1.0 - _MARGIN)


@kernel
def _find_flanks(x: float, y: float, half: float, far: Array, flanks: Array) -> bool:
    """Write the sides of the hull of a square and a wall that join both; False: it has none.

    Args:
        flanks: (2, 4) from a corner of the square to an end of the wall; all the rest of the hull
            is to the left of the first and to the right of the second.
    """
    longest0 = longest1 = 0.0
    for corner in range(4):
        ax = x - half if corner % 2 == 0 else x + half
        ay = y - half if corner < 2 else y + half
        for end in range(2):
            bx, by = far[2 * end], far[2 * end + 1]
            other = _side(ax, ay, bx, by, far[2 - 2 * end], far[3 - 2 * end])
            least, most = min(other, 0.0), max(other, 0.0)
            for k in range(4):
                cx = x - half if k % 2 == 0 else x + half
                cy = y - half if k < 2 else y + half
                if k != corner:
                    side = _side(ax, ay, bx, by, cx, cy)
                    least, most = min(least, side), max(most, side)
            long = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
            if least >= 0.0 and long > longest0:
                longest0 = long
                flanks[0, 0], flanks[0, 1], flanks[0, 2], flanks[0, 3] = ax, ay, bx, by
            elif most <= 0.0 and long > longest1:
                longest1 = long
                flanks[1, 0], flanks[1, 1], flanks[1, 2], flanks[1, 3] = ax, ay, bx, by
    return longest0 > 0.0 and longest1 > 0.0


@kernel
def _between(flanks: Array, x: float, y: float) -> bool:
    """Return True if a point lies clearly between two flanks, neither beyond nor behind them."""
    ax, ay, bx, by = flanks[0, 0], flanks[0, 1], flanks[0, 2], flanks[0, 3]
    cx, cy, dx, dy = flanks[1, 0], flanks[1, 1], flanks[1, 2], flanks[1, 3]
    least = _MARGIN * ((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
    return bool(
        _side(ax, ay, bx, by, x, y) > least
        and _side(cx, cy, dx, dy, x, y) < -least
        and _side(ax, ay, cx, cy, x, y) < -least
        and ((bx == dx and by == dy) or _side(bx, by, dx, dy, x, y) > least)
    )


@kernel
def _beside(line: Array, wall: Array) -> bool:
    """Return True if a wall lies clearly on one side of a line, but for an end that both share."""
    ax, ay, bx, by = line[0], line[1], line[2], line[3]
    least = _MARGIN * ((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
    first, last = _side(ax, ay, bx, by, wall[0], wall[1]), _side(ax, ay, bx, by, wall[2], wall[3])
    for k in range(2):
        if (wall[2 * k] == ax and wall[2 * k + 1] == ay) or (
            wall[2 * k] == bx and wall[2 * k + 1] == by
        ):
            if k == 0:
                first = last
            else:
                last = first
    return bool((first > least and last > least) or (first < -least and last < -least))


@kernel
def _apart(first: Array, second: Array) -> bool:
    """Return True if two walls do not touch, but for an end that both share."""
    return _beside(first, second) or _beside(second, first)


@kernel
def _touches_square(x: float, y: float, half: float, wall: Array) -> bool:
    """Return True if a wall may touch a square."""
    wide = half * (1.0 + _MARGIN)
    if max(wall[0], wall[2]) < x - wide or min(wall[0], wall[2]) > x + wide:
        return False
    if max(wall[1], wall[3]) < y - wide or min(wall[1], wall[3]) > y + wide:
        return False
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    middle = _side(wall[0], wall[1], wall[2], wall[3], x, y)
    return bool(abs(middle) <= wide * (abs(ex) + abs(ey)))


@kernel
def _joint(first: Array, second: Array, joint: Array) -> bool:
    """Write the point where two walls touch or cross; False: they do not."""
    ex, ey = first[2] - first[0], first[3] - first[1]
    fx, fy = second[2] - second[0], second[3] - second[1]
    for k in range(4):
        i, j = 2 * (k // 2), 2 * (k % 2)
        if first[i] == second[j] and first[i + 1] == second[j + 1]:
            joint[0], joint[1] = first[i], first[i + 1]
            return True
    across = ex * fy - ey * fx
    lengths = math.sqrt((ex * ex + ey * ey) * (fx * fx + fy * fy))
    if abs(across) <= 1e-3 * lengths:  # nearly parallel
        return False
    px, py = second[0] - first[0], second[1] - first[1]
    s, t = (px * fy - py * fx) / across, (px * ey - py * ex) / across
    if not (-_TOUCH <= s <= 1.0 + _TOUCH and -_TOUCH <= t <= 1.0 + _TOUCH):
        return False
    joint[0], joint[1] = first[0] + s * ex, first[1] + s * ey
    return True


class _Chains(NamedTuple):
    """Walls that hide others, and where they touch.

    Attributes:
        walls, heights: (S, 4), (S, 2) all walls, m.
        hiders: (H,) those that hide others.
        joints: (J, 4) indices of two hiders, and the point where they touch, m.
        reached: (H,) scratch: `_REFUSED`, `_FREE`, `_LEFT` or `_RIGHT` for each hider.
    """

    walls: Array
    heights: Array
    hiders: Indices
    joints: Array
    reached: Indices


@kernel
def _reach_flanks(
    far: Array, low: float, high: float, flanks: Array, count: int, chains: _Chains
) -> int:
    """Write which hiders cross a flank; return `_BOTH`, `_EACH` or `_NEITHER`.

    Hiders are refused that are lower than ``low`` and ``high`` ask for, or that touch the wall.
    """
    walls, reached, crossed = chains.walls, chains.reached, 0
    for k in range(count):
        near = chains.hiders[k]
        reached[k] = _FREE
        if chains.heights[near, 0] > low or chains.heights[near, 1] < high:
            reached[k] = _REFUSED
            continue
        left, right = _crosses(flanks[0], walls[near]), _crosses(flanks[1], walls[near])
        if not left and not right:
            continue
        if not _apart(walls[near], far):
            reached[k] = _REFUSED
        elif left and right:
            return _BOTH
        else:
            reached[k] = _LEFT if left else _RIGHT
            crossed |= 1 if left else 2
    return _EACH if crossed == 3 else _NEITHER


@kernel
def _joins_flanks(far: Array, flanks: Array, joined: int, chains: _Chains) -> bool:
    """Return True if a chain of hiders leads from one flank to the other."""
    reached, joints, grows = chains.reached, chains.joints, True
    while grows:
        grows = False
        for j in range(joined):
            a, b = int(joints[j, 0]), int(joints[j, 1])
            if reached[a] != _LEFT:
                a, b = b, a
            if reached[a] != _LEFT or reached[b] == _LEFT or reached[b] == _REFUSED:
                continue
            if not _between(flanks, joints[j, 2], joints[j, 3]):
                continue
            if reached[b] == _RIGHT:
                return True
            reached[b] = _LEFT if _apart(chains.walls[chains.hiders[b]], far) else _REFUSED
            grows = True
    return False


@kernel
def _join(chains: _Chains, count: int, joined: int, joint: Array) -> int:
    """Add the joints of the last of ``count`` hiders; return the number of all joints."""
    new = chains.walls[chains.hiders[count - 1]]
    for k in range(count - 1):
        if joined < chains.joints.shape[0] and _joint(chains.walls[chains.hiders[k]], new, joint):
            row = chains.joints[joined]
            row[0], row[1], row[2], row[3] = k, count - 1, joint[0], joint[1]
            joined += 1
    return joined


@array_kernel
def hidden_walls(
    square: tuple[float, float, float], sensors: tuple[float, float], walls: Array, heights: Array,
    order: Indices, hidden: Mask,
) -> None:  # fmt: skip
    """Mark the walls that others hide from a square.

    A hiding wall must span the heights of the hidden one and of the sensors: lines of sight pass it
    at a height between those of the sensor and the hit.

    Args:
        square: its middle x, y, and half of its side, m.
        sensors: lowest and highest height of sensors, m.
        walls, heights: (S, 4), (S, 2), m, as in `crowdbot.core.sensing.scene.Scene`.
        order: (S,) the walls, about nearest first.
        hidden: (S,) result.
    """
    x, y, half = square
    most = min(_MOST_HIDERS, order.shape[0])
    flanks, joint = np.empty((2, 4)), np.empty(2)
    hiders, reached = np.empty(most, np.int64), np.empty(most, np.int64)
    chains = _Chains(walls, heights, hiders, np.empty((_JOINTS * most, 4)), reached)
    count = joined = 0
    for i in order:
        far = walls[i]
        low, high = min(heights[i, 0], sensors[0]), max(heights[i, 1], sensors[1])
        hidden[i] = False
        if _find_flanks(x, y, half, far, flanks):
            crossed = _reach_flanks(far, low, high, flanks, count, chains)
            hidden[i] = crossed == _BOTH or (
                crossed == _EACH and _joins_flanks(far, flanks, joined, chains)
            )
        if not hidden[i] and count < most and not _touches_square(x, y, half, far):
            hiders[count] = i
            count += 1
            joined = _join(chains, count, joined, joint)
