"""Wall push: a push away from walls that decreases with the gap."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.geometry.segment_grid import cell_of
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Largest push by one wall, m/s^2.
HARDEST = 8.0
#: Share of its strength below which the push is ignored.
LEAST = 4.6  # e-folds: 1 %


@kernel
def push_off_walls(
    decides: Mask, position: Array, radius: Array, walls: Array,
    frame: Array, first: Indices, near: Indices,
    strength: float, reach: float, desired: Array,
) -> None:  # fmt: skip
    """Add the pushes of all walls on people who decide, in place.

    Args:
        position: (N, 2), m; radius: (N,), m.
        walls: (S, 4), m; frame, first, near: their `SegmentGrid`, for the largest radius and
            `LEAST` times the reach.
        strength, reach: see `WallPushSpec`.
        desired: (N, 2) accelerations, m/s^2.
    """
    for i in range(desired.shape[0]):
        if not decides[i]:
            continue
        x, y, far = position[i, 0], position[i, 1], radius[i] + LEAST * reach
        cell = cell_of(frame, x, y)
        if cell < 0:
            continue
        for k in range(first[cell], first[cell + 1]):
            s = near[k]
            ax, ay, bx, by = walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3]
            if min(ax, bx) - far > x or max(ax, bx) + far < x:
                continue
            if min(ay, by) - far > y or max(ay, by) + far < y:
                continue
            wx, wy = nearest_on_segment(x, y, ax, ay, bx, by)
            dx, dy = x - wx, y - wy
            distance = math.sqrt(dx * dx + dy * dy)
            if distance == 0.0 or distance > far:
                continue
            push = min(HARDEST, strength * math.exp((radius[i] - distance) / reach)) / distance
            desired[i, 0] += push * dx
            desired[i, 1] += push * dy
