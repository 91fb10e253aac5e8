"""When a robot's centre enters its goal zone."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def inside(zone: Array, x: float, y: float) -> bool:
    """Whether a point lies in a polygon (K, 2); even-odd rule, any orientation."""
    x0, y0 = zone[:, 0], zone[:, 1]
    x1, y1 = np.roll(x0, -1), np.roll(y0, -1)
    straddles = (y0 > y) != (y1 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
    return bool(np.count_nonzero(straddles & (x < crossing)) % 2)


def entry_time(zone: Array, before: Array, after: Array, t0: float, t1: float) -> float:
    """Time at which the way from ``before`` (t0) to ``after`` (t1) first crosses the border.

    Returns t1 when it crosses none, as when the robot was inside all along.
    """
    start, end = np.asarray(before), np.asarray(after)
    step = end - start
    first = 1.0
    for a, b in zip(zone, np.roll(zone, -1, axis=0), strict=True):
        edge = b - a
        cross = step[0] * edge[1] - step[1] * edge[0]
        if cross == 0.0:
            continue
        to = a - start
        along = (to[0] * edge[1] - to[1] * edge[0]) / cross
        across = (to[0] * step[1] - to[1] * step[0]) / cross
        if 0.0 <= along <= first and 0.0 <= across <= 1.0:
            first = float(along)
    return t0 + first * (t1 - t0)


def distance_to(zone: Array, x: float, y: float) -> float:
    """Distance from a point to a polygon's border, zero inside, m."""
    if inside(zone, x, y):
        return 0.0
    best = math.inf
    for a, b in zip(zone, np.roll(zone, -1, axis=0), strict=True):
        edge = b - a
        along = float(np.clip(np.dot((x - a[0], y - a[1]), edge) / np.dot(edge, edge), 0.0, 1.0))
        best = min(best, math.hypot(x - a[0] - along * edge[0], y - a[1] - along * edge[1]))
    return best
