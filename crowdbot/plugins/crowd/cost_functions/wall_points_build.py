"""Walls as points: the nearest point of each segment, with shared corners counted once."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    AgentRecord,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    in_range,
)

#: Points nearer to each other than this are one, m.
SAME = 1e-9
#: Side of the cells into which points are sorted, m; equal points lie in one or in neighbours.
_CELL = 1e-6
#: With fewer walls all pairs are tried.
_FEW = 16
#: Entries of ``work`` before the marks; forces need fewer.
_FIRST = 8


@array_kernel
def mark_repeated(walls: Rows[WallRecord], count: int, work: Pointer) -> None:
    """Note in ``work`` which walls have the nearest point of a wall before them; see `counts`.

    A table of cells finds equal points, so that the time grows as the number of walls does.
    """
    size = 2
    while size < 2 * count:
        size *= 2
    table = _FIRST + count
    if count > _FEW:
        for k in range(size):
            work[table + k] = -1.0
    for s in range(count):
        if count > _FEW:
            work[_FIRST + s] = 1.0 if _is_known(walls, s, table, size, work) else 0.0
            _remember(walls, s, table, size, work)
        else:
            work[_FIRST + s] = 0.0
            for earlier in range(s):
                if _are_one(walls, s, earlier):
                    work[_FIRST + s] = 1.0


@array_kernel
def counts(
    s: int, agent: AgentRecord, walls: Rows[WallRecord], params: Pointer, work: Pointer
) -> bool:
    """Return True if wall s is in range, and its nearest point not that of a wall before it.

    Args:
        work: as `mark_repeated` left it.
    """
    return bool(in_range(walls[s].d2, agent.radius, params) and work[_FIRST + s] == 0.0)


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
