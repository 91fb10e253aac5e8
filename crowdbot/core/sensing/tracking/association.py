"""Give legs to tracks: the nearest first, people before tracks that are new; compiled."""

from __future__ import annotations

import math

from crowdbot.core.sensing.tracking import clusters as c
from crowdbot.core.sensing.tracking import tracks as k
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: A leg is at most this far from where its person is expected, plus this many deviations, m.
_GATE, _SPREAD, _WIDEST_GATE = 0.27, 1.5, 0.6
#: Largest distance of the middle of both legs from there, and of the legs from each other, m.
_MIDDLE, APART = 0.2, 0.5
#: A cluster is as wide as both legs side by side from here, m.
_BOTH = c.LEG
NONE = -1


@kernel
def assign(
    tracks: Array, count: int, legs: Array, found: int,
    first: Indices, second: Indices, owner: Indices,
) -> None:  # fmt: skip
    """Write the indices of the one or two legs of each track, `NONE` where it has none.

    Args:
        tracks: (M, ..) as `tracks`; the first ``count`` are in use.
        legs: (K, ..) as `clusters`, in the frame of the tracks; the first ``found`` are in use.
        first, second: (M,) results.
        owner: (K,) result, the track of each leg.
    """
    for i in range(count):
        first[i] = second[i] = NONE
    for j in range(found):
        owner[j] = NONE
    for person in (1.0, 0.0):
        _nearest_legs(tracks, count, legs, found, person, first, owner)
        _other_legs(tracks, count, legs, found, person, first, second, owner)


@kernel
def gate_of(track: Array) -> float:
    """Return the distance within which a leg belongs to a track, m."""
    return min(_WIDEST_GATE, _GATE + _SPREAD * math.sqrt(max(track[k.PP], 0.0)))


@kernel
def _nearest_legs(
    tracks: Array, count: int, legs: Array, found: int,
    person: float, first: Indices, owner: Indices,
) -> None:  # fmt: skip
    """Give each track its nearest leg, in the order of distances."""
    while True:
        best, at, leg = math.inf, NONE, NONE
        for i in range(count):
            if first[i] != NONE or tracks[i, k.PERSON] != person:
                continue
            gate = gate_of(tracks[i])
            for j in range(found):
                if owner[j] != NONE or (legs[j, c.STILL] != 0.0 and person == 0.0):
                    continue
                dx, dy = legs[j, c.X] - tracks[i, k.X], legs[j, c.Y] - tracks[i, k.Y]
                away = math.sqrt(dx * dx + dy * dy)
                if away < gate and away < best:
                    best, at, leg = away, i, j
        if at == NONE:
            return
        first[at], owner[leg] = leg, at


@kernel
def _other_legs(
    tracks: Array, count: int, legs: Array, found: int,
    person: float, first: Indices, second: Indices, owner: Indices,
) -> None:  # fmt: skip
    """Give tracks a second leg if the middle of both lies where the person is expected."""
    while True:
        best, at, leg = math.inf, NONE, NONE
        for i in range(count):
            j = first[i]
            if j == NONE or second[i] != NONE or tracks[i, k.PERSON] != person:
                continue
            if legs[j, c.WIDTH] > _BOTH:
                continue
            for m in range(found):
                if owner[m] != NONE or legs[m, c.WIDTH] > _BOTH:
                    continue
                apart = math.hypot(legs[m, c.X] - legs[j, c.X], legs[m, c.Y] - legs[j, c.Y])
                if apart > APART:
                    continue
                off = _middle_off(tracks[i], legs[j], legs[m])
                most = _MIDDLE + math.sqrt(max(tracks[i, k.PP], 0.0))
                if off < most and off < best:
                    best, at, leg = off, i, m
        if at == NONE:
            return
        second[at], owner[leg] = leg, at


@kernel
def _middle_off(track: Array, leg: Array, other: Array) -> float:
    x, y = 0.5 * (leg[c.X] + other[c.X]), 0.5 * (leg[c.Y] + other[c.Y])
    return math.hypot(x - track[k.X], y - track[k.Y])
