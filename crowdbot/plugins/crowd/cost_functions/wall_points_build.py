"""Walls as points: the nearest point of each segment, with shared corners counted once."""

from __future__ import annotations

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


@array_kernel
def counts(s: int, agent: AgentRecord, walls: Rows[WallRecord], params: Pointer) -> bool:
    """Return True if wall s is in range, and its nearest point not that of a wall before it."""
    if not in_range(walls[s].d2, agent.radius, params):
        return False
    for earlier in range(s):
        dx, dy = walls[s].nx - walls[earlier].nx, walls[s].ny - walls[earlier].ny
        if abs(dx) <= SAME and abs(dy) <= SAME:
            return False
    return True
