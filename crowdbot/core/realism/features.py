"""Features to compare: one row per person in a window and frame, and one per window."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.realism.bins import DENSITY_EDGES, DISC, DT, NEVER, REACH
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

#: Columns of people's rows: cell of the density, then the features.
CELL, SPEED, ACCELERATION, TURNING, NEAREST, COLLISION = range(6)
PERSON_COLUMNS = 6
#: Columns of windows' rows: cell, density, mean speed, lane order.
DENSITY, PACE, LANES = range(1, 4)
WINDOW_COLUMNS = 4
#: Faster steps are tracking jumps, m/s.
_FASTEST = 4.0
#: Weights for smoothing at 4 Hz: heads sway by about 3 cm at 1 Hz.
_SMOOTH = np.array([1.0, 2.0, 2.0, 2.0, 1.0]) / 8.0
#: People whose y differs by less than this walk in the same lane, m.
_LANE = 0.375
#: Frames at both ends without acceleration: smoothing takes 2, each difference 1.
_ENDS = 4


def motion(way: Array) -> tuple[Array, Array]:
    """Return velocities and accelerations (T, N, 2) of smoothed paths, m/s, m/s^2.

    NaN at the ends.
    """
    smooth = np.full_like(way, np.nan)
    frames = len(way)
    if frames > _ENDS:
        smooth[2:-2] = sum(_SMOOTH[k] * way[k : frames - 4 + k] for k in range(5))
    velocity, acceleration = np.full_like(way, np.nan), np.full_like(way, np.nan)
    velocity[1:-1] = (smooth[2:] - smooth[:-2]) / (2.0 * DT)
    with np.errstate(invalid="ignore"):
        velocity[np.hypot(velocity[..., 0], velocity[..., 1]) > _FASTEST] = np.nan
    acceleration[1:-1] = (velocity[2:] - velocity[:-2]) / (2.0 * DT)
    return velocity, acceleration


def features(tracks: CorridorTracks) -> tuple[Array, Array]:
    """Return people's rows (R, `PERSON_COLUMNS`) and windows' rows (F, `WINDOW_COLUMNS`)."""
    velocity, acceleration = motion(tracks.way)
    first, last = max(tracks.first, _ENDS), min(tracks.last, len(tracks.way) - _ENDS)
    count, windows = tracks.way.shape[1], len(tracks.windows)
    frames = max(0, last - first)
    people = np.empty((frames * count * windows, PERSON_COLUMNS))
    spaces = np.empty((frames * windows, WINDOW_COLUMNS))
    found = _features(
        np.ascontiguousarray(tracks.position), velocity, acceleration, tracks.direction,
        tracks.width, np.asarray(tracks.windows, np.float64), tracks.period, DENSITY_EDGES,
        first, last, people, spaces,
    )  # fmt: skip
    return people[: found[0]], spaces[: found[1]]


@array_kernel
def _features(
    position: Array, velocity: Array, acceleration: Array, direction: Array, width: float,
    windows: Array, period: float, edges: Array, first: int, last: int,
    people: Array, spaces: Array,
) -> tuple[int, int]:  # fmt: skip
    rows, frames = 0, 0
    here = np.empty(position.shape[1], np.int64)
    inside = np.empty(position.shape[1], np.int64)
    for k in range(first, last):
        present = _present(position[k], here)
        for w in range(windows.shape[0]):
            count = _inside(position[k], here, present, windows[w], inside)
            density = count / ((windows[w, 1] - windows[w, 0]) * width)
            cell = np.searchsorted(edges, density, side="right") - 1
            cell = cell if cell < len(edges) - 1 else -1
            pace, seen, lanes, judged = 0.0, 0, 0.0, 0
            for a in range(count):
                i = inside[a]
                if math.isnan(velocity[k, i, 0]):
                    continue
                pace += math.hypot(velocity[k, i, 0], velocity[k, i, 1])
                seen += 1
                if count < 2:
                    continue
                order = _lane(position[k], direction, inside, count, i)
                if order >= 0.0:
                    lanes += order
                    judged += 1
                if cell >= 0:
                    _person(
                        position[k], velocity, acceleration[k], here, present, k, i, period,
                        people[rows],
                    )  # fmt: skip
                    people[rows, CELL] = cell
                    rows += 1
            if seen > 0:
                spaces[frames, CELL], spaces[frames, DENSITY] = cell, density
                spaces[frames, PACE] = pace / seen
                spaces[frames, LANES] = lanes / judged if judged > 0 else math.nan
                frames += 1
    return rows, frames


@kernel
def _present(position: Array, here: Indices) -> int:
    """Write the indices of present people, whose (N, 2) positions are not NaN; return how many."""
    count = 0
    for i in range(position.shape[0]):
        if not math.isnan(position[i, 0]):
            here[count] = i
            count += 1
    return count


@kernel
def _inside(position: Array, here: Indices, present: int, window: Array, inside: Indices) -> int:
    """Write which of ``here`` are in a window along x, begin and end in m; return how many."""
    count = 0
    for a in range(present):
        if window[0] <= position[here[a], 0] < window[1]:
            inside[count] = here[a]
            count += 1
    return count


@kernel
def _lane(position: Array, direction: Array, inside: Indices, count: int, i: int) -> float:
    """Return how one-way person i's lane is: ((with - against)/all)^2; -1 if it is empty."""
    same, other = 0, 0
    for a in range(count):
        j = inside[a]
        if j != i and abs(position[j, 1] - position[i, 1]) < _LANE:
            if direction[j] == direction[i]:
                same += 1
            else:
                other += 1
    if same + other == 0:
        return -1.0
    return ((same - other) / (same + other)) ** 2


@kernel
def _person(
    position: Array, velocity: Array, acceleration: Array, here: Indices, present: int,
    k: int, i: int, period: float, row: Array,
) -> None:  # fmt: skip
    """Write the features of person i in frame k."""
    row[SPEED] = math.hypot(velocity[k, i, 0], velocity[k, i, 1])
    row[ACCELERATION] = math.hypot(acceleration[i, 0], acceleration[i, 1])
    turn = math.atan2(velocity[k + 1, i, 1], velocity[k + 1, i, 0])
    turn -= math.atan2(velocity[k - 1, i, 1], velocity[k - 1, i, 0])
    if turn > math.pi:
        turn -= 2.0 * math.pi
    elif turn < -math.pi:
        turn += 2.0 * math.pi
    row[TURNING] = turn / (2.0 * DT)
    nearest, soonest = math.inf, NEVER
    for b in range(present):
        j = here[b]
        if j == i:
            continue
        dx, dy = position[i, 0] - position[j, 0], position[i, 1] - position[j, 1]
        if period > 0.0:
            dx -= period * round(dx / period)
        distance = math.sqrt(dx * dx + dy * dy)
        if distance > REACH:
            continue
        nearest = min(nearest, distance)
        ux, uy = velocity[k, i, 0] - velocity[k, j, 0], velocity[k, i, 1] - velocity[k, j, 1]
        if not math.isnan(ux):
            soonest = min(soonest, _touch(dx, dy, ux, uy))
    row[NEAREST], row[COLLISION] = nearest, soonest


@kernel
def _touch(dx: float, dy: float, ux: float, uy: float) -> float:
    """Return the time until two discs touch, s; 0 if they touch now, inf if never."""
    gap2 = dx * dx + dy * dy - DISC * DISC
    if gap2 <= 0.0:
        return 0.0
    approach, speed2 = dx * ux + dy * uy, ux * ux + uy * uy
    root = approach * approach - speed2 * gap2
    if approach >= 0.0 or root <= 0.0:
        return math.inf
    return gap2 / (math.sqrt(root) - approach)
