"""Ray casting by columns, compiled: fans of level rays, layered lidars, depth images.

All rays of a column share one horizontal direction, so each upright body is met once for all of
them; columns follow each other by azimuth, so each body is tried only for those that it can cover.
The distances are those of `crowdbot.core.sensing.raycast.cast_rays`, ray by ray.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.bodies import BOTTOM, RADIUS, TOP, X, Y

Array = NDArray[np.float64]

#: Bodies that one column may hold; the farthest are dropped when there are more.
DEEPEST = 32
#: What is known of a body in a column: where it begins and ends (m over the floor), cosine of the
#: level angle between ray and normal, bottom and top (m), whose body it is.
NEAR, FAR, FACING, LOW, HIGH, WHO = range(6)
WORK_COLUMNS = 6
_TURN = 2.0 * math.pi
_MARGIN = 1e-9  # rad; columns at the very edge are left to the exact test
#: Ends of a wall are longer by this fraction, so that no ray slips through a corner.
OVERLAP = 1e-9


class Grid:
    """Directions of a grid of rays that stays as it is, seen from the sensor.

    The ray of row r and column c goes along ``azimuth[c]`` and rises by ``rise[r] * lean[c]`` per
    metre of way over the floor.

    Attributes:
        azimuth: (C,) rising, within one turn, rad; 0 is straight ahead.
        rise: (R,).
        lean: (C,).
        work, count, ways, runs: scratch, see `fill_columns`.
    """

    def __init__(self, azimuth: ArrayLike, rise: ArrayLike, lean: ArrayLike | None = None) -> None:
        self.azimuth = np.array(azimuth, dtype=np.float64)
        self.rise = np.array(rise, dtype=np.float64)
        self.lean = np.ones_like(self.azimuth) if lean is None else np.array(lean, np.float64)
        self.cos, self.sin = np.cos(self.azimuth), np.sin(self.azimuth)
        # What a level ray meets hides all behind it.
        deepest = DEEPEST if np.any(self.rise) else 1
        columns = len(self.azimuth)
        self.work = np.empty((columns, deepest, WORK_COLUMNS))
        self.count = np.zeros(columns, np.int64)
        self.ways = np.empty((2, columns))
        self.runs = np.empty((3, 2), np.int64)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.rise), len(self.azimuth)


@kernel
def _first_from(azimuth: Array, value: float) -> int:
    """Index of the first column at or after an azimuth."""
    low, high = 0, azimuth.shape[0]
    while low < high:
        middle = (low + high) // 2
        if azimuth[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _cover(azimuth: Array, low: float, high: float, runs: NDArray[np.int64]) -> int:
    """Write the runs of columns whose azimuths lie in [low, high], a turn more or less.

    Returns:
        how many runs there are, at most three.
    """
    count, last = 0, azimuth[azimuth.shape[0] - 1]
    turn = math.floor((azimuth[0] - high) / _TURN) * _TURN
    while low + turn <= last and count < 3:
        if high + turn >= azimuth[0]:
            begin = _first_from(azimuth, low + turn)
            end = begin
            while end < azimuth.shape[0] and azimuth[end] <= high + turn:
                end += 1
            runs[count, 0], runs[count, 1] = begin, end
            count += 1
        turn += _TURN
    return count


@kernel
def _insert(
    work: Array, count: NDArray[np.int64], c: int,
    near: float, far: float, facing: float, low: float, high: float, who: int,
) -> None:  # fmt: skip
    """Put a body into column c, nearest first; equal distances keep the order of insertion."""
    n = count[c]
    if n == work.shape[1]:
        if near >= work[c, n - 1, NEAR]:
            return
        n -= 1
    k = n
    while k > 0 and work[c, k - 1, NEAR] > near:
        for column in range(WORK_COLUMNS):
            work[c, k, column] = work[c, k - 1, column]
        k -= 1
    work[c, k, NEAR], work[c, k, FAR], work[c, k, FACING] = near, far, facing
    work[c, k, LOW], work[c, k, HIGH], work[c, k, WHO] = low, high, who
    count[c] = n + 1


@kernel
def _add_disc(
    px: float, py: float, r: float, bottom: float, top: float, yaw: float, who: int,
    azimuth: Array, cos: Array, sin: Array, work: Array, count: NDArray[np.int64],
    runs: NDArray[np.int64],
) -> None:  # fmt: skip
    """Put an upright cylinder, its axis at (px, py) from the rays' origin, into its columns."""
    away = math.hypot(px, py)
    number = 1
    if away <= r:
        runs[0, 0], runs[0, 1] = 0, azimuth.shape[0]
    else:
        bearing, half = math.atan2(py, px) - yaw, math.asin(r / away) + _MARGIN
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
            _insert(work, count, c, near, along + depth, facing, bottom, top, who)


@kernel
def _gap(px: float, py: float, ex: float, ey: float) -> float:
    """Distance from the origin to the segment from p to p + e, m."""
    share = min(1.0, max(0.0, -(px * ex + py * ey) / (ex * ex + ey * ey)))
    return math.hypot(px + share * ex, py + share * ey)


@kernel
def _add_wall(
    ox: float, oy: float, yaw: float, wall: Array, heights: Array, who: int, reach: float,
    azimuth: Array, cos: Array, sin: Array, work: Array, count: NDArray[np.int64],
    runs: NDArray[np.int64],
) -> None:  # fmt: skip
    """Put an upright plate into every column that meets it within ``reach``."""
    px, py = wall[0] - ox, wall[1] - oy
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    length = math.hypot(ex, ey)
    if length == 0.0 or _gap(px, py, ex, ey) > reach:
        return
    begin, end = math.atan2(py, px), math.atan2(py + ey, px + ex)
    turn = end - begin  # a plate covers less than half a turn
    if turn > math.pi:
        turn -= _TURN
    elif turn < -math.pi:
        turn += _TURN
    start = (begin if turn >= 0.0 else begin + turn) - yaw
    number = _cover(azimuth, start - _MARGIN, start + abs(turn) + _MARGIN, runs)
    for run in range(number):
        for c in range(runs[run, 0], runs[run, 1]):
            across = cos[c] * ey - sin[c] * ex
            if across == 0.0:
                continue
            t = (px * ey - py * ex) / across
            s = (px * sin[c] - py * cos[c]) / across
            if t < 0.0 or t > reach or s < -OVERLAP or s > 1.0 + OVERLAP:
                continue
            _insert(work, count, c, t, t, abs(across) / length, heights[0], heights[1], who)


@kernel
def fill_columns(
    x: float, y: float, yaw: float, lowest: float, highest: float, azimuth: Array, cos: Array,
    sin: Array, max_range: float, walls: Array, wall_heights: Array, discs: Array,
    owner: NDArray[np.int64], work: Array, count: NDArray[np.int64], ways: Array,
    runs: NDArray[np.int64],
) -> None:  # fmt: skip
    """Put every body between two heights into the columns that meet it.

    Args:
        x, y, yaw: origin and direction in the world frame, m and rad.
        lowest, highest: heights between which rays run, m.
        azimuth: (C,) rising, within one turn, rad.
        cos, sin: (C,) of azimuth.
        max_range: m; what is farther is left out.
        walls, wall_heights: (S, 4), (S, 2).
        discs, owner: (D, 5), (D,) upright cylinders and the bodies that they belong to.
        work: (C, K, `WORK_COLUMNS`) output, the K nearest of each column, nearest first.
        count: (C,) output, how many bodies each column holds.
        ways, runs: (2, C), (3, 2) scratch.
    """
    c0, s0 = math.cos(yaw), math.sin(yaw)
    ahead, aside = ways[0], ways[1]
    for c in range(azimuth.shape[0]):
        ahead[c], aside[c] = c0 * cos[c] - s0 * sin[c], s0 * cos[c] + c0 * sin[c]
        count[c] = 0
    for i in range(walls.shape[0]):
        if wall_heights[i, 0] <= highest and wall_heights[i, 1] >= lowest:
            _add_wall(
                x, y, yaw, walls[i], wall_heights[i], -(2 + i), max_range,
                azimuth, ahead, aside, work, count, runs,
            )  # fmt: skip
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        far = max_range + r  # most are: sorted out here, before anything is called
        if not (abs(px) <= far and abs(py) <= far and math.hypot(px, py) - r <= max_range):
            continue
        if discs[i, BOTTOM] <= highest and discs[i, TOP] >= lowest:
            _add_disc(
                px, py, r, discs[i, BOTTOM], discs[i, TOP], yaw, owner[i],
                azimuth, ahead, aside, work, count, runs,
            )  # fmt: skip


@kernel
def heights_of(z: float, rise: Array, lean: Array, max_range: float) -> tuple[float, float]:
    """Heights between which the rays of a grid from a height ``z`` run, m."""
    longest = lowest = highest = 0.0
    for k in range(lean.shape[0]):
        longest = max(longest, abs(lean[k]))
    for k in range(rise.shape[0]):
        lowest, highest = min(lowest, rise[k]), max(highest, rise[k])
    reach = longest * max_range
    return z + lowest * reach, z + highest * reach


@kernel
def meet(slope: float, oz: float, near: float, far: float, low: float, high: float) -> float:
    """Horizontal distance at which a ray meets an upright body; inf if it misses.

    The ray rises by ``slope`` per metre from the height ``oz``.
    """
    z = oz + slope * near
    if low <= z <= high:
        return near
    face = high if z > high else low
    if (z > high) == (slope < 0.0) and slope != 0.0:  # comes down on the top, or up from below
        t = (face - oz) / slope
        if t <= far and far > near:
            return t
    return math.inf


@kernel
def cast_columns(
    x: float, y: float, z: float, yaw: float, azimuth: Array, cos: Array, sin: Array,
    rise: Array, lean: Array, max_range: float, floor: bool,
    walls: Array, wall_heights: Array, discs: Array, owner: NDArray[np.int64], work: Array,
    count: NDArray[np.int64], ways: Array, runs: NDArray[np.int64],
    distance: Array, incidence: Array, body: NDArray[np.int64],
) -> None:  # fmt: skip
    """Nearest hit of each ray of a grid.

    The ray of row r and column c goes along ``yaw + azimuth[c]`` and rises by
    ``rise[r] * lean[c]`` per metre of way over the floor.

    Args:
        x, y, z, yaw: origin and direction in the world frame, m and rad.
        azimuth: (C,) rising, within one turn, rad.
        cos, sin: (C,) of azimuth.
        rise: (R,).
        lean: (C,).
        max_range: m; hits beyond it do not count.
        floor: whether the floor z = 0 is hit.
        walls, wall_heights: (S, 4), (S, 2).
        discs, owner: (D, 5), (D,) upright cylinders and the bodies that they belong to.
        work, count, ways, runs: scratch, as `fill_columns` has it.
        distance: (R, C) result, m; inf without a hit.
        incidence: (R, C) result, angle to the normal, rad, 0 without a hit; or (0, 0).
        body: (R, C) result: owner, -(2 + index) of a wall, -1 for nothing and the floor; or (0, 0).
    """
    lowest, highest = heights_of(z, rise, lean, max_range)
    fill_columns(
        x, y, yaw, lowest, highest, azimuth, cos, sin, max_range,
        walls, wall_heights, discs, owner, work, count, ways, runs,
    )  # fmt: skip
    wants_incidence, wants_body = incidence.shape[0] > 0, body.shape[0] > 0
    for r in range(rise.shape[0]):
        for c in range(azimuth.shape[0]):
            slope = rise[r] * lean[c]
            best, hit = -z / slope if floor and slope < 0.0 else math.inf, -1
            for k in range(count[c]):
                here = work[c, k]
                if here[NEAR] >= best:
                    break
                t = meet(slope, z, here[NEAR], here[FAR], here[LOW], here[HIGH])
                if t < best:
                    best, hit = t, k
            stretch = math.sqrt(1.0 + slope * slope)
            found = best * stretch <= max_range
            distance[r, c] = best * stretch if found else math.inf
            if wants_body:
                body[r, c] = int(work[c, hit, WHO]) if found and hit >= 0 else -1
            if wants_incidence:
                incidence[r, c] = 0.0
                if found and best > 0.0:
                    level = hit < 0 or best > work[c, hit, NEAR]  # the floor, a top or a bottom
                    cosine = (abs(slope) if level else work[c, hit, FACING]) / stretch
                    incidence[r, c] = math.acos(min(1.0, cosine))
