"""Contact forces between people, walls and fixed discs."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import (
    People,
)
from crowdbot.core.crowd.traits import TraitsRecord
from crowdbot.core.geometry.segment_grid import cell_of
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows, record_type
from crowdbot.core.types.arrays import Array, Indices


class PlacedRecord:
    """A person who is present, in scratch memory of `push_apart` that is sorted by x."""

    x: float
    y: float
    radius: float
    stiffness: float
    vx: float
    vy: float
    push_x: float
    push_y: float
    row: float


PLACED = record_type(PlacedRecord)
#: A person farther than this from a wall's box, beside the radius, is not near it by rounding, m.
_CLEAR = 1e-6
#: Largest change of a velocity towards another by damping, 1/s: stable for ticks of 1/128 s.
_MOST_DAMPING = 32.0


@kernel
def push_apart(
    agents: People,
    traits: Rows[TraitsRecord],
    order: NDArray[np.int64],
    walls: Array,
    frame: Array,
    first: Indices,
    near: Indices,
    discs: Array,
    pillars: int,
    dissipation: float,
    placed: Rows[PlacedRecord],
    room: Array,
) -> None:
    """Write contact accelerations by people, walls and fixed discs, m/s^2.

    Args:
        order: (N,) all agents in any order; sorted by x afterwards.
        walls: (S, 4) segments.
        frame, first, near: their `SegmentGrid`, whose reach is at least the largest radius.
        discs: (D, 3) x, y, radius: pillars, and people as they appear across a border.
        pillars: number of pillars.
        dissipation: how much stiffer contact is while it closes, s/m; 0: an elastic spring.
        placed: (N,) scratch.
        room: (N,) output: as in `crowdbot.core.crowd.parameters.Scratch`.
    """
    _sort_along_x(agents, order)
    count, largest = _place(agents, traits, order, placed)
    for a in range(count):
        cell = cell_of(frame, placed[a].x, placed[a].y)
        gap = math.inf
        if cell >= 0:
            gap = _push_by_walls(placed, a, walls, near, first[cell], first[cell + 1], dissipation)
        for d in range(discs.shape[0]):
            reach = placed[a].radius + discs[d, 2]
            dx, dy = placed[a].x - discs[d, 0], placed[a].y - discs[d, 1]
            px, py = _push(dx, dy, reach)
            if d < pillars and dx * dx + dy * dy < reach * reach:
                gap = min(gap, math.sqrt(dx * dx + dy * dy) - discs[d, 2])
            rate = _damped(placed, a, px, py, placed[a].vx, placed[a].vy, dissipation)
            placed[a].push_x += rate * px
            placed[a].push_y += rate * py
        room[int(placed[a].row)] = gap
        x, y, own = placed[a].x, placed[a].y, placed[a].radius
        for b in range(a + 1, count):
            if placed[b].x - x >= own + largest:
                break
            reach = own + placed[b].radius
            if abs(placed[b].y - y) < reach:
                _push_pair(placed, a, b, reach, dissipation)
    for a in range(count):
        i = int(placed[a].row)
        agents[i].push_x, agents[i].push_y = placed[a].push_x, placed[a].push_y


@kernel
def _sort_along_x(agents: People, order: NDArray[np.int64]) -> None:
    """Sort people by x, equal ones by row, by insertion.

    The order hardly changes from one tick to the next, so this takes few steps.
    """
    for a in range(1, order.shape[0]):
        i = order[a]
        x, b = agents[i].x, a
        while b > 0:
            j = order[b - 1]
            if agents[j].x < x or (agents[j].x == x and j < i):
                break
            order[b] = j
            b -= 1
        order[b] = i


@kernel
def _place(
    agents: People,
    traits: Rows[TraitsRecord],
    order: NDArray[np.int64],
    placed: Rows[PlacedRecord],
) -> tuple[int, float]:
    """Write present people to ``placed``, in order, with zero pushes.

    Returns:
        how many, and the largest radius among them, m.
    """
    count, largest = 0, 0.0
    for i in order:
        if agents[i].waiting != 0.0:
            agents[i].push_x = agents[i].push_y = 0.0
            continue
        placed[count].x, placed[count].y = agents[i].x, agents[i].y
        placed[count].radius, placed[count].stiffness = traits[i].radius, traits[i].push
        placed[count].vx, placed[count].vy = agents[i].vx, agents[i].vy
        placed[count].push_x, placed[count].push_y, placed[count].row = 0.0, 0.0, i
        largest = max(largest, traits[i].radius)
        count += 1
    return count, largest


@kernel
def _push(dx: float, dy: float, reach: float) -> tuple[float, float]:
    """Return the overlap vector of two discs, m, away from the other; zero for equal centres."""
    d2 = dx * dx + dy * dy
    if d2 >= reach * reach or d2 == 0.0:
        return 0.0, 0.0
    distance = math.sqrt(d2)
    push = (reach - distance) / distance
    return push * dx, push * dy


@kernel
def _damped(
    placed: Rows[PlacedRecord],
    a: int,
    px: float,
    py: float,
    vx: float,
    vy: float,
    dissipation: float,
) -> float:
    """Return the stiffness of a's contact, 1/s^2, in the way of Hunt and Crossley; never pulling.

    Args:
        px, py: overlap, away from the other, m.
        vx, vy: a's velocity relative to the other, m/s.
    """
    if dissipation == 0.0:
        return placed[a].stiffness
    # Overlap times closing speed, so that their product with the stiffness needs no direction.
    closing = -(px * vx + py * vy)
    depth = math.sqrt(px * px + py * py)
    if depth == 0.0:
        return 0.0
    rate = min(placed[a].stiffness * dissipation, _MOST_DAMPING / depth)
    return max(0.0, placed[a].stiffness + rate * closing / depth)


@kernel
def _push_pair(
    placed: Rows[PlacedRecord], a: int, b: int, reach: float, dissipation: float
) -> None:
    px, py = _push(placed[a].x - placed[b].x, placed[a].y - placed[b].y, reach)
    vx, vy = placed[a].vx - placed[b].vx, placed[a].vy - placed[b].vy
    rate = _damped(placed, a, px, py, vx, vy, dissipation)
    placed[a].push_x += rate * px
    placed[a].push_y += rate * py
    rate = _damped(placed, b, -px, -py, -vx, -vy, dissipation)
    placed[b].push_x -= rate * px
    placed[b].push_y -= rate * py


@inline_kernel
def _push_by_walls(
    placed: Rows[PlacedRecord],
    a: int,
    walls: Array,
    near: Indices,
    begin: int,
    end: int,
    dissipation: float,
) -> float:
    """Push a person; return the distance of its centre from the nearest wall that it overlaps."""
    x, y, radius = placed[a].x, placed[a].y, placed[a].radius
    clear, nearest2 = radius + _CLEAR, math.inf
    for k in range(begin, end):
        s = near[k]
        ax, ay, bx, by = walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3]
        if y < min(ay, by) - clear or y > max(ay, by) + clear:
            continue
        if x < min(ax, bx) - clear or x > max(ax, bx) + clear:
            continue
        nx, ny = nearest_on_segment(x, y, ax, ay, bx, by)
        px, py = _push(x - nx, y - ny, radius)
        rate = _damped(placed, a, px, py, placed[a].vx, placed[a].vy, dissipation)
        placed[a].push_x += rate * px
        placed[a].push_y += rate * py
        nearest2 = min(nearest2, (x - nx) * (x - nx) + (y - ny) * (y - ny))
    return math.sqrt(nearest2)
