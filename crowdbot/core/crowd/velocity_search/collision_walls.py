"""Wall segments that an agent with constant velocity may touch first."""

from __future__ import annotations

import math

from crowdbot.core.crowd.velocity_search.collision_rows import HEADER, SAFE, SEGMENT_ROW, SegmentRow
from crowdbot.core.crowd.velocity_search.cost import Pointer
from crowdbot.core.crowd.velocity_search.records import AgentRecord, WallRecord
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.support.records import Rows, as_record, as_rows

#: Number of segments sorted by the earliest contact; all others come later. Sorting hundreds would
#: take longer than skipping them.
SORTED_SEGMENTS = 8


@array_kernel
def swept_width(ux: float, uy: float, radius: float) -> float:
    """Return half the width that a disc sweeps, with a margin for rounding, times speed, m^2/s."""
    return (1.0 + 1e-6) * radius * math.sqrt(ux * ux + uy * uy) + 1e-9


@array_kernel
def is_passed(
    ux: float, uy: float, width: float, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Return True if a moving disc clearly never touches segment a-b.

    Args:
        width: from `swept_width`.
    """
    a, b = ux * ay - uy * ax, ux * by - uy * bx
    beside = (min(a, b) > width) | (max(a, b) < -width)
    # One branch at the caller instead of five here, which processors would guess wrong.
    return bool(beside | (max(ux * ax + uy * ay, ux * bx + uy * by) < -width))


@array_kernel
def is_behind(
    ux: float, uy: float, way: float, width: float, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Return True if a disc does not touch segment a-b within a travelled distance.

    Args:
        way: time times squared speed, m^2/s.
        width: from `swept_width`.
    """
    return bool(min(ux * ax + uy * ay, ux * bx + uy * by) - width > (1.0 + 1e-6) * way)


@array_kernel
def _insert(
    segments: Rows[SegmentRow], discs: int, count: int, earliest: float, later: float
) -> tuple[int, float]:
    """Make room for segment number ``count``; return its row, and the new ``later``.

    Args:
        earliest: time before which it is not touched, s.
        later: the least ``earliest`` of the rows after the last sorted one, s.
    """
    row, last = discs + count, discs + SORTED_SEGMENTS
    if row > last:
        later = min(later, max(earliest, segments[last].earliest))
        if segments[last].earliest > earliest:  # that one goes to the end
            segments[row] = segments[last]
            row = last
    while discs + 1 < row <= last and segments[row - 1].earliest > earliest:
        segments[row] = segments[row - 1]
        row -= 1
    segments[row].earliest = earliest
    return row, later


@array_kernel
def list_segments(
    discs: int,
    agent: AgentRecord,
    walls: Rows[WallRecord],
    wall_count: int,
    limit: float,
    fastest: float,
    most: float,
    work: Pointer,
) -> tuple[int, int]:
    """Write the nearest wall segments after the discs, sorted by time of contact.

    Args:
        limit: largest distance, m.
        fastest: largest speed, m/s.
        most: time after which no contact counts, s.
    """
    segments, count, touched, later = as_rows(work, SEGMENT_ROW), 0, 0, math.inf
    for s in range(wall_count):
        d2 = walls[s].d2
        if d2 > limit * limit:
            continue
        if d2 <= agent.radius**2:
            touched += 1
            continue
        gap = math.sqrt(d2) - agent.radius
        earliest = SAFE * gap / fastest if fastest > 0.0 else math.inf
        if earliest > most:
            continue
        count += 1
        row, later = _insert(segments, discs, count, earliest, later)
        segment, wall = segments[row], walls[s]
        segment.ax, segment.ay, segment.bx, segment.by = wall.ax, wall.ay, wall.bx, wall.by
    if count >= SORTED_SEGMENTS:
        segments[discs + SORTED_SEGMENTS].later = later
    if count > 0:
        segments[discs + 1].later = 0.0
    header, within = as_record(work, HEADER), agent.walls_within
    farther = 0.0 < within < limit and most * fastest > within - agent.radius
    header.unlisted = limit if farther else 0.0
    return count, touched
