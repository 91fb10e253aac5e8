"""Walls as points: the nearest one of each segment, corners once."""

from __future__ import annotations

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import NX, NY, RADIUS, WALL_D2, Pointer, in_range, wall_table

#: Points that are nearer to each other are one, m.
SAME = 1e-9


@array_kernel
def counts(s: int, agent: Pointer, walls: Pointer, params: Pointer) -> bool:
    """Whether wall s is in range and its nearest point is not that of a wall before it."""
    walls = wall_table(walls)
    if not in_range(walls[s, WALL_D2], agent[RADIUS], params):
        return False
    for earlier in range(s):
        dx, dy = walls[s, NX] - walls[earlier, NX], walls[s, NY] - walls[earlier, NY]
        if abs(dx) <= SAME and abs(dy) <= SAME:
            return False
    return True
