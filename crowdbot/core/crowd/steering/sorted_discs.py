"""Discs and headings of all people, sorted by x, for the steering parts."""

from __future__ import annotations

import math

from crowdbot.core.crowd.velocity_search.neighbour_discs import write_discs
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.support.stable_order import write_stable_order
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Centres farther apart do not affect any part, m.
REACH = 3.0
#: Slower people face their goal rather than their motion, m/s.
_SLOW = 0.3
#: Added to distances so that rounding leaves out no disc, m.
_SLACK = 1e-6


@kernel
def sort_people(
    position: Array, velocity: Array, goal: Array, traits: Array, present: Mask, members: Mask,
    robots: Array, pillars: Array, box: Array, diagonal: bool,
    unsorted: Rows[DiscRecord], discs: Rows[DiscRecord], orders: Indices,
    heading: Array, decides: Mask,
) -> int:  # fmt: skip
    """Write the discs of one decision, sorted by x; return their number.

    Args:
        position, velocity, goal: (N, 2), m and m/s.
        traits: (3, N) avoided radius (m), preferred speed (m/s), and largest acceleration.
        present, members: (N,) who is there, and who has this steering.
        robots to diagonal: as in `neighbour_discs.write_discs`.
        unsorted: scratch, of the size of ``discs``.
        discs: (>= D,) output: people, images across a border, robots and pillars, by x.
        orders: (3, >= D) scratch; the last row becomes the row of each person in ``discs``, -1
            for absent ones.
        heading: (N, 2) output: unit vectors between the directions to the goal and of walking.
        decides: (N,) output: True for members who are present.
    """
    count = write_discs(
        position, velocity, goal, traits[0], traits[1], present, robots, pillars, box, diagonal,
        REACH, unsorted,
    )  # fmt: skip
    order, row = orders[0], orders[2]
    write_stable_order(unsorted[:count]["x"], order, orders[1])
    for i in range(position.shape[0]):
        row[i], decides[i] = -1, present[i] and members[i]
        heading[i, 0] = heading[i, 1] = 0.0
    for n in range(count):
        discs[n] = unsorted[order[n]]
        if discs[n].index >= 0.0:
            row[int(discs[n].index)] = n
    face(position, velocity, goal, heading)
    return count


@kernel
def face(position: Array, velocity: Array, goal: Array, heading: Array) -> None:
    """Write headings: half towards the goal and half along the velocity."""
    for i in range(position.shape[0]):
        gx, gy = goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1]
        away, speed = math.hypot(gx, gy), math.hypot(velocity[i, 0], velocity[i, 1])
        gx, gy = (gx / away, gy / away) if away > 0.0 else (0.0, 0.0)
        x = gx + velocity[i, 0] / max(speed, _SLOW)
        y = gy + velocity[i, 1] / max(speed, _SLOW)
        size = math.hypot(x, y)
        if size < 1e-9:  # straight away from the goal: the goal decides
            x, y, size = gx, gy, math.hypot(gx, gy)
        if size > 0.0:
            heading[i, 0], heading[i, 1] = x / size, y / size


@inline_kernel
def list_ahead(
    discs: Rows[DiscRecord], a: int, hx: float, hy: float, half_width: float, listed: Indices
) -> int:
    """Write the rows of the discs in a strip ahead of row a, and return their number.

    Without branches, which would often be mispredicted.

    Args:
        discs: (D,) sorted by x.
        hx, hy: unit vector of the strip, which is `REACH` long.
        half_width: m.
        listed: (>= D,) output.
    """
    back, forth = _reach_ahead(hx, hy, half_width)
    x, y, count = discs[a].x, discs[a].y, 0
    for b in range(_first_within(discs, a, back), discs.shape[0]):
        dx, dy = discs[b].x - x, discs[b].y - y
        if dx > forth:
            break
        along, aside = dx * hx + dy * hy, abs(dx * hy - dy * hx)
        listed[count] = b
        count += int((b != a) & (along > 0.0) & (along <= REACH) & (aside < half_width))
    return count


@inline_kernel
def _reach_ahead(hx: float, hy: float, half_width: float) -> tuple[float, float]:
    """Return how far in -x and x a strip ahead reaches, m, at most `REACH`."""
    aside = half_width * abs(hy) + _SLACK
    return min(REACH, max(0.0, -REACH * hx) + aside), min(REACH, max(0.0, REACH * hx) + aside)


@inline_kernel
def _first_within(discs: Rows[DiscRecord], a: int, reach: float) -> int:
    """Return the first row whose x is within ``reach`` (m) of row a."""
    low = discs[a].x - reach
    while a > 0 and discs[a - 1].x >= low:
        a -= 1
    return a
