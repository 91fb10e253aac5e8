"""Assign detected legs to tracks: nearest first, people before new tracks; compiled."""

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
#: A number that is less by a leg's is that leg before it is given; `NONE` remains `NONE`.
_CANDIDATE = -2


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
        _nearest_legs(tracks, count, legs, found, person, first, second, owner)
        _other_legs(tracks, count, legs, found, person, first, second, owner)


@kernel
def gate_of(track: Array) -> float:
    """Return the distance within which a leg belongs to a track, m."""
    return min(_WIDEST_GATE, _GATE + _SPREAD * math.sqrt(max(track[k.PP], 0.0)))


@kernel
def _nearest_legs(
    tracks: Array, count: int, legs: Array, found: int,
    person: float, first: Indices, second: Indices, owner: Indices,
) -> None:  # fmt: skip
    """Give each track its nearest leg, in the order of distances.

    Meanwhile ``second`` holds the nearest free leg of tracks that have none.
    """
    for i in range(count):
        if first[i] == NONE and tracks[i, k.PERSON] == person:
            second[i] = _nearest_leg(tracks[i], legs, found, person, owner)
    while True:
        best, at = math.inf, NONE
        for i in range(count):
            if first[i] == NONE and tracks[i, k.PERSON] == person and second[i] != NONE:
                away = _away(tracks[i], legs[second[i]])
                if away < best:
                    best, at = away, i
        if at == NONE:
            return
        leg = second[at]
        first[at], second[at], owner[leg] = leg, NONE, at
        for i in range(count):
            if first[i] == NONE and tracks[i, k.PERSON] == person and second[i] == leg:
                second[i] = _nearest_leg(tracks[i], legs, found, person, owner)


@kernel
def _nearest_leg(track: Array, legs: Array, found: int, person: float, owner: Indices) -> int:
    """Return the nearest free leg within the gate of a track, or `NONE`."""
    best, leg = gate_of(track), NONE
    for j in range(found):
        if owner[j] != NONE or (legs[j, c.STILL] != 0.0 and person == 0.0):
            continue
        away = _away(track, legs[j])
        if away < best:
            best, leg = away, j
    return leg


@kernel
def _away(track: Array, leg: Array) -> float:
    dx, dy = leg[c.X] - track[k.X], leg[c.Y] - track[k.Y]
    return math.sqrt(dx * dx + dy * dy)


@kernel
def _other_legs(
    tracks: Array, count: int, legs: Array, found: int,
    person: float, first: Indices, second: Indices, owner: Indices,
) -> None:  # fmt: skip
    """Assign second legs, best pair first, where the middle of both legs fits the prediction.

    While this runs, ``second`` also holds candidates: ``_CANDIDATE - leg`` for a track without a
    second leg.
    """
    for i in range(count):
        if second[i] == NONE and tracks[i, k.PERSON] == person:
            second[i] = _CANDIDATE - _other_leg(tracks[i], legs, found, first[i], owner)
    while True:
        best, at = math.inf, NONE
        for i in range(count):
            if second[i] <= _CANDIDATE and tracks[i, k.PERSON] == person:
                off = _middle_off(tracks[i], legs[first[i]], legs[_CANDIDATE - second[i]])
                if off < best:
                    best, at = off, i
        if at == NONE:
            return
        taken = second[at]
        second[at] = _CANDIDATE - taken
        owner[second[at]] = at
        for i in range(count):
            if second[i] == taken and tracks[i, k.PERSON] == person:
                second[i] = _CANDIDATE - _other_leg(tracks[i], legs, found, first[i], owner)


@kernel
def _other_leg(track: Array, legs: Array, found: int, first: int, owner: Indices) -> int:
    """Return the best free leg beside the first of a track, or `NONE`."""
    if first == NONE or legs[first, c.WIDTH] > _BOTH:
        return NONE
    best, leg = _MIDDLE + math.sqrt(max(track[k.PP], 0.0)), NONE
    for m in range(found):
        if owner[m] != NONE or legs[m, c.WIDTH] > _BOTH:
            continue
        apart = math.hypot(legs[m, c.X] - legs[first, c.X], legs[m, c.Y] - legs[first, c.Y])
        if apart > APART:
            continue
        off = _middle_off(track, legs[first], legs[m])
        if off < best:
            best, leg = off, m
    return leg


@kernel
def _middle_off(track: Array, leg: Array, other: Array) -> float:
    x, y = 0.5 * (leg[c.X] + other[c.X]), 0.5 * (leg[c.Y] + other[c.Y])
    return math.hypot(x - track[k.X], y - track[k.Y])
