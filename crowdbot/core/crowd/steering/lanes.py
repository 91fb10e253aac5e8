"""Lanes: in opposing flow, step behind people with the same direction."""

from __future__ import annotations

import math

from crowdbot.core.crowd.steering.sorted_discs import list_ahead
from crowdbot.core.crowd.velocity_search.neighbours import DiscRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: A person slower than this along one's heading, or against it, stands, m/s.
_STANDS = 0.2


@kernel
def keep_all(
    discs: Rows[DiscRecord], row: Indices, heading: Array, decides: Mask,
    strength: float, reach: float, half_width: float, follow: float, listed: Indices,
    desired: Array,
) -> None:  # fmt: skip
    """Add the accelerations of all people who decide and step aside, in place.

    Args:
        discs to decides: as in `sorted_discs.sort_people`.
        strength to follow: see `LanesSpec`.
        listed: (>= D,) scratch.
        desired: (N, 2) accelerations, m/s^2.
    """
    for i in range(desired.shape[0]):
        if not decides[i]:
            continue
        hx, hy = heading[i, 0], heading[i, 1]
        aside = aside_of(discs, int(row[i]), hx, hy, reach, half_width, follow, listed)
        desired[i, 0] -= strength * aside * hy
        desired[i, 1] += strength * aside * hx


@kernel
def aside_of(
    discs: Rows[DiscRecord],
    a: int,
    hx: float,
    hy: float,
    reach: float,
    half_width: float,
    follow: float,
    listed: Indices,
) -> float:
    """Return how strongly the person in row a tends to its left, -1 to 1."""
    away, towards, comers, all_ = 0.0, 0.0, 0.0, 0.0
    for place in range(list_ahead(discs, a, hx, hy, half_width, listed)):
        b = listed[place]
        dx, dy = discs[b].x - discs[a].x, discs[b].y - discs[a].y
        along, left = dx * hx + dy * hy, dy * hx - dx * hy
        weight = math.exp(-along / reach)
        pace = discs[b].vx * hx + discs[b].vy * hy
        share = left / half_width
        all_ += weight
        if pace < -_STANDS:
            comers += weight
            away -= weight * math.copysign(1.0 - abs(share), share)
        elif pace > _STANDS:
            towards += weight * 4.0 * share * (1.0 - abs(share))
    if comers == 0.0:
        return 0.0
    return math.tanh(away + follow * towards * comers / all_)
