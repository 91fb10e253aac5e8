"""All discs that people see, in one table: people, robots, pillars, images."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array


def most_discs(people: int, others: int, periodic: bool) -> int:
    """Return the largest number of rows that `write_discs` may write."""
    return people * (9 if periodic else 1) + others


@kernel
def write_discs(
    position: Array,
    velocity: Array,
    goal: Array,
    radius: Array,
    preferred: Array,
    present: NDArray[np.bool_],
    robots: Array,
    pillars: Array,
    box: Array,
    diagonal: bool,
    reach: float,
    discs: Rows[DiscRecord],
) -> int:
    """Write all discs; return their number.

    Preferred velocities are zero at the goal; robots are assumed to prefer their current one.

    Args:
        position, velocity, goal: (N, 2); radius, preferred (speed), present: (N,).
        robots: (K, 5) x, y, vx, vy, radius.
        pillars: (P, 3) x, y, radius.
        box: x0, x1, y0, y1 of the periodic boundary, m; none if x0 = x1.
        diagonal: see `crowdbot.core.crowd.policy.CrowdView`.
        reach: only images closer than this to the floor, m.
        discs: (>= `most_discs`,) output.
    """
    count = 0
    for i in range(position.shape[0]):
        if not present[i]:
            continue
        row = discs[count]
        row.x, row.y = position[i, 0], position[i, 1]
        row.vx, row.vy = velocity[i, 0], velocity[i, 1]
        row.radius, row.pillar, row.index = radius[i], 0.0, i
        gx, gy = goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1]
        away = math.hypot(gx, gy)
        factor = preferred[i] / away if away > radius[i] else 0.0
        row.wanted_x, row.wanted_y = factor * gx, factor * gy
        count += 1
    people = count
    for r in range(robots.shape[0]):
        disc = discs[count]
        disc.x, disc.y, disc.radius = robots[r, 0], robots[r, 1], robots[r, 4]
        disc.vx, disc.vy = robots[r, 2], robots[r, 3]
        disc.wanted_x, disc.wanted_y = robots[r, 2], robots[r, 3]
        disc.pillar, disc.index = 0.0, -1.0
        count += 1
    for p in range(pillars.shape[0]):
        disc = discs[count]
        disc.x, disc.y, disc.radius = pillars[p, 0], pillars[p, 1], pillars[p, 2]
        disc.vx = disc.vy = disc.wanted_x = disc.wanted_y = 0.0
        disc.pillar, disc.index = 1.0, -1.0
        count += 1
    if box[0] < box[1]:
        count = _write_images(discs, people, count, box, diagonal, reach)
    return count


@kernel
def _write_images(
    discs: Rows[DiscRecord], people: int, count: int, box: Array, diagonal: bool, reach: float
) -> int:
    """Append the images of people across a periodic boundary."""
    width, height = box[1] - box[0], box[3] - box[2]
    for sx in (-1.0, 0.0, 1.0):
        for sy in (-1.0, 0.0, 1.0):
            if (sx == 0.0 and sy == 0.0) or (sx != 0.0 and sy != 0.0 and not diagonal):
                continue
            dx = sx * width if sx != 0.0 else 0.0  # a side may be infinite
            dy = sy * height if sy != 0.0 else 0.0
            if not math.isfinite(dx + dy):
                continue
            for i in range(people):
                x, y = discs[i].x + dx, discs[i].y + dy
                ox = max(0.0, box[0] - x, x - box[1])
                oy = max(0.0, box[2] - y, y - box[3])
                if ox * ox + oy * oy >= reach * reach:
                    continue
                discs[count] = discs[i]
                image = discs[count]
                image.x, image.y, image.index = x, y, -1.0
                count += 1
    return count
