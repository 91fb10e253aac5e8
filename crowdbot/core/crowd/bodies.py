"""Everything that people see as a disc, in one table: people, robots, pillars, images."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.cost import Array
from crowdbot.core.crowd.neighbours import (
    BODY_COLUMNS,
    BODY_RADIUS,
    INDEX,
    PILLAR,
    VX,
    VY,
    WANTED_X,
    WANTED_Y,
    X,
    Y,
)


def most_bodies(people: int, others: int, torus: bool) -> int:
    """How many rows `write_bodies` may write."""
    return people * (9 if torus else 1) + others


@njit(cache=True, error_model="numpy")
def write_bodies(
    position: Array,
    velocity: Array,
    goal: Array,
    radius: Array,
    preferred: Array,
    present: NDArray[np.bool_],
    robots: Array,
    pillars: Array,
    torus: Array,
    diagonal: bool,
    reach: float,
    bodies: Array,
) -> int:
    """Write all bodies; return how many they are.

    Preferred velocities are zero at the goal; robots are taken to prefer the one they have.

    Args:
        position, velocity, goal: (N, 2); radius, preferred (speed), present: (N,).
        robots: (K, 5) x, y, vx, vy, radius.
        pillars: (P, 3) x, y, radius.
        torus: x0, x1, y0, y1; no torus if x0 = x1. See `crowdbot.core.crowd.policy.CrowdView`.
        reach: only images closer than this to the floor, m.
        bodies: (>= `most_bodies`, `BODY_COLUMNS`) output.
    """
    count = 0
    for i in range(position.shape[0]):
        if not present[i]:
            continue
        row = bodies[count]
        row[X], row[Y] = position[i, 0], position[i, 1]
        row[VX], row[VY] = velocity[i, 0], velocity[i, 1]
        row[BODY_RADIUS], row[PILLAR], row[INDEX] = radius[i], 0.0, i
        gx, gy = goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1]
        away = math.hypot(gx, gy)
        factor = preferred[i] / away if away > radius[i] else 0.0
        row[WANTED_X], row[WANTED_Y] = factor * gx, factor * gy
        count += 1
    people = count
    for r in range(robots.shape[0]):
        bodies[count, X : BODY_RADIUS + 1] = robots[r]
        bodies[count, WANTED_X], bodies[count, WANTED_Y] = robots[r, 2], robots[r, 3]
        bodies[count, PILLAR], bodies[count, INDEX] = 0.0, -1.0
        count += 1
    for p in range(pillars.shape[0]):
        bodies[count, :] = 0.0
        bodies[count, X], bodies[count, Y] = pillars[p, 0], pillars[p, 1]
        bodies[count, BODY_RADIUS] = pillars[p, 2]
        bodies[count, PILLAR], bodies[count, INDEX] = 1.0, -1.0
        count += 1
    if torus[0] < torus[1]:
        count = _write_images(bodies, people, count, torus, diagonal, reach)
    return count


@njit(cache=True, error_model="numpy")
def _write_images(
    bodies: Array, people: int, count: int, torus: Array, diagonal: bool, reach: float
) -> int:
    """Append people as they appear across the borders of a torus."""
    width, height = torus[1] - torus[0], torus[3] - torus[2]
    for sx in (-1.0, 0.0, 1.0):
        for sy in (-1.0, 0.0, 1.0):
            if (sx == 0.0 and sy == 0.0) or (sx != 0.0 and sy != 0.0 and not diagonal):
                continue
            dx = sx * width if sx != 0.0 else 0.0  # a side may be infinite
            dy = sy * height if sy != 0.0 else 0.0
            if not math.isfinite(dx + dy):
                continue
            for i in range(people):
                x, y = bodies[i, X] + dx, bodies[i, Y] + dy
                ox = max(0.0, torus[0] - x, x - torus[1])
                oy = max(0.0, torus[2] - y, y - torus[3])
                if ox * ox + oy * oy >= reach * reach:
                    continue
                bodies[count, :] = bodies[i]
                bodies[count, X], bodies[count, Y], bodies[count, INDEX] = x, y, -1.0
                count += 1
    return count


__all__ = ["BODY_COLUMNS", "most_bodies", "write_bodies"]
