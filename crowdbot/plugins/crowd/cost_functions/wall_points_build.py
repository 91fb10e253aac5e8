"""Walls as points: the nearest point of each segment, with shared corners counted once."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
)

#: Points nearer to each other than this are one, m.
SAME = 1e-9
#: Points are sorted into this many cells per metre; equal points lie in one or in neighbours.
_PER_METRE = 1e6
#: Points nearer than this to the border of their cell may be equal to one beside it, cells.
_BORDER = 1.1 * SAME * _PER_METRE
#: Fractional parts of multiples of these are spread evenly.
_MIX_X, _MIX_Y = 0.6180339887498949, 0.7548776662466927
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

    A hash table of cells finds equal points, so that time grows linearly with the number of walls.
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
    x, y = walls[s].nx * _PER_METRE, walls[s].ny * _PER_METRE
    column, row = math.floor(x), math.floor(y)
    known, k = _walk(walls, s, _place(float(column), float(row), size), table, size, work)
    right, up = x - column, y - row  # how far it is in its cell, from 0 to 1
    if min(min(right, up), 1.0 - max(right, up)) < _BORDER:
        for i in range(3):
            for j in range(3):
                beside = _place(float(column + (i - 1)), float(row + (j - 1)), size)
                known = known or _walk(walls, s, beside, table, size, work)[0]
    work[table + k] = s
    return bool(known)


@array_kernel
def _leave_out_of_few(walls: Rows[WallRecord], count: int, work: Pointer) -> int:
    """Do the same by trying all pairs."""
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
    return bool(abs(dx) <= SAME and abs(dy) <= SAME)


@array_kernel
def _place(column: float, row: float, size: int) -> int:
    """Return the first place in the table for a cell."""
    mixed = column * _MIX_X + row * _MIX_Y
    return int((mixed - math.floor(mixed)) * size) & (size - 1)


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
    """Return True if a point like that of wall s comes after place k; and the next empty place."""
    known = False
    while work[table + k] >= 0.0:
        known = known or _are_one(walls, s, int(work[table + k]))
        k = (k + 1) & (size - 1)
    return known, k
