"""Pushes between people who overlap, walls and fixed discs."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import PUSH_X, PUSH_Y, WAITING, X, Y
from crowdbot.core.support.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array

# Columns of `push_apart`'s scratch: those present in a row along x, close together in memory.
_X, _Y, _RADIUS, _STIFFNESS, _PX, _PY, _ROW = range(7)
PLACED_COLUMNS = 7
#: Who is farther than this from a wall's box, beside the radius, is not near it by rounding, m.
_CLEAR = 1e-6


@kernel
def push_apart(
    agents: Array,
    radius: Array,
    order: NDArray[np.int64],
    walls: Array,
    discs: Array,
    stiffness: Array,
    placed: Array,
) -> None:
    """Push of overlapping people, walls and fixed discs, m/s^2, into the PUSH columns.

    Args:
        order: (N,) all agents in any order; sorted by x afterwards.
        walls: (S, 4) segments.
        discs: (D, 3) x, y, radius: pillars, and people as they appear across a border.
        stiffness: (N,) of what each agent feels, 1/s^2.
        placed: (N, `PLACED_COLUMNS`) scratch.
    """
    largest = 0.0
    for i in range(agents.shape[0]):
        largest = max(largest, radius[i])
    _sort_along_x(agents, order)
    count = _place(agents, radius, order, stiffness, placed)
    for a in range(count):
        _push_by_walls(placed, a, walls)
        for d in range(discs.shape[0]):
            reach = placed[a, _RADIUS] + discs[d, 2]
            px, py = _push(placed[a, _X] - discs[d, 0], placed[a, _Y] - discs[d, 1], reach)
            placed[a, _PX] += placed[a, _STIFFNESS] * px
            placed[a, _PY] += placed[a, _STIFFNESS] * py
        x, y, own = placed[a, _X], placed[a, _Y], placed[a, _RADIUS]
        for b in range(a + 1, count):
            if placed[b, _X] - x >= own + largest:
                break
            reach = own + placed[b, _RADIUS]
            if abs(placed[b, _Y] - y) < reach:
                _push_pair(placed, a, b, reach)
    for a in range(count):
        i = int(placed[a, _ROW])
        agents[i, PUSH_X], agents[i, PUSH_Y] = placed[a, _PX], placed[a, _PY]


@kernel
def _sort_along_x(agents: Array, order: NDArray[np.int64]) -> None:
    """By x, then by row, so that the result does not depend on the order before.

    From one tick to the next hardly anybody changes places: few steps.
    """
    for a in range(1, order.shape[0]):
        i = order[a]
        x, b = agents[i, X], a
        while b > 0:
            j = order[b - 1]
            if agents[j, X] < x or (agents[j, X] == x and j < i):
                break
            order[b] = j
            b -= 1
        order[b] = i


@kernel
def _place(
    agents: Array, radius: Array, order: NDArray[np.int64], stiffness: Array, placed: Array
) -> int:
    """Write those present to ``placed``, in order; nobody is pushed yet. Returns how many."""
    count = 0
    for i in order:
        if agents[i, WAITING] != 0.0:
            agents[i, PUSH_X] = agents[i, PUSH_Y] = 0.0
            continue
        placed[count, _X], placed[count, _Y] = agents[i, X], agents[i, Y]
        placed[count, _RADIUS], placed[count, _STIFFNESS] = radius[i], stiffness[i]
        placed[count, _PX], placed[count, _PY], placed[count, _ROW] = 0.0, 0.0, i
        count += 1
    return count


@kernel
def _push(dx: float, dy: float, reach: float) -> tuple[float, float]:
    """How far discs overlap (m), away from the other; zero for centres on each other."""
    d2 = dx * dx + dy * dy
    if d2 >= reach * reach or d2 == 0.0:
        return 0.0, 0.0
    distance = math.sqrt(d2)
    push = (reach - distance) / distance
    return push * dx, push * dy


@kernel
def _push_pair(placed: Array, a: int, b: int, reach: float) -> None:
    px, py = _push(placed[a, _X] - placed[b, _X], placed[a, _Y] - placed[b, _Y], reach)
    placed[a, _PX] += placed[a, _STIFFNESS] * px
    placed[a, _PY] += placed[a, _STIFFNESS] * py
    placed[b, _PX] -= placed[b, _STIFFNESS] * px
    placed[b, _PY] -= placed[b, _STIFFNESS] * py


@inline_kernel
def _push_by_walls(placed: Array, a: int, walls: Array) -> None:
    x, y, radius = placed[a, _X], placed[a, _Y], placed[a, _RADIUS]
    clear = radius + _CLEAR
    for s in range(walls.shape[0]):
        ax, ay, bx, by = walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3]
        if y < min(ay, by) - clear or y > max(ay, by) + clear:
            continue
        if x < min(ax, bx) - clear or x > max(ax, bx) + clear:
            continue
        nx, ny = nearest_on_segment(x, y, ax, ay, bx, by)
        px, py = _push(x - nx, y - ny, radius)
        placed[a, _PX] += placed[a, _STIFFNESS] * px
        placed[a, _PY] += placed[a, _STIFFNESS] * py


__all__ = ["PLACED_COLUMNS", "push_apart"]
