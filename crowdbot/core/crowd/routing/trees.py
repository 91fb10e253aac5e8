"""Shortest paths from every corner to one goal."""

from __future__ import annotations

import math

from crowdbot.core.crowd.routing.corners import Corners, X, Y, bends_past
from crowdbot.core.crowd.routing.sight import Sight, is_clear
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: In place of a next corner: the goal itself.
TO_GOAL = -1


@kernel
def plan_tree(
    gx: float, gy: float, corners: Corners, sight: Sight, wider: Sight,
    left: Array, after: Indices, heap: Indices, at: Indices,
) -> None:  # fmt: skip
    """Run Dijkstra's algorithm from the goal outwards.

    Args:
        sight, wider: edges at a body's margin, and nearer to the walls; the latter are used if no
            corner sees the goal past the former.
        left: (V,) length of the way to the goal, m, inf without one; written.
        after: (V,) the corner after each, `TO_GOAL` before the goal; written.
        heap, at: (V,) scratch.
    """
    size = _see_goal(gx, gy, corners, sight, left, after, heap, at)
    if size == 0:
        size = _see_goal(gx, gy, corners, wider, left, after, heap, at)
    while size:
        v = heap[0]
        size -= 1
        at[v] = -2  # settled
        if size:
            heap[0] = heap[size]
            at[heap[0]] = 0
            _sink(heap, at, left, size)
        for k in range(corners.first[v], corners.first[v + 1]):
            w, length = corners.linked[k], left[v] + corners.length[k]
            if at[w] == -2 or length >= left[w]:
                continue
            left[w], after[w] = length, v
            if at[w] < 0:
                heap[size], at[w] = w, size
                size += 1
            _rise(heap, at, left, at[w])


@kernel
def _see_goal(
    gx: float, gy: float, corners: Corners, sight: Sight, left: Array, after: Indices,
    heap: Indices, at: Indices,
) -> int:  # fmt: skip
    """Put every corner that sees the goal into the heap; return their number."""
    size = 0
    for v in range(corners.table.shape[0]):
        left[v], after[v], at[v] = math.inf, TO_GOAL, -1
        x, y = corners.table[v, X], corners.table[v, Y]
        if bends_past(corners.table, v, gx, gy) and is_clear(x, y, gx, gy, sight):
            left[v] = math.hypot(gx - x, gy - y)
            heap[size], at[v] = v, size
            size += 1
            _rise(heap, at, left, size - 1)
    return size


@kernel
def _before(left: Array, v: int, w: int) -> bool:
    return left[v] < left[w] or (left[v] == left[w] and v < w)


@kernel
def _rise(heap: Indices, at: Indices, left: Array, k: int) -> None:
    while k > 0:
        up = (k - 1) // 2
        if not _before(left, heap[k], heap[up]):
            return
        heap[k], heap[up] = heap[up], heap[k]
        at[heap[k]], at[heap[up]] = k, up
        k = up


@kernel
def _sink(heap: Indices, at: Indices, left: Array, size: int) -> None:
    k = 0
    while 2 * k + 1 < size:
        down = 2 * k + 1
        if down + 1 < size and _before(left, heap[down + 1], heap[down]):
            down += 1
        if not _before(left, heap[down], heap[k]):
            return
        heap[k], heap[down] = heap[down], heap[k]
        at[heap[k]], at[heap[down]] = k, down
        k = down
