"""Neighbour search: bodies sorted along x, swept from each one outwards."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.cost import D2, NVX, NVY, REACH, RX, RY, Array

# Columns of a sorted body table.
BX, BY, BVX, BVY, BRADIUS, BINDEX = range(6)
BODY_COLUMNS = 6


@njit(cache=True, error_model="numpy")
def sort_bodies(
    position: Array,
    velocity: Array,
    radius: Array,
    present: NDArray[np.bool_],
    robots: Array,
    bodies: Array,
) -> int:
    """Write everybody present and the robots to ``bodies``; return how many they are.

    Args:
        position, velocity: (N, 2).
        radius, present: (N,).
        robots: (K, 5) x, y, vx, vy, radius; their index is -1.
        bodies: (>= N + K, 6) output, sorted by x; people before robots where x is equal.
    """
    people = position.shape[0]
    x = np.empty(people + robots.shape[0])
    who = np.empty(people + robots.shape[0], np.int64)
    count = 0
    for i in range(people):
        if present[i]:
            x[count], who[count] = position[i, 0], i
            count += 1
    for r in range(robots.shape[0]):
        x[count], who[count] = robots[r, 0], people + r
        count += 1
    order = np.argsort(x[:count], kind="mergesort")  # stable
    for b in range(count):
        i = who[order[b]]
        if i < people:
            bodies[b, BX], bodies[b, BY] = position[i, 0], position[i, 1]
            bodies[b, BVX], bodies[b, BVY] = velocity[i, 0], velocity[i, 1]
            bodies[b, BRADIUS], bodies[b, BINDEX] = radius[i], i
        else:
            bodies[b, :BINDEX], bodies[b, BINDEX] = robots[i - people], -1.0
    return count


@njit(cache=True, error_model="numpy")
def gather(bodies: Array, total: int, me: int, distance: float, near: Array) -> int:
    """Write the bodies closer than ``distance`` (centres, strict) to ``near``; return how many.

    Args:
        bodies: (>= B, 6) x, y, vx, vy, radius, index; sorted by x.
        total: how many bodies there are, B.
        me: row of the body whose neighbours are sought.
        distance: m.
        near: (>= B, 6) output, columns as in `crowdbot.core.crowd.cost`.
    """
    px, py, radius = bodies[me, BX], bodies[me, BY], bodies[me, BRADIUS]
    first = me
    while first > 0 and px - bodies[first - 1, BX] < distance:
        first -= 1
    count = 0
    for k in range(first, total):
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
