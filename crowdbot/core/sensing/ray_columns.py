"""Columns of rays with one direction each, and the bodies inserted into them; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.core.geometry.rough_angle import rough_angle
from crowdbot.core.sensing.ray_grid import (
    FACING,
    FAR,
    HIGH,
    LOW,
    NEAR,
    OVERLAP,
    OWNER,
    PARALLEL,
    WORK_COLUMNS,
)
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

_TURN = 2.0 * math.pi
_MARGIN = 1e-9  # rad; columns at the very edge use the exact test
_WIDE_MARGIN = 3e-5  # rad; larger than the errors of `rough_angle` and `rough_half`
_ALMOST = 3.141  # rad; almost half a turn
_BAND = 1e-9  # relative, of squared distances; nearer to a limit the exact distance decides
#: Rank of bodies that come after all others at the same distance.
_LAST = -(2**62)


class RayColumns(NamedTuple):
    """Columns being filled: their azimuths, directions in the world, and `GridArrays`."""

    azimuth: Array
    cos: Array
    sin: Array
    work: Array
    filled: Indices
    runs: Indices


@kernel
def rough_half(sine: float) -> float:
    """Return a tight upper bound of the arc sine of a number from 0 to 1, rad."""
    # (asin(s) - s) / s^3 increases with s, to 0.18880 at 0.5.
    return sine + 0.1889 * sine * sine * sine if sine <= 0.5 else math.asin(sine)


@kernel
def reached(px: float, py: float, r: float, reach: float) -> bool:
    """Return True if a disc is within reach of the origin, like ``hypot`` but faster."""
    square, most = px * px + py * py, (reach + r) * (reach + r)
    if abs(square - most) <= _BAND * most:
        return math.hypot(px, py) - r <= reach
    return square < most


@kernel
def _first_from(azimuth: Array, value: float) -> int:
    """Return the index of the first column at or after an azimuth."""
    low, high = 0, azimuth.shape[0]
    guess = (value - azimuth[0]) / (azimuth[high - 1] - azimuth[0]) * (high - 1)
    if 0.0 < guess < high - 1:  # columns are usually evenly spaced; NaN with a single column
        k = int(guess)
        if azimuth[k] < value <= azimuth[k + 1]:
            return k + 1
    while low < high:
        middle = (low + high) // 2
        if azimuth[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _cover(azimuth: Array, low: float, high: float, runs: Indices) -> int:
    """Write the runs of columns with azimuths in [low, high], modulo a turn.

    Returns:
        the number of runs, at most three.
    """
    count, last = 0, azimuth[azimuth.shape[0] - 1]
    turn = math.floor((azimuth[0] - high) / _TURN) * _TURN
    while low + turn <= last and count < 3:
        if high + turn >= azimuth[0]:
            begin = _first_from(azimuth, low + turn)
            end = max(begin, _first_from(azimuth, high + turn))
            while end < azimuth.shape[0] and azimuth[end] <= high + turn:
                end += 1
            runs[count, 0], runs[count, 1] = begin, end
            count += 1
        turn += _TURN
    return count


@kernel
def _insert(
    columns: RayColumns, c: int,
    near: float, far: float, facing: float, low: float, high: float, owner: int,
) -> None:  # fmt: skip
    """Insert a body into column c, nearest first; equal distances keep the insertion order."""
    insert_before(columns, c, near, far, facing, low, high, owner, _LAST)


@inline_kernel
def insert_before(
    columns: RayColumns, c: int,
    near: float, far: float, facing: float, low: float, high: float, owner: int, rank: int,
) -> None:  # fmt: skip
    """Like `_insert`, but before bodies at the same distance whose owner is below ``rank``."""
    work, filled = columns.work, columns.filled
    n = filled[c]
    if n == work.shape[1]:
        n -= 1
        if not _is_before(near, rank, work[c, n, NEAR], work[c, n, OWNER]):
            n = -1
    else:
        filled[c] = n + 1
    if n >= 0:
        while n > 0 and _is_before(near, rank, work[c, n - 1, NEAR], work[c, n - 1, OWNER]):
            for column in range(WORK_COLUMNS):
                work[c, n, column] = work[c, n - 1, column]
            n -= 1
        work[c, n, NEAR], work[c, n, FAR], work[c, n, FACING] = near, far, facing
        work[c, n, LOW], work[c, n, HIGH], work[c, n, OWNER] = low, high, owner


@inline_kernel
def _is_before(near: float, rank: int, other: float, owner: float) -> bool:
    """Return True if a body comes before another one of a column."""
    return near < other or (near == other and owner < rank)


@kernel
def add_disc(
    px: float, py: float, r: float, bottom: float, top: float, yaw: float, owner: int,
    columns: RayColumns,
) -> None:  # fmt: skip
    """Insert an upright cylinder, with its axis at (px, py) from the rays' origin."""
    azimuth, cos, sin, runs = columns.azimuth, columns.cos, columns.sin, columns.runs
    number = 1
    if reached(px, py, r, 0.0):
        runs[0, 0], runs[0, 1] = 0, azimuth.shape[0]
    else:
        away = math.sqrt(px * px + py * py)
        bearing = rough_angle(px, py) - yaw
        half = rough_half(min(1.0, r / away)) + _WIDE_MARGIN
        number = _cover(azimuth, bearing - half, bearing + half, runs)
    for run in range(number):
        for c in range(runs[run, 0], runs[run, 1]):
            along, across = cos[c] * px + sin[c] * py, cos[c] * py - sin[c] * px
            room = r * r - across * across
            if room < 0.0:
                continue
            depth = math.sqrt(room)
            if along + depth < 0.0:
                continue
            near = max(0.0, along - depth)
            facing = 1.0 if near == 0.0 or r == 0.0 else min(1.0, depth / r)
            _insert(columns, c, near, along + depth, facing, bottom, top, owner)


@kernel
def gap_to_plate(px: float, py: float, ex: float, ey: float) -> float:
    """Return the distance from the origin to the segment from p to p + e, m."""
    share = min(1.0, max(0.0, -(px * ex + py * ey) / (ex * ex + ey * ey)))
    return math.hypot(px + share * ex, py + share * ey)


@kernel
def _covered_by(
    px: float, py: float, ex: float, ey: float, yaw: float, azimuth: Array, runs: Indices
) -> int:
    """Write the runs of columns that a plate from p to p + e may cover; return their number."""
    begin, end = math.atan2(py, px), math.atan2(py + ey, px + ex)
    turn = end - begin  # a plate covers less than half a turn
    if turn > math.pi:
        turn -= _TURN
    elif turn < -math.pi:
        turn += _TURN
    start = (begin if turn >= 0.0 else begin + turn) - yaw
    return _cover(azimuth, start - _MARGIN, start + abs(turn) + _MARGIN, runs)


@kernel
def covered_roughly(
    px: float, py: float, ex: float, ey: float, yaw: float, azimuth: Array, runs: Indices
) -> int:
    """Like `_covered_by`, faster, and perhaps with a column more at each end."""
    if (px == 0.0 and py == 0.0) or (px + ex == 0.0 and py + ey == 0.0):
        return _covered_by(px, py, ex, ey, yaw, azimuth, runs)
    begin, end = rough_angle(px, py), rough_angle(px + ex, py + ey)
    turn = end - begin
    if turn > math.pi:
        turn -= _TURN
    elif turn < -math.pi:
        turn += _TURN
    if abs(turn) > _ALMOST:  # on which side it passes is for exact angles to say
        return _covered_by(px, py, ex, ey, yaw, azimuth, runs)
    start = (begin if turn >= 0.0 else begin + turn) - yaw
    return _cover(azimuth, start - _WIDE_MARGIN, start + abs(turn) + _WIDE_MARGIN, runs)


@kernel
def add_wall(
    ox: float, oy: float, yaw: float, wall: Array, heights: Array, owner: int, reach: float,
    columns: RayColumns,
) -> None:  # fmt: skip
    """Insert an upright plate into every column that meets it within ``reach``."""
    azimuth, cos, sin, runs = columns.azimuth, columns.cos, columns.sin, columns.runs
    px, py = wall[0] - ox, wall[1] - oy
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    length = math.hypot(ex, ey)
    if length == 0.0 or gap_to_plate(px, py, ex, ey) > reach:
        return
    number = _covered_by(px, py, ex, ey, yaw, azimuth, runs)
    for run in range(number):
        for c in range(runs[run, 0], runs[run, 1]):
            across = cos[c] * ey - sin[c] * ex
            if across * across <= PARALLEL * length * length:
                continue
            t = (px * ey - py * ex) / across
            s = (px * sin[c] - py * cos[c]) / across
            if t < 0.0 or t > reach or s < -OVERLAP or s > 1.0 + OVERLAP:
                continue
            _insert(columns, c, t, t, abs(across) / length, heights[0], heights[1], owner)
