"""Entry of a robot's centre into its goal zone, a polygon (K, 2) of any orientation."""

from __future__ import annotations

import math

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array


@kernel
def inside(zone: Array, x: float, y: float) -> bool:
    """Return True if a point lies in a polygon; even-odd rule."""
    odd = False
    for k in range(zone.shape[0]):
        x0, y0 = zone[k - 1, 0], zone[k - 1, 1]
        x1, y1 = zone[k, 0], zone[k, 1]
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            odd = not odd
    return odd


@kernel
def entry_fraction(zone: Array, x0: float, y0: float, x1: float, y1: float) -> float:
    """Return the fraction of the way from p0 to p1 at which it first crosses the border.

    Returns 1 if it crosses none, as for a robot that was inside from the start.
    """
    first, sx, sy = 1.0, x1 - x0, y1 - y0
    for k in range(zone.shape[0]):
        ax, ay = zone[k - 1, 0] - x0, zone[k - 1, 1] - y0
        ex, ey = zone[k, 0] - zone[k - 1, 0], zone[k, 1] - zone[k - 1, 1]
        cross = sx * ey - sy * ex
        if cross == 0.0:
            continue
        along, across = (ax * ey - ay * ex) / cross, (ax * sy - ay * sx) / cross
        if 0.0 <= along <= first and 0.0 <= across <= 1.0:
            first = along
    return first


@kernel
def distance_to(zone: Array, x: float, y: float) -> float:
    """Return the distance from a point to a polygon, m; zero inside."""
    if inside(zone, x, y):
        return 0.0
    best = math.inf
    for k in range(zone.shape[0]):
        ax, ay = x - zone[k - 1, 0], y - zone[k - 1, 1]
        ex, ey = zone[k, 0] - zone[k - 1, 0], zone[k, 1] - zone[k - 1, 1]
        along = min(1.0, max(0.0, (ax * ex + ay * ey) / (ex * ex + ey * ey)))
        best = min(best, math.hypot(ax - along * ex, ay - along * ey))
    return best
