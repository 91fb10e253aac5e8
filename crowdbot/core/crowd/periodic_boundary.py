"""Periodic boundaries: people who leave the floor on one side enter on the other.

A side may be infinite: then nothing wraps there.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.state import People
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

#: x0, x1, y0, y1, m.
Box = tuple[float, float, float, float]

#: A floor without borders.
ENDLESS = np.array([-math.inf, math.inf, -math.inf, math.inf])


def images(discs: Array, box: Box, reach: float, *, diagonal: bool = True) -> Array:
    """Return the images of discs across the periodic boundary.

    Args:
        discs: (M, 5) x, y, vx, vy, radius.
        box: x0, x1, y0, y1, m.
        reach: only images closer than this to the floor, m.
        diagonal: True to include images across a corner.

    Returns:
        (K, 5); those across the left border first, then right, below, above, corners.
    """
    width, height = box[1] - box[0], box[3] - box[2]
    sides = [(-width, 0.0), (width, 0.0), (0.0, -height), (0.0, height)]
    if diagonal:
        sides += [(dx, dy) for dx in (-width, width) for dy in (-height, height)]
    found = [np.zeros((0, 5))]
    for dx, dy in sides:
        if not math.isfinite(dx + dy):
            continue
        x, y = discs[:, 0] + dx, discs[:, 1] + dy
        away = np.hypot(
            np.maximum(0.0, np.maximum(box[0] - x, x - box[1])),
            np.maximum(0.0, np.maximum(box[2] - y, y - box[3])),
        )
        shown = discs[away < reach].copy()
        shown[:, 0] += dx
        shown[:, 1] += dy
        found.append(shown)
    return np.concatenate(found)


@kernel
def wrap(agents: People, i: int, box: Array, goals_wrap: bool) -> None:
    """Put agent i back on the floor, one wrap per axis.

    Its goal moves too, so that it continues as on an endless plane. In the original engine goals do
    not move.
    """
    person = agents[i]
    dx, dy = _shift(person.x, box[0], box[1]), _shift(person.y, box[2], box[3])
    if dx != 0.0:
        person.x += dx
        person.jumps += 1.0
        if goals_wrap:
            person.lap_x += dx
            person.goal_x += dx
    if dy != 0.0:
        person.y += dy
        person.jumps += 1.0
        if goals_wrap:
            person.lap_y += dy
            person.goal_y += dy


@kernel
def _shift(at: float, low: float, high: float) -> float:
    """Return the shift that brings a coordinate within its borders, m."""
    if low <= at <= high:
        return 0.0
    return low - high if at > high else high - low
