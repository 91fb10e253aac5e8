"""One step of the tracker: predict, find legs, assign, correct, begin and end tracks; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.core.sensing.tracking import association, still_map
from crowdbot.core.sensing.tracking import clusters as c
from crowdbot.core.sensing.tracking import tracks as k
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: Sectors of the full turn in which the nearest point is known, to see who is hidden.
SECTORS = 720
#: A new track, a person in view and a hidden person are given up after this time unseen, s.
_NEW_LOST, _LOST, _HIDDEN_LOST = 0.2, 0.5, 2.0
#: A track is a person after this number of scans and time, if it moved this far, or was mostly
#: two legs; s, m. The share of scans with both legs is a mean over about ten scans.
_HITS, _AGE, _MOVED, _BOTH, _LEARN = 4, 0.2, 0.3, 0.5, 0.1
#: Tracks nearer than this with the same velocity are one person, m, m/s; and tracks that follow
#: one leg each, as far apart as legs. A leg stands and swings, so its velocity varies more.
_SAME, _SAME_SPEED, _LEG_SPEED = 0.2, 0.6, 1.2
#: A scan tells at most so much about what stands, s.
_LONGEST = 0.25
#: Neighbouring points nearer than this are of one surface, m.
_SURFACE = 0.35
#: No track begins nearer than this to a person of whom one leg is in view, m.
_TAKEN = 0.42
#: A track with both legs in a smaller share of scans follows one leg.
_ONE_LEG = 0.3
#: Points this near to a track that moves are little evidence of what stands, m; it moves from this
#: speed, m/s.
_BODY, _MOVES, _LITTLE = 0.4, 0.25, 0.4
#: A place is hidden by a point that is nearer by this, m.
_COVER = 0.25


class Memory(NamedTuple):
    """The tracker's memory, and its scratch arrays.

    Attributes:
        tracks: (M, ..) as `tracks`, in the frame of the poses.
        state: number of tracks in use; number of the next one.
        still: as `still_map.new_map`.
        legs: (K, ..) as `clusters`.
        nearest: (`SECTORS`,) distance of the nearest point in each direction, m.
        first, second: (M,) legs of each track.
        owner: (K,) track of each leg.
    """

    tracks: Array
    state: Indices
    still: Array
    legs: Array
    nearest: Array
    first: Indices
    second: Indices
    owner: Indices


@kernel
def step(
    points: Array,
    pose: tuple[float, float, float],
    t: float,
    dt: float,
    reach: float,
    memory: Memory,
) -> None:
    """Update the tracks with a scan at its time.

    Args:
        points: (P, 2) base frame, m, in the order of beams.
        pose: the robot's pose in a frame at rest, m, rad.
        t, dt: time, and time since the last scan, s.
        reach: people farther than this are not looked for, m.
        memory: updated.
    """
    tracks, state, legs = memory.tracks, memory.state, memory.legs
    for i in range(state[0]):
        k.predict(tracks[i], dt)
    found = c.find_clusters(points, reach, legs)
    _see_nearest(points, memory.nearest)
    _into_frame(legs, found, pose)
    _mark_what_stands(points, pose, t, memory, found)
    _learn_what_stands(points, pose, t, min(dt, _LONGEST), memory)
    first, second, owner = memory.first, memory.second, memory.owner
    association.assign(tracks, state[0], legs, found, first, second, owner)
    for i in range(state[0]):
        _correct(tracks[i], legs, first[i], second[i], t)
    _begin(memory, found, t)
    _end(tracks, state, pose, memory.nearest, t)


@kernel
def _into_frame(legs: Array, found: int, pose: tuple[float, float, float]) -> None:
    co, si = math.cos(pose[2]), math.sin(pose[2])
    for j in range(found):
        x, y = legs[j, c.X], legs[j, c.Y]
        legs[j, c.X], legs[j, c.Y] = pose[0] + co * x - si * y, pose[1] + si * x + co * y


@kernel
def _see_nearest(points: Array, nearest: Array) -> None:
    for s in range(SECTORS):
        nearest[s] = math.inf
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        s = _sector(math.atan2(y, x))
        nearest[s] = min(nearest[s], math.sqrt(x * x + y * y))


@kernel
def _sector(angle: float) -> int:
    return math.floor((angle / (2.0 * math.pi) + 0.5) * SECTORS) % SECTORS


@kernel
def _mark_what_stands(
    points: Array, pose: tuple[float, float, float], t: float, memory: Memory, found: int
) -> None:
    """Mark legs that lie on static objects of the map."""
    co, si, legs = math.cos(pose[2]), math.sin(pose[2]), memory.legs
    for j in range(found):
        stands = 0
        for i in range(int(legs[j, c.FIRST]), int(legs[j, c.END])):
            x = pose[0] + co * points[i, 0] - si * points[i, 1]
            y = pose[1] + si * points[i, 0] + co * points[i, 1]
            stands += still_map.stands_at(memory.still, x, y, t)
        if 2 * stands > legs[j, c.END] - legs[j, c.FIRST]:
            legs[j, c.STILL] = 1.0


@kernel
def _learn_what_stands(
    points: Array, pose: tuple[float, float, float], t: float, since: float, memory: Memory
) -> None:
    """Add the points of a scan, ``since`` seconds after the last one, to the map.

    Beams far away skip cells of a surface, so places between neighbouring points count, too.
    """
    co, si, still = math.cos(pose[2]), math.sin(pose[2]), memory.still
    joined, last_x, last_y = False, 0.0, 0.0
    for i in range(points.shape[0]):
        x = pose[0] + co * points[i, 0] - si * points[i, 1]
        y = pose[1] + si * points[i, 0] + co * points[i, 1]
        walks = _of_walker(memory.tracks, memory.state[0], x, y)
        weight = since * (_LITTLE if walks else 1.0)
        still_map.notice(still, x, y, t, weight)
        apart = math.sqrt((x - last_x) ** 2 + (y - last_y) ** 2) if joined else 0.0
        if still_map.CELL < apart < _SURFACE:
            steps = int(apart / still_map.CELL) + 1
            for n in range(1, steps):
                share = n / steps
                between = last_x + share * (x - last_x), last_y + share * (y - last_y)
                still_map.notice(still, between[0], between[1], t, weight)
        joined, last_x, last_y = not walks, x, y


@kernel
def _of_walker(tracks: Array, count: int, x: float, y: float) -> bool:
    for i in range(count):
        if tracks[i, k.PERSON] == 0.0:
            continue
        dx, dy = x - tracks[i, k.X], y - tracks[i, k.Y]
        if dx * dx + dy * dy < _BODY * _BODY:
            vx, vy = tracks[i, k.VX], tracks[i, k.VY]
            if vx * vx + vy * vy > _MOVES * _MOVES:
                return True
    return False


@kernel
def _correct(track: Array, legs: Array, first: int, second: int, t: float) -> None:
    """Correct a track by its legs, and decide if it is a person."""
    if first == association.NONE:
        return
    x, y = legs[first, c.X], legs[first, c.Y]
    noise = _noise_of(legs[first])
    if second != association.NONE:
        x, y = 0.5 * (x + legs[second, c.X]), 0.5 * (y + legs[second, c.Y])
        noise = k.PAIR_NOISE
    both = 1.0 if second != association.NONE or legs[first, c.WIDTH] > c.LEG else 0.0
    track[k.BOTH] += _LEARN * (both - track[k.BOTH])
    k.correct(track, x, y, noise)
    track[k.SEEN], track[k.HITS] = t, track[k.HITS] + 1.0
    if track[k.HITS] < _HITS or t - track[k.BORN] < _AGE or legs[first, c.STILL] != 0.0:
        return
    moved = math.hypot(track[k.X] - track[k.X0], track[k.Y] - track[k.Y0])
    pair = second != association.NONE and track[k.BOTH] > _BOTH
    if moved > _MOVED or pair:
        track[k.PERSON] = 1.0


@kernel
def _noise_of(leg: Array) -> float:
    """Return the noise of a person's place as one cluster shows it, m."""
    if leg[c.PARTLY] != 0.0:
        return k.PARTLY_NOISE
    return k.WIDE_NOISE if leg[c.WIDTH] > c.LEG else k.LEG_NOISE


@kernel
def _end(
    tracks: Array,
    state: Indices,
    pose: tuple[float, float, float],
    nearest: Array,
    t: float,
) -> None:
    """Drop tracks that were lost, or that are the same person as an older one."""
    kept = 0
    for i in range(state[0]):
        if _lost(tracks[i], pose, nearest, t) or _double(tracks, kept, i):
            continue
        if kept != i:
            for column in range(tracks.shape[1]):
                tracks[kept, column] = tracks[i, column]
        kept += 1
    state[0] = kept


@kernel
def _lost(track: Array, pose: tuple[float, float, float], nearest: Array, t: float) -> bool:
    unseen = t - track[k.SEEN]
    if unseen <= 0.0:
        return False
    if track[k.PERSON] == 0.0:
        return bool(unseen > _NEW_LOST)
    if unseen <= _LOST:
        return False
    dx, dy = track[k.X] - pose[0], track[k.Y] - pose[1]
    away, angle = math.hypot(dx, dy), math.atan2(dy, dx) - pose[2]
    angle -= 2.0 * math.pi * round(angle / (2.0 * math.pi))
    hidden = nearest[_sector(angle)] < away - _COVER
    return not hidden or unseen > _HIDDEN_LOST


@kernel
def _double(tracks: Array, kept: int, i: int) -> bool:
    """Return True if an older track is the same person; tracks of two legs are averaged."""
    for j in range(kept):
        dx, dy = tracks[i, k.X] - tracks[j, k.X], tracks[i, k.Y] - tracks[j, k.Y]
        square = dx * dx + dy * dy
        if square > association.APART * association.APART:
            continue
        vx, vy = tracks[i, k.VX] - tracks[j, k.VX], tracks[i, k.VY] - tracks[j, k.VY]
        speed = math.sqrt(vx * vx + vy * vy)
        if square < _SAME * _SAME and (speed < _SAME_SPEED or tracks[i, k.PERSON] == 0.0):
            return True
        legs = tracks[i, k.BOTH] < _ONE_LEG and tracks[j, k.BOTH] < _ONE_LEG
        if legs and speed < _LEG_SPEED and tracks[i, k.HITS] >= _HITS:
            for column in (k.X, k.Y, k.VX, k.VY):
                tracks[j, column] = 0.5 * (tracks[i, column] + tracks[j, column])
            return True
    return False


@kernel
def _begin(memory: Memory, found: int, t: float) -> None:
    """Begin a track for each pair of legs, and each single leg, that belongs to none."""
    tracks, state, legs, owner = memory.tracks, memory.state, memory.legs, memory.owner
    old = state[0]
    for j in range(found):
        if owner[j] != association.NONE or legs[j, c.STILL] != 0.0:
            continue
        if state[0] >= tracks.shape[0]:
            return
        if _of_one_legged(memory, old, j):
            continue
        x, y = legs[j, c.X], legs[j, c.Y]
        noise = _noise_of(legs[j])
        other = _partner(legs, found, owner, j)
        if other != association.NONE:
            owner[other] = state[0]
            x, y = 0.5 * (x + legs[other, c.X]), 0.5 * (y + legs[other, c.Y])
            noise = k.WIDE_NOISE
        k.begin(tracks[state[0]], float(state[1]), x, y, noise, t)
        tracks[state[0], k.BOTH] = 0.5
        state[0] += 1
        state[1] += 1


@kernel
def _of_one_legged(memory: Memory, count: int, j: int) -> bool:
    """Return True if a leg may be the other one of a person of whom one leg was found."""
    tracks, legs, first, second = memory.tracks, memory.legs, memory.first, memory.second
    for i in range(count):
        leg = first[i]
        if leg == association.NONE or second[i] != association.NONE or legs[leg, c.WIDTH] > c.LEG:
            continue
        if tracks[i, k.PERSON] == 0.0:
            continue
        apart = math.hypot(legs[j, c.X] - legs[leg, c.X], legs[j, c.Y] - legs[leg, c.Y])
        away = math.hypot(legs[j, c.X] - tracks[i, k.X], legs[j, c.Y] - tracks[i, k.Y])
        if apart < association.APART and away < _TAKEN:
            return True
    return False


@kernel
def _partner(legs: Array, found: int, owner: Indices, j: int) -> int:
    """Return the nearest leg that may be the other one of the same person."""
    best, at = association.APART, association.NONE
    if legs[j, c.WIDTH] > c.LEG:
        return at
    for m in range(j + 1, found):
        if owner[m] != association.NONE or legs[m, c.STILL] != 0.0 or legs[m, c.WIDTH] > c.LEG:
            continue
        apart = math.hypot(legs[m, c.X] - legs[j, c.X], legs[m, c.Y] - legs[j, c.Y])
        if apart < best:
            best, at = apart, m
    return at
