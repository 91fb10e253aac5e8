"""Walls as points: the nearest point of each segment, with shared corners counted once."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
)
from crowdbot.plugin.for_crowds import SAME_POINT

#: Points are sorted into rings by their squared distance, this many per m^2; equal points lie in
#: one or in neighbours.
_RINGS = 1e3
#: The squared distances of equal points differ by less than 2 SAME_POINT (1 + d^2): with |dx| and
#: |dy| up to SAME_POINT by at most 2^1.5 d SAME_POINT, and 2 d is at most 1 + d^2.
_BORDER = 2.0 * SAME_POINT * _RINGS
#: With fewer walls all pairs are tried.
_FEW = 16
#: Entries of ``work`` before the chosen walls; forces need fewer.
_FIRST = 8


@array_kernel
def choose(k: int, s: int, work: Pointer) -> int:
    """Append wall s to the chosen ones; return their number."""
    work[_FIRST + k] = s
    return k + 1


@array_kernel
def chosen(k: int, work: Pointer) -> int:
    """Return the index of the k-th chosen wall."""
    return int(work[_FIRST + k])


@array_kernel
def leave_out_repeated(walls: Rows[WallRecord], count: int, work: Pointer) -> int:
    """Remove chosen walls whose nearest point repeats an earlier one; return their number.

    A hash table of rings finds equal points, so that time grows linearly with the number of walls.
    """
    if count <= _FEW:
        return int(_leave_out_of_few(walls, count, work))
    table, stay = _FIRST + count, 0
    size = clear_table(table, count, work)
    for k in range(count):
        s = chosen(k, work)
        if not is_known(walls, s, table, size, work):
            stay = choose(stay, s, work)
    return stay


@array_kernel
def clear_table(table: int, count: int, work: Pointer) -> int:
    """Make an empty table for ``count`` walls at entry ``table`` of ``work``; return its size."""
    size = 2
    while size < 2 * count:
        size *= 2
    for k in range(size):
        work[table + k] = -1.0
    return size


@array_kernel
def is_known(walls: Rows[WallRecord], s: int, table: int, size: int, work: Pointer) -> bool:
    """Put wall s in the table; return True if its nearest point is in it, there or beside it."""
    d2 = walls[s].d2
    ring = math.floor(d2 * _RINGS)
    known, k = _walk(walls, s, int(ring) & (size - 1), table, size, work)
    within = d2 * _RINGS - ring  # from 0 to 1
    if min(within, 1.0 - within) < _BORDER * (1.0 + d2):
        for other in (int(ring) - 1, int(ring) + 1):
            known = known or _walk(walls, s, other & (size - 1), table, size, work)[0]
    work[table + k] = s
    return bool(known)


@array_kernel
def _leave_out_of_few(walls: Rows[WallRecord], count: int, work: Pointer) -> int:
    """Do as `leave_out_repeated`, by comparing all pairs of walls."""
    table, stay = _FIRST + count, 0
    for k in range(count):
        s, known = chosen(k, work), False
        for earlier in range(k):
            known = known or _are_one(walls, s, int(work[table + earlier]))
        work[table + k] = s
        if not known:
            stay = choose(stay, s, work)
    return stay


@array_kernel
def _are_one(walls: Rows[WallRecord], s: int, other: int) -> bool:
    dx, dy = walls[s].nx - walls[other].nx, walls[s].ny - walls[other].ny
    return bool(abs(dx) <= SAME_POINT and abs(dy) <= SAME_POINT)


@array_kernel
def repeats(walls: Rows[WallRecord], s: int) -> bool:
    """Return True if wall s's nearest point is that of one before it; tries all of them."""
    known = False
    for other in range(s):
        known = known or _are_one(walls, s, other)
    return known


@array_kernel
def _walk(
    walls: Rows[WallRecord], s: int, k: int, table: int, size: int, work: Pointer
) -> tuple[bool, int]:
    """Search the table from place k.

    Returns True if it holds the nearest point of wall s, and the next empty place.
    """
    known = False
    while work[table + k] >= 0.0:
        known = known or _are_one(walls, s, int(work[table + k]))
        k = (k + 1) & (size - 1)
    return known, k
