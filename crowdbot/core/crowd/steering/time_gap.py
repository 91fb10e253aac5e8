"""Time gap: people walk no faster than the space ahead allows.

Without it no model here slows down in a dense crowd. Oncoming people are stepped around rather than
followed, so the gap to them is nearly zero.
"""

from __future__ import annotations

import math

from crowdbot.core.crowd.steering.sorted_discs import list_ahead
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: A person faster than this against one's heading is oncoming, m/s.
_ONCOMING = 0.2


@kernel
def limit_all(
    discs: Rows[DiscRecord], row: Indices, heading: Array, decides: Mask, velocity: Array,
    time: float, oncoming_time: float, room: float, half_width: float, relaxation: float,
    listed: Indices, desired: Array,
) -> None:  # fmt: skip
    """Reduce accelerations so that speeds after the relaxation time leave the time gap, in place.

    Args:
        discs to decides: as in `sorted_discs.sort_people`; velocity: (N, 2), m/s.
        time to half_width: see `TimeGapSpec`.
        relaxation: time in which people reach the velocity that they have chosen, s.
        listed: (>= D,) scratch.
        desired: (N, 2) accelerations, m/s^2.
    """
    for i in range(desired.shape[0]):
        if not decides[i]:
            continue
        ux = velocity[i, 0] + relaxation * desired[i, 0]
        uy = velocity[i, 1] + relaxation * desired[i, 1]
        ahead = ux * heading[i, 0] + uy * heading[i, 1]
        if ahead <= 0.0:
            continue  # about to stop or step back
        fastest = allowed_speed(
            discs, int(row[i]), heading[i, 0], heading[i, 1], time, oncoming_time, room, half_width,
            listed,
        )  # fmt: skip
        if ahead > fastest:
            desired[i, 0] -= (ahead - fastest) / relaxation * heading[i, 0]
            desired[i, 1] -= (ahead - fastest) / relaxation * heading[i, 1]


@kernel
def allowed_speed(
    discs: Rows[DiscRecord],
    a: int,
    hx: float,
    hy: float,
    time: float,
    oncoming_time: float,
    room: float,
    half_width: float,
    listed: Indices,
) -> float:
    """Return the largest speed that the discs ahead of row a allow, m/s; inf if free.

    Args:
        discs: (D,) sorted by x.
        hx, hy: unit vector of the facing direction.
        time to half_width: see `TimeGap`.
    """
    fastest = math.inf
    for place in range(list_ahead(discs, a, hx, hy, half_width, listed)):
        b = listed[place]
        along = (discs[b].x - discs[a].x) * hx + (discs[b].y - discs[a].y) * hy
        comes = discs[b].vx * hx + discs[b].vy * hy < -_ONCOMING
        fastest = min(fastest, max(0.0, (along - room) / (oncoming_time if comes else time)))
    return fastest
