"""Personal space: a push away from others' future positions, stronger ahead than behind."""

from __future__ import annotations

import math

from crowdbot.core.crowd.steering.sorted_discs import REACH
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Largest push by one other, m/s^2.
HARDEST = 8.0
#: A person who would be inside another counts as at this share of the present distance.
_THROUGH = 0.05
#: Factor by which a distance is clearly larger, whatever the rounding.
_CLEARLY = 1.0 + 1e-9


@kernel
def push_all(
    discs: Rows[DiscRecord], heading: Array, decides: Mask,
    strength: float, reach: float, anticipation: float, behind: float, listed: Indices,
    desired: Array,
) -> None:  # fmt: skip
    """Add the pushes of all others on people who decide to accelerations (N, 2), in place.

    Both of a pair are pushed at once, since the costly part is the same for them. So each one's
    pushes are added in the order of the discs.

    Args:
        discs, heading, decides: as in `sorted_discs.sort_people`.
        strength to behind: see `PersonalSpaceSpec`.
        listed: (>= D,) scratch.
        desired: m/s^2.
    """
    farthest = 4.6 * reach  # where the push is 1 % of the strength
    for a in range(discs.shape[0]):
        i = _who_decides(discs, a, decides)
        for place in range(_list_near(discs, a, anticipation, farthest, listed)):
            b = listed[place]
            j = _who_decides(discs, b, decides)
            if i < 0 and j < 0:
                continue
            dx, dy = discs[b].x - discs[a].x, discs[b].y - discs[a].y
            nx, ny, distance = _towards(discs, a, b, dx, dy, anticipation)
            gap = distance - discs[a].radius - discs[b].radius
            other_gap = distance - discs[b].radius - discs[a].radius  # may be rounded otherwise
            if not gap <= farthest and not other_gap <= farthest:
                continue
            push = strength * math.exp(-gap / reach)
            if i >= 0 and dx <= REACH and gap <= farthest:
                size = _felt(push, nx, ny, heading[i], behind)
                desired[i, 0] += -size * nx
                desired[i, 1] += -size * ny
            if j >= 0 and discs[a].x >= discs[b].x - REACH and other_gap <= farthest:
                if other_gap != gap:
                    push = strength * math.exp(-other_gap / reach)
                size = _felt(push, -nx, -ny, heading[j], behind)
                desired[j, 0] += size * nx
                desired[j, 1] += size * ny


@inline_kernel
def _list_near(
    discs: Rows[DiscRecord], a: int, anticipation: float, farthest: float, listed: Indices
) -> int:
    """Write the rows after a, except those that clearly do not push it, and return their number.

    Without roots and divisions, and without branches, which would often be mispredicted.
    """
    x, y, vx, vy = discs[a].x, discs[a].y, discs[a].vx, discs[a].vy
    count = 0
    for b in range(a + 1, discs.shape[0]):
        dx, dy = discs[b].x - x, discs[b].y - y
        if not (dx <= REACH or x >= discs[b].x - REACH):
            break
        qx, qy = dx + (discs[b].vx - vx) * anticipation, dy + (discs[b].vy - vy) * anticipation
        limit = (farthest + discs[a].radius + discs[b].radius) * _CLEARLY
        far = (qx * dx + qy * dy >= 0.0) & (qx * qx + qy * qy > limit * limit)
        listed[count] = b
        count += int((abs(dy) <= REACH) & (not far))
    return count


@inline_kernel
def _who_decides(discs: Rows[DiscRecord], a: int, decides: Mask) -> int:
    """Return the index of the person in row a if that person decides, else -1."""
    i = int(discs[a].index)
    return i if i >= 0 and decides[i] else -1


@inline_kernel
def _towards(
    discs: Rows[DiscRecord], a: int, b: int, dx: float, dy: float, anticipation: float
) -> tuple[float, float, float]:
    """Return the unit vector from row a to row b where they will be, and the distance there, m.

    The distance is infinite where there is no direction.
    """
    qx = dx + (discs[b].vx - discs[a].vx) * anticipation
    qy = dy + (discs[b].vy - discs[a].vy) * anticipation
    distance = math.sqrt(qx * qx + qy * qy)
    size = distance
    if qx * dx + qy * dy < 0.0:  # they would walk through each other
        qx, qy = dx, dy
        size = math.sqrt(dx * dx + dy * dy)
        distance = _THROUGH * size
    if size == 0.0:
        return 0.0, 0.0, math.inf
    return qx / size, qy / size, distance


@inline_kernel
def _felt(push: float, nx: float, ny: float, heading: Array, behind: float) -> float:
    """Return the size of a push by the other in direction n, less from behind, m/s^2."""
    ahead = 0.5 * (1.0 + nx * heading[0] + ny * heading[1])
    return float(min(push * (behind + (1.0 - behind) * ahead), HARDEST))
