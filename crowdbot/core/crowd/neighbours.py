"""Neighbour search: bodies sorted along x, swept from each one outwards."""

from __future__ import annotations

from numba import njit

from crowdbot.core.crowd.cost import D2, NVX, NVY, REACH, RX, RY, Array

# Columns of a sorted body table.
BX, BY, BVX, BVY, BRADIUS, BINDEX = range(6)


@njit(cache=True, error_model="numpy")
def gather(bodies: Array, me: int, distance: float, near: Array) -> int:
    """Write the bodies closer than ``distance`` (centres, strict) to ``near``; return how many.

    Args:
        bodies: (B, 6) x, y, vx, vy, radius, index; sorted by x.
        me: row of the body whose neighbours are sought.
        distance: m.
        near: (>= B, 6) output, columns as in `crowdbot.core.crowd.cost`.
    """
    px, py, radius = bodies[me, BX], bodies[me, BY], bodies[me, BRADIUS]
    first = me
    while first > 0 and px - bodies[first - 1, BX] < distance:
        first -= 1
    count = 0
    for k in range(first, bodies.shape[0]):
        rx = bodies[k, BX] - px
        if rx >= distance:
            break
        ry = bodies[k, BY] - py
        d2 = rx * rx + ry * ry
        if k == me or d2 >= distance * distance:
            continue
        near[count, D2], near[count, RX], near[count, RY] = d2, rx, ry
        near[count, NVX], near[count, NVY] = bodies[k, BVX], bodies[k, BVY]
        near[count, REACH] = radius + bodies[k, BRADIUS]
        count += 1
    return count
