"""Walls that another wall hides from every point of a cell, compiled."""

from __future__ import annotations

import math

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: A line of sight has to cross the nearer wall this far from its ends and before the farther one,
#: as shares of their lengths, so that rounding decides nothing.
_MARGIN = 1e-6


@kernel
def _crosses(ax: float, ay: float, bx: float, by: float, wall: Array) -> bool:
    """Return True if the way from a to b crosses a wall clearly before b."""
    dx, dy = bx - ax, by - ay
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = wall[0] - ax, wall[1] - ay
    across = dx * ey - dy * ex
    if across == 0.0:
        return False
    way, along = (px * ey - py * ex) / across, (px * dy - py * dx) / across
    return bool(0.0 < way < 1.0 - _MARGIN and _MARGIN < along < 1.0 - _MARGIN)


@kernel
def _hides(x: float, y: float, half: float, near: Array, far: Array) -> bool:
    """Return True if a wall hides another from a square with the middle (x, y).

    All points of the square and of the farther wall see each other between the lines through their
    corners and ends. Where the nearer wall, which is straight, crosses all of these lines, it
    crosses all ways between.
    """
    for corner in range(4):
        ax = x - half if corner % 2 == 0 else x + half
        ay = y - half if corner < 2 else y + half
        if not _crosses(ax, ay, far[0], far[1], near) or not _crosses(ax, ay, far[2], far[3], near):
            return False
    return True


@kernel
def hidden_walls(
    x: float, y: float, half: float, walls: Array, heights: Array, order: Indices,
    hidden: Mask,
) -> tuple[float, float]:  # fmt: skip
    """Mark the walls that a single nearer one hides from a square.

    A wall that reaches as low and as high as another hides it from sensors between its bottom and
    its top: a line of sight is there at a height between those of the sensor and of what it hits.

    Args:
        x, y, half: middle of the square and half of its side, m.
        walls, heights: (S, 4), (S, 2), m, as in `crowdbot.core.sensing.scene.Scene`.
        order: (S,) the walls, about nearest first.
        hidden: (S,) result.

    Returns:
        lowest and highest sensor for which that holds, m.
    """
    lowest, highest = -math.inf, math.inf
    for k in range(order.shape[0]):
        far = order[k]
        hidden[far] = False
        for j in range(k):
            near = order[j]
            if hidden[near] or heights[near, 0] > heights[far, 0]:
                continue
            if heights[near, 1] >= heights[far, 1] and _hides(x, y, half, walls[near], walls[far]):
                hidden[far] = True
                lowest = max(lowest, heights[near, 0])
                highest = min(highest, heights[near, 1])
                break
    return lowest, highest
