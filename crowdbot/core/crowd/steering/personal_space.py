"""Personal space: a push away from others' future positions, stronger ahead than behind."""

from __future__ import annotations

import math

from crowdbot.core.crowd.steering.sorted_discs import REACH, first_within
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Largest push by one other, m/s^2.
HARDEST = 8.0
#: A person who would be inside another counts as at this share of the present distance.
_THROUGH = 0.05


@kernel
def push_all(
    discs: Rows[DiscRecord], row: Indices, heading: Array, decides: Mask,
    strength: float, reach: float, anticipation: float, behind: float, wanted: Array,
) -> None:  # fmt: skip
    """Add the pushes of all others on people who decide to accelerations (N, 2), in place.

    Args:
        discs to decides: as of `sorted_discs.sort_people`.
        strength to behind: see `PersonalSpaceSpec`.
        wanted: m/s^2.
    """
    for i in range(wanted.shape[0]):
        if not decides[i]:
            continue
        a = int(row[i])
        for b in range(first_within(discs, a, REACH), discs.shape[0]):
            if discs[b].x - discs[a].x > REACH:
                break
            if b == a or abs(discs[b].y - discs[a].y) > REACH:
                continue
            px, py = push_by(
                discs, a, b, heading[i, 0], heading[i, 1], strength, reach, anticipation, behind
            )
            wanted[i, 0] += px
            wanted[i, 1] += py


@kernel
def push_by(
    discs: Rows[DiscRecord],
    a: int,
    b: int,
    hx: float,
    hy: float,
    strength: float,
    reach: float,
    anticipation: float,
    behind: float,
) -> tuple[float, float]:
    """Return the push of row b on row a, m/s^2; 0 where it would be below 1 % of ``strength``."""
    dx, dy = discs[b].x - discs[a].x, discs[b].y - discs[a].y
    qx = dx + (discs[b].vx - discs[a].vx) * anticipation
    qy = dy + (discs[b].vy - discs[a].vy) * anticipation
    distance = math.sqrt(qx * qx + qy * qy)
    if qx * dx + qy * dy < 0.0:  # they would walk through each other
        qx, qy = dx, dy
        now = math.sqrt(dx * dx + dy * dy)
        distance, size = _THROUGH * now, now
    else:
        size = distance
    gap = distance - discs[a].radius - discs[b].radius
    if size == 0.0 or gap > 4.6 * reach:
        return 0.0, 0.0
    nx, ny = qx / size, qy / size
    ahead = 0.5 * (1.0 + nx * hx + ny * hy)
    push = strength * math.exp(-gap / reach) * (behind + (1.0 - behind) * ahead)
    push = min(push, HARDEST)
    return -push * nx, -push * ny


__all__ = ["HARDEST", "push_all", "push_by"]
