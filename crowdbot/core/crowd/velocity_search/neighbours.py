"""Neighbour search: discs in strips across y, sorted along x within each strip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.records import NeighbourRecord, WallRecord
from crowdbot.core.geometry.segment_grid import cell_of
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows, record_type
from crowdbot.core.support.stable_order import write_stable_order
from crowdbot.core.types.arrays import Array, Indices


class DiscRecord:
    """A disc in a table of all discs.

    Attributes:
        x, y, vx, vy, radius: position, velocity, radius.
        wanted_x, wanted_y: preferred velocity.
        pillar: 1 for a pillar.
        index: index of the agent, or -1.
    """

    x: float
    y: float
    vx: float
    vy: float
    radius: float
    wanted_x: float
    wanted_y: float
    pillar: float
    index: float


DISC = record_type(DiscRecord)
_NARROWEST = 1.0  # strip, m
_MOST_STRIPS = 512
#: Rows of scratch for `Starts`.
START_ROWS = _MOST_STRIPS + 2

Starts = NDArray[np.int64]


@kernel
def strip_height(discs: Rows[DiscRecord], count: int, reach: float) -> float:
    """Return a height of strips that suits a search within ``reach``, m."""
    low, high = np.inf, -np.inf
    for b in range(count):
        low, high = min(low, discs[b].y), max(high, discs[b].y)
    height = max(_NARROWEST, 0.5 * min(reach, high - low))
    return max(height, (high - low) / (_MOST_STRIPS - 1))


@kernel
def sort_discs(
    discs: Rows[DiscRecord], count: int, height: float, table: Rows[DiscRecord], starts: Starts,
    order: Indices,
) -> tuple[float, int]:  # fmt: skip
    """Write the first ``count`` discs to ``table``, strip by strip, each sorted by x.

    The order depends on the discs' positions, not on their order in ``discs``.

    Args:
        starts: (>= `START_ROWS`, 2) output: per strip and once after the last, its first row and
            the start of the last search in it, which speeds up the next one.
        order: (2, >= B) scratch.

    Returns:
        lower border of the first strip (m), and number of strips.
    """
    low, high = np.inf, -np.inf
    for b in range(count):
        low, high = min(low, discs[b].y), max(high, discs[b].y)
    strips = int((high - low) / height) + 1 if count else 0
    starts[: strips + 1] = 0
    by_x = order[0]
    write_stable_order(discs[:count]["x"], by_x, order[1])
    for b in range(1, count):  # equal x: by y
        a = b
        while (
            a > 0
            and discs[by_x[a - 1]].x == discs[by_x[a]].x
            and discs[by_x[a - 1]].y > discs[by_x[a]].y
        ):
            by_x[a - 1], by_x[a] = by_x[a], by_x[a - 1]
            a -= 1
    for b in range(count):
        starts[int((discs[b].y - low) / height) + 1, 0] += 1
    for s in range(strips):
        starts[s + 1, 0] += starts[s, 0]
    for s in range(strips + 1):
        starts[s, 1] = starts[s, 0]
    for a in range(count):
        b = by_x[a]
        strip = int((discs[b].y - low) / height)
        table[starts[strip, 1]] = discs[b]
        starts[strip, 1] += 1
    for s in range(strips + 1):
        starts[s, 1] = starts[s, 0]
    return low, strips


@inline_kernel
def gather(
    table: Rows[DiscRecord], starts: Starts, low: float, height: float, me: int, distance: float,
    near: Rows[NeighbourRecord],
) -> int:  # fmt: skip
    """Write the discs closer than ``distance`` (centres, strict) to ``near``; return their number.

    Args:
        table, starts, low, height: as from `sort_discs`.
        me: row of the disc whose neighbours are searched.
        distance: m.
        near: (>= B,) output.
    """
    px, py, radius = table[me].x, table[me].y, table[me].radius
    last = starts.shape[0] - 2
    bottom = max(0, int(min((py - distance - low) / height, float(last))))
    top = int(min((py + distance - low) / height, float(last)))
    limit, count = distance * distance, 0
    for strip in range(bottom, top + 1):
        first, end = starts[strip, 1], starts[strip + 1, 0]
        while first < end and table[first].x <= px - distance:
            first += 1
        while first > starts[strip, 0] and table[first - 1].x > px - distance:
            first -= 1
        starts[strip, 1] = first
        for k in range(first, end):
            rx = table[k].x - px
            if rx >= distance:
                break
            ry = table[k].y - py
            d2 = rx * rx + ry * ry
            # Written always and kept if near: a branch would often be mispredicted.
            near[count].d2, near[count].rx, near[count].ry = d2, rx, ry
            near[count].nvx, near[count].nvy = table[k].vx, table[k].vy
            near[count].reach = radius + table[k].radius
            near[count].npx, near[count].npy = table[k].wanted_x, table[k].wanted_y
            near[count].static = table[k].pillar
            count += int(d2 < limit and k != me)
    return count


@inline_kernel
def gather_walls(
    walls: Array, frame: Array, first: Indices, cells: Indices, covered: float,
    px: float, py: float, distance: float, found: Rows[WallRecord],
) -> int:  # fmt: skip
    """Write the segments within ``distance`` to ``found``; return their number.

    Args:
        walls: (S, 4) ends of segments, m.
        frame, first, cells, covered: their `SegmentGrid`, and its reach; farther, all are tried.
        found: (>= S,) output.
    """
    return int(
        gather_walls_in(
            walls, frame, first, cells, covered, px, py, distance, -distance, -distance, distance,
            distance, found,
        )
    )  # fmt: skip


@inline_kernel
def gather_walls_in(
    walls: Array, frame: Array, first: Indices, cells: Indices, covered: float,
    px: float, py: float, distance: float, left: float, low: float, right: float, high: float,
    found: Rows[WallRecord],
) -> int:  # fmt: skip
    """Write those of the segments that `gather_walls` finds whose own box touches a given one.

    Args:
        left, low, right, high: borders of the box relative to the point, m.
    """
    count, begin, end, listed = 0, 0, walls.shape[0], distance <= covered
    if listed:
        cell = cell_of(frame, px, py)
        begin, end = (first[cell], first[cell + 1]) if cell >= 0 else (0, 0)
    for k in range(begin, end):
        s = cells[k] if listed else k
        ax, ay, bx, by = walls[s, 0] - px, walls[s, 1] - py, walls[s, 2] - px, walls[s, 3] - py
        if min(ax, bx) > right or max(ax, bx) < left:
            continue
        if min(ay, by) > high or max(ay, by) < low:
            continue
        nx, ny = nearest_on_segment(0.0, 0.0, ax, ay, bx, by)
        d2 = nx * nx + ny * ny
        if d2 > distance * distance:
            continue
        found[count].ax, found[count].ay, found[count].bx, found[count].by = ax, ay, bx, by
        found[count].nx, found[count].ny, found[count].d2 = nx, ny, d2
        count += 1
    return count
