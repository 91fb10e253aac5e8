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
#: Side of the cells into which points are sorted, m; equal points lie in one or in neighbours.
_CELL = 1e-6
#: With fewer walls all pairs are tried.
_FEW = 16
#: Entries of ``work`` before the chosen walls; forces need fewer.
_FIRST = 8


@array_kernel
def choose(k: int, s: int, work: Pointer) -> int:
    """Note wall s as number k of those chosen; return the number of these."""
    work[_FIRST + k] = s
    return k + 1


@array_kernel
def chosen(k: int, work: Pointer) -> int:
    """Return the index of wall number k of those chosen."""
    return int(work[_FIRST + k])


@array_kernel
def leave_out_repeated(walls: Rows[WallRecord], count: int, work: Pointer) -> int:
    """Leave out chosen walls with the nearest point of a wall chosen before; return how many stay.

    A table of cells finds equal points, so that the time grows as the number of walls does.
    """
    size, stay = 2, 0
    while size < 2 * count:
        size *= 2
    table = _FIRST + count
    if count > _FEW:
        for k in range(size):
            work[table + k] = -1.0
    for k in range(count):
        s, known = chosen(k, work), False
        if count > _FEW:
            known = _is_known(walls, s, table, size, work)
            _remember(walls, s, table, size, work)
        else:
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
def _place(x: float, y: float, size: int) -> int:
    """Return the first place in the table for the cell of a point."""
    column, row = math.floor(x / _CELL), math.floor(y / _CELL)
    return int((column * 73856093 ^ row * 19349663) & (size - 1))


@array_kernel
def _is_known(walls: Rows[WallRecord], s: int, table: int, size: int, work: Pointer) -> bool:
    """Return True if the nearest point of wall s is in the table, in its cell or beside it."""
    x, y = walls[s].nx, walls[s].ny
    inside = _place(x - SAME, y - SAME, size) == _place(x + SAME, y + SAME, size)
    for side in range(1 if inside else 4):
        px, py = x + (2.0 * (side % 2) - 1.0) * SAME, y + (2.0 * (side // 2) - 1.0) * SAME
        k = _place(px, py, size)
        while work[table + k] >= 0.0:
            if _are_one(walls, s, int(work[table + k])):
                return True
            k = (k + 1) & (size - 1)
    return False


@array_kernel
def _remember(walls: Rows[WallRecord], s: int, table: int, size: int, work: Pointer) -> None:
    k = _place(walls[s].nx, walls[s].ny, size)
    while work[table + k] >= 0.0:
        k = (k + 1) & (size - 1)
    work[table + k] = s
