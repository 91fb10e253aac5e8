"""Walls beyond those given to a decision, looked up where they matter."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import nearest_on_segment, time_to_segment
from crowdbot.core.crowd.velocity_search.collision_rows import SAFE
from crowdbot.core.crowd.velocity_search.collision_walls import is_passed, swept_width
from crowdbot.core.crowd.velocity_search.records import FLOOR, WALL_ENDS, AgentRecord
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.support.records import integers_at, rows_at

#: Distances times this are clearly shorter.
_NEARER = 1.0 - 1e-9


@array_kernel
def first_farther(
    ux: float, uy: float, until: float, first: float, limit: float, agent: AgentRecord
) -> float:
    """Return the time until a farther wall is touched, s; or ``first``, if that is less.

    The grid cells along the path are searched in order, until no later one can be touched sooner.

    Args:
        ux, uy: velocity, m/s.
        until: a time below which any value is accepted, s.
        limit: walls farther away than this do not count, m.
    """
    floor, speed = rows_at(agent.floor, FLOOR)[0], math.sqrt(ux * ux + uy * uy)
    t = _NEARER * (agent.walls_within - agent.radius) / speed if speed > 0.0 else math.inf
    if t >= first:
        return first
    if floor.per_metre == 0.0:
        return _in_rows(0, int(floor.number), False, ux, uy, first, limit, agent)
    wide, deep = floor.columns / floor.per_metre, floor.rows / floor.per_metre
    t = max(t, _enters(floor.left, wide, agent.px, ux), _enters(floor.bottom, deep, agent.py, uy))
    if not t < first:
        return first
    x, y = agent.px + t * ux, agent.py + t * uy
    i = math.floor((x - floor.left) * floor.per_metre)
    j = math.floor((y - floor.bottom) * floor.per_metre)
    if _left(i, floor.columns, ux) or _left(j, floor.rows, uy):
        return first
    i, j = max(0, min(i, int(floor.columns) - 1)), max(0, min(j, int(floor.rows) - 1))
    begins = integers_at(floor.first)
    while 0 <= i < floor.columns and 0 <= j < floor.rows and SAFE * t < first:
        cell = int(j * floor.columns + i)
        first = _in_rows(begins[cell], begins[cell + 1], True, ux, uy, first, limit, agent)
        if first < until:
            break
        tx = _leaves(i, ux, agent.px, floor.left, floor.per_metre)
        ty = _leaves(j, uy, agent.py, floor.bottom, floor.per_metre)
        t = min(tx, ty)
        if tx <= ty:
            i += 1 if ux > 0.0 else -1
        if ty <= tx:
            j += 1 if uy > 0.0 else -1
    return first


@array_kernel
def _enters(border: float, width: float, start: float, u: float) -> float:
    """Return the time at which the path enters the strip ``border`` to ``border + width``, s.

    Negative if it is already; ``inf`` if it never will be.
    """
    before, after = border - start, start - border - width  # m; positive: not there yet
    if u > 0.0:
        return before / u
    if u < 0.0:
        return after / -u
    return math.inf if max(before, after) > 0.0 else -math.inf


@array_kernel
def _left(i: int, columns: float, u: float) -> bool:
    """Return True if column (or row) i is beyond the grid, and the path leads away from it."""
    return bool((i < 0 and u <= 0.0) or (i >= columns and u >= 0.0))


@array_kernel
def _leaves(i: int, u: float, start: float, border: float, per_metre: float) -> float:
    """Return the time at which the way leaves column (or row) i, s; ``inf`` if never."""
    if u == 0.0:
        return math.inf
    return (border + (i + (1 if u > 0.0 else 0)) / per_metre - start) / u


@array_kernel
def _in_rows(
    begin: int, end: int, listed: bool, ux: float, uy: float, first: float, limit: float,
    agent: AgentRecord,
) -> float:  # fmt: skip
    """Return the least of ``first`` and the times until some walls are touched, s.

    Args:
        begin, end: rows of the cells' list, or numbers of walls.
        listed: True for rows of the list.
    """
    floor, width = rows_at(agent.floor, FLOOR)[0], swept_width(ux, uy, agent.radius)
    walls, near = rows_at(floor.walls, WALL_ENDS), integers_at(floor.near)
    for k in range(begin, end):
        wall = walls[near[k] if listed else k]
        ax, ay = wall.ax - agent.px, wall.ay - agent.py
        bx, by = wall.bx - agent.px, wall.by - agent.py
        if is_passed(ux, uy, width, ax, ay, bx, by):
            continue
        nx, ny = nearest_on_segment(0.0, 0.0, ax, ay, bx, by)
        d2 = nx * nx + ny * ny
        if agent.radius * agent.radius < d2 <= limit * limit:
            first = min(first, time_to_segment(ux, uy, agent.radius, ax, ay, bx, by))
    return first


@array_kernel
def walls_closer_than(agent: AgentRecord, limit: float) -> int:
    """Return the number of walls if all are clearly closer than a limit (m); otherwise -1."""
    floor = rows_at(agent.floor, FLOOR)[0]
    dx = max(agent.px - floor.x0, floor.x1 - agent.px)
    dy = max(agent.py - floor.y0, floor.y1 - agent.py)
    return int(floor.number) if dx * dx + dy * dy < _NEARER * limit * limit else -1
