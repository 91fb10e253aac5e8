"""Neighbour search: discs in strips across y, sorted along x within each strip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.cost import (
    AX,
    AY,
    BX,
    BY,
    D2,
    NEAR_COLUMNS,
    NPX,
    NPY,
    NVX,
    NVY,
    NX,
    NY,
    REACH,
    RX,
    RY,
    STATIC,
    WALL_D2,
)
from crowdbot.core.support.compile import array_kernel, inline_kernel, kernel
from crowdbot.core.support.stable_order import stable_order
from crowdbot.core.types.arrays import Array

# Columns of a body table: position, velocity, radius, preferred velocity, 1 for a pillar, index
# of the agent or -1.
X, Y, VX, VY, DISC_RADIUS, WANTED_X, WANTED_Y, PILLAR, INDEX = range(9)
DISC_COLUMNS = 9
_NARROWEST = 1.0  # strip, m
_MOST_STRIPS = 512

Starts = NDArray[np.int64]


@kernel
def strip_height(discs: Array, count: int, reach: float) -> float:
    """Height of strips that suits a search within ``reach``, m."""
    low, high = np.inf, -np.inf
    for b in range(count):
        low, high = min(low, discs[b, Y]), max(high, discs[b, Y])
    height = max(_NARROWEST, 0.5 * min(reach, high - low))
    return max(height, (high - low) / (_MOST_STRIPS - 1))


@array_kernel
def sort_discs(discs: Array, count: int, height: float, table: Array) -> tuple[float, Starts]:
    """Write the first ``count`` discs to ``table``, strip by strip, each sorted by x.

    The order depends on where discs are, not on their order in ``discs``.

    Returns:
        lower border of the first strip (m); then for each strip, and for none after the last, its
        first row and where the latest search in it began, which spares the next one the way.
    """
    low, high = np.inf, -np.inf
    for b in range(count):
        low, high = min(low, discs[b, Y]), max(high, discs[b, Y])
    strips = int((high - low) / height) + 1 if count else 0
    starts = np.zeros((strips + 1, 2), np.int64)
    order = stable_order(discs[:count, X])
    for b in range(1, count):  # equal x: by y
        a = b
        while (
            a > 0
            and discs[order[a - 1], X] == discs[order[a], X]
            and discs[order[a - 1], Y] > discs[order[a], Y]
        ):
            order[a - 1], order[a] = order[a], order[a - 1]
            a -= 1
    for b in range(count):
        starts[int((discs[b, Y] - low) / height) + 1, 0] += 1
    for s in range(strips):
        starts[s + 1, 0] += starts[s, 0]
    for s in range(strips + 1):
        starts[s, 1] = starts[s, 0]
    place = starts[:, 0].copy()
    for a in range(count):
        b = order[a]
        strip = int((discs[b, Y] - low) / height)
        for column in range(DISC_COLUMNS):
            table[place[strip], column] = discs[b, column]
        place[strip] += 1
    return low, starts


@inline_kernel
def gather(
    table: Array, starts: Starts, low: float, height: float, me: int, distance: float, near: Array
) -> int:
    """Write the discs closer than ``distance`` (centres, strict) to ``near``; return how many.

    Args:
        table, starts, low, height: as `sort_discs` left them.
        me: row of the disc whose neighbours are sought.
        distance: m.
        near: (>= B, `NEAR_COLUMNS`) output, columns as in
            `crowdbot.core.crowd.velocity_search.cost`.
    """
    px, py, radius = table[me, X], table[me, Y], table[me, DISC_RADIUS]
    last = starts.shape[0] - 2
    bottom = max(0, int(min((py - distance - low) / height, float(last))))
    top = int(min((py + distance - low) / height, float(last)))
    limit, count = distance * distance, 0
    for strip in range(bottom, top + 1):
        first, end = starts[strip, 1], starts[strip + 1, 0]
        while first < end and table[first, X] <= px - distance:
            first += 1
        while first > starts[strip, 0] and table[first - 1, X] > px - distance:
            first -= 1
        starts[strip, 1] = first
        for k in range(first, end):
            rx = table[k, X] - px
            if rx >= distance:
                break
            ry = table[k, Y] - py
            d2 = rx * rx + ry * ry
            # Written in any case, kept if near: a branch would often be guessed wrong.
            near[count, D2], near[count, RX], near[count, RY] = d2, rx, ry
            near[count, NVX], near[count, NVY] = table[k, VX], table[k, VY]
            near[count, REACH] = radius + table[k, DISC_RADIUS]
            near[count, NPX], near[count, NPY] = table[k, WANTED_X], table[k, WANTED_Y]
            near[count, STATIC] = table[k, PILLAR]
            count += int(d2 < limit and k != me)
    return count


@inline_kernel
def gather_walls(walls: Array, px: float, py: float, distance: float, found: Array) -> int:
    """Write the segments not farther than ``distance`` to ``found``; return how many.

    Args:
        walls: (S, 4) ends of segments, m.
        found: (>= S, `WALL_COLUMNS`) output, columns as in
            `crowdbot.core.crowd.velocity_search.cost`.
    """
    count = 0
    for s in range(walls.shape[0]):
        ax, ay, bx, by = walls[s, 0] - px, walls[s, 1] - py, walls[s, 2] - px, walls[s, 3] - py
        if min(ax, bx) > distance or max(ax, bx) < -distance:
            continue
        if min(ay, by) > distance or max(ay, by) < -distance:
            continue
        nx, ny = nearest_on_segment(0.0, 0.0, ax, ay, bx, by)
        d2 = nx * nx + ny * ny
        if d2 > distance * distance:
            continue
        found[count, AX], found[count, AY], found[count, BX], found[count, BY] = ax, ay, bx, by
        found[count, NX], found[count, NY], found[count, WALL_D2] = nx, ny, d2
        count += 1
    return count


__all__ = [
    "DISC_COLUMNS",
    "DISC_RADIUS",
    "INDEX",
    "NEAR_COLUMNS",
    "PILLAR",
    "VX",
    "VY",
    "WANTED_X",
    "WANTED_Y",
    "Starts",
    "X",
    "Y",
    "gather",
    "gather_walls",
    "sort_discs",
    "strip_height",
]  # fmt: skip
