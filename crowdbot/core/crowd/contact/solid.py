"""Walls and pillars as hard limits for people's centres, whatever the contact forces."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import People
from crowdbot.core.geometry.segment_grid import cell_of
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: Largest overlap of a body with anything solid where this is a limit, m.
MOST_OVERLAP = 0.02
#: Smallest distance of a centre from anything solid where overlap has no limit, m.
OUTSIDE = 1e-3
#: Longest step for which the grid holds all walls, beside the radius, m.
LONGEST_STEP = 0.25
#: Corrections of one step; what they do not solve ends where it began.
_ROUNDS = 6
#: A distance that is shorter by less is rounding, m.
_SLACK = 1e-9


@kernel
def keep_out(
    agents: People, i: int, x0: float, y0: float, room: float,
    walls: Array, frame: Array, first: Indices, near: Indices, discs: Array, pillars: int,
) -> None:  # fmt: skip
    """Correct a step of agent i that ends too close to a solid, or behind a wall.

    A centre that was closer at the start of the step may stay as close. Motion into a solid is
    removed, motion along it stays.

    Args:
        x0, y0: start of the step, m.
        room: smallest distance of the centre from walls and pillars, m.
        walls to near: walls (S, 4) and fields of their `SegmentGrid`.
        discs, pillars: (D, 3) x, y, radius; the first ones are pillars.
    """
    begin, end = 0, walls.shape[0]
    listed = math.hypot(agents[i].x - x0, agents[i].y - y0) <= LONGEST_STEP
    if listed:
        cell = cell_of(frame, x0, y0)
        begin = first[cell] if cell >= 0 else 0
        end = first[cell + 1] if cell >= 0 else 0
    for _ in range(_ROUNDS):
        moved = False
        for k in range(begin, end):
            s = near[k] if listed else k
            if _off_wall(
                agents, i, x0, y0, room, walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3]
            ):
                moved = True
        for d in range(pillars):
            if _off_pillar(agents, i, x0, y0, room + discs[d, 2], discs[d, 0], discs[d, 1]):
                moved = True
        if not moved:
            return
    agents[i].x, agents[i].y, agents[i].vx, agents[i].vy = x0, y0, 0.0, 0.0


@kernel
def _off_wall(
    agents: People, i: int, x0: float, y0: float, room: float,
    ax: float, ay: float, bx: float, by: float,
) -> bool:  # fmt: skip
    """Move a centre to the side of a wall from which it came; return True if it had to be moved."""
    x, y = agents[i].x, agents[i].y
    if max(x0, x) < min(ax, bx) - room or min(x0, x) > max(ax, bx) + room:
        return False
    if max(y0, y) < min(ay, by) - room or min(y0, y) > max(ay, by) + room:
        return False
    nx, ny = nearest_on_segment(x, y, ax, ay, bx, by)
    dx, dy = x - nx, y - ny
    distance = math.sqrt(dx * dx + dy * dy)
    behind = _cross(x0, y0, x, y, ax, ay, bx, by)
    if not behind and distance >= room - _SLACK:
        return False
    mx, my = nearest_on_segment(x0, y0, ax, ay, bx, by)
    before = math.sqrt((x0 - mx) ** 2 + (y0 - my) ** 2)
    target = min(room, before)
    if not behind and distance >= target - _SLACK:
        return False
    if behind or distance == 0.0:
        dx, dy = (x0 - mx, y0 - my) if distance == 0.0 else (-dx, -dy)
        distance = before if distance == 0.0 else distance
        if distance == 0.0:
            return False
    _place_at(agents, i, nx, ny, dx / distance, dy / distance, target)
    return True


@kernel
def _off_pillar(
    agents: People, i: int, x0: float, y0: float, room: float, px: float, py: float
) -> bool:
    """Move a centre out of a pillar; return True if it had to be moved."""
    dx, dy = agents[i].x - px, agents[i].y - py
    distance = math.sqrt(dx * dx + dy * dy)
    if distance >= room - _SLACK:
        return False
    before = math.sqrt((x0 - px) ** 2 + (y0 - py) ** 2)
    target = min(room, before)
    if distance >= target - _SLACK or before == 0.0:
        return False
    if distance == 0.0:
        dx, dy, distance = x0 - px, y0 - py, before
    _place_at(agents, i, px, py, dx / distance, dy / distance, target)
    return True


@kernel
def _place_at(
    agents: People, i: int, px: float, py: float, nx: float, ny: float, distance: float
) -> None:
    """Put a centre at a distance from a point along a normal, and stop its motion against it."""
    agents[i].x, agents[i].y = px + distance * nx, py + distance * ny
    inwards = agents[i].vx * nx + agents[i].vy * ny
    if inwards < 0.0:
        agents[i].vx -= inwards * nx
        agents[i].vy -= inwards * ny


@kernel
def _cross(
    px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Return True if the way from p to q crosses the segment from a to b."""
    ex, ey = bx - ax, by - ay
    one = ex * (py - ay) - ey * (px - ax)
    other = ex * (qy - ay) - ey * (qx - ax)
    if (one > 0.0) == (other > 0.0):
        return False
    wx, wy = qx - px, qy - py
    return (wx * (ay - py) - wy * (ax - px) > 0.0) != (wx * (by - py) - wy * (bx - px) > 0.0)
