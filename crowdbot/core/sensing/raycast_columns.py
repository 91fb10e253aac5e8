"""Ray casting by columns, compiled: fans of level rays, layered lidars, depth images.

All rays of a column share one horizontal direction, so each upright body is met once for all of
them; columns follow each other by azimuth, so each body is tried only for those that it can cover.
The distances are those of `crowdbot.core.sensing.raycast.cast_rays`, ray by ray.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.geometry.rough_angle import rough_angle
from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

#: Largest number of bodies per column; the farthest are dropped.
DEEPEST = 32
#: Data of a body in a column: its start and end (m over the floor), cosine of the level angle
#: between ray and normal, bottom and top (m), its owner.
NEAR, FAR, FACING, LOW, HIGH, WHO = range(6)
WORK_COLUMNS = 6
_TURN = 2.0 * math.pi
_MARGIN = 1e-9  # rad; columns at the very edge use the exact test
_WIDE_MARGIN = 3e-5  # rad; larger than the errors of `rough_angle` and `rough_half`
_ALMOST = 3.141  # rad; almost half a turn
_BAND = 1e-9  # relative, of squared distances; nearer to a limit the exact distance decides
#: Rank of bodies that come after all others at the same distance.
_LAST = -(2**62)
#: Number of walls after which the farthest visible distance is found again.
_OFTEN = 16
#: Ends of a wall are extended by this fraction, so that no ray passes through a corner.
OVERLAP = 1e-9
#: Square of the sine of an angle between a ray and a wall below which they count as parallel: where
#: the ray runs along the wall, rounding would decide at which distance they meet.
PARALLEL = 1e-24


class Obstacles(NamedTuple):
    """Everything that rays can hit, for compiled code; see `Scene.obstacles`.

    Attributes:
        walls, wall_heights: (S, 4), (S, 2) upright plates: x0, y0, x1, y1; bottom and top, m.
        discs: (D, 5) upright cylinders, columns as in `crowdbot.core.sensing.body_model`, m.
        owner: (D,) owner of each cylinder: a person's index, or -(2 + S + index) for a pillar.
    """

    walls: Array
    wall_heights: Array
    discs: Array
    owner: Indices


class GridArrays(NamedTuple):
    """A `RayGrid` for compiled code, with R rows and C columns.

    Attributes:
        azimuth, cos, sin: (C,) rising, within one turn, rad; 0 is straight ahead.
        slope, slope_scale: (R,), (C,).
        work: (C, K, `WORK_COLUMNS`) scratch: the K nearest bodies of each column, nearest first.
        filled: (C,) scratch: number of bodies per column.
        directions: (5, C) scratch: the columns' directions in the world frame; distance, bottom and
            top of the plate that hides what is behind it, m.
        runs: (3, 2) scratch.
    """

    azimuth: Array
    cos: Array
    sin: Array
    slope: Array
    slope_scale: Array
    work: Array
    filled: Indices
    directions: Array
    runs: Indices


class RayGrid:
    """Directions of a constant grid of rays, relative to the sensor.

    The ray of row r and column c goes along ``azimuth[c]`` and rises by
    ``slope[r] * slope_scale[c]`` per metre over the floor.

    Attributes:
        azimuth: (C,) rising, within one turn, rad; 0 is straight ahead.
        slope: (R,).
        slope_scale: (C,) 1 by default; for a pinhole camera the cosine of the azimuth.
        arrays: all of these, and scratch space.
    """

    def __init__(
        self, azimuth: ArrayLike, slope: ArrayLike, slope_scale: ArrayLike | None = None
    ) -> None:
        self.azimuth = np.array(azimuth, dtype=np.float64)
        self.slope = np.array(slope, dtype=np.float64)
        given = np.ones_like(self.azimuth) if slope_scale is None else slope_scale
        self.slope_scale = np.array(given, np.float64)
        # What a level ray hits hides everything behind it.
        deepest = DEEPEST if np.any(self.slope) else 1
        columns = len(self.azimuth)
        self.arrays = GridArrays(
            self.azimuth, np.cos(self.azimuth), np.sin(self.azimuth), self.slope,
            self.slope_scale, np.empty((columns, deepest, WORK_COLUMNS)),
            np.zeros(columns, np.int64), np.empty((5, columns)), np.empty((3, 2), np.int64),
        )  # fmt: skip

    @property
    def shape(self) -> tuple[int, int]:
        """Return rows and columns."""
        return len(self.slope), len(self.azimuth)


class _Columns(NamedTuple):
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
def _reached(px: float, py: float, r: float, reach: float) -> bool:
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
    columns: _Columns, c: int,
    near: float, far: float, facing: float, low: float, high: float, owner: int,
) -> None:  # fmt: skip
    """Insert a body into column c, nearest first; equal distances keep the insertion order."""
    _insert_before(columns, c, near, far, facing, low, high, owner, _LAST)


@inline_kernel
def _insert_before(
    columns: _Columns, c: int,
    near: float, far: float, facing: float, low: float, high: float, owner: int, rank: int,
) -> None:  # fmt: skip
    """Like `_insert`, but before bodies at the same distance whose owner is below ``rank``."""
    work, filled = columns.work, columns.filled
    n = filled[c]
    if n == work.shape[1]:
        n -= 1
        if not _is_before(near, rank, work[c, n, NEAR], work[c, n, WHO]):
            n = -1
    else:
        filled[c] = n + 1
    if n >= 0:
        while n > 0 and _is_before(near, rank, work[c, n - 1, NEAR], work[c, n - 1, WHO]):
            for column in range(WORK_COLUMNS):
                work[c, n, column] = work[c, n - 1, column]
            n -= 1
        work[c, n, NEAR], work[c, n, FAR], work[c, n, FACING] = near, far, facing
        work[c, n, LOW], work[c, n, HIGH], work[c, n, WHO] = low, high, owner


@inline_kernel
def _is_before(near: float, rank: int, other: float, owner: float) -> bool:
    """Return True if a body comes before another one of a column."""
    return near < other or (near == other and owner < rank)


@kernel
def _add_disc(
    px: float, py: float, r: float, bottom: float, top: float, yaw: float, owner: int,
    columns: _Columns,
) -> None:  # fmt: skip
    """Insert an upright cylinder, with its axis at (px, py) from the rays' origin."""
    azimuth, cos, sin, runs = columns.azimuth, columns.cos, columns.sin, columns.runs
    number = 1
    if _reached(px, py, r, 0.0):
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
def _gap(px: float, py: float, ex: float, ey: float) -> float:
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
def _covered_roughly(
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
def _add_wall(
    ox: float, oy: float, yaw: float, wall: Array, heights: Array, owner: int, reach: float,
    columns: _Columns,
) -> None:  # fmt: skip
    """Insert an upright plate into every column that meets it within ``reach``."""
    azimuth, cos, sin, runs = columns.azimuth, columns.cos, columns.sin, columns.runs
    px, py = wall[0] - ox, wall[1] - oy
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    length = math.hypot(ex, ey)
    if length == 0.0 or _gap(px, py, ex, ey) > reach:
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


@kernel
def _turned(grid: GridArrays, yaw: float) -> _Columns:
    """Return the empty columns of a grid, turned by its yaw in the world frame, rad."""
    c0, s0 = math.cos(yaw), math.sin(yaw)
    world_cos, world_sin, filled = grid.directions[0], grid.directions[1], grid.filled
    for c in range(grid.azimuth.shape[0]):
        world_cos[c] = c0 * grid.cos[c] - s0 * grid.sin[c]
        world_sin[c] = s0 * grid.cos[c] + c0 * grid.sin[c]
        filled[c] = 0
    return _Columns(grid.azimuth, world_cos, world_sin, grid.work, filled, grid.runs)


@kernel
def _add_discs(
    x: float, y: float, yaw: float, lowest: float, highest: float, max_range: float,
    discs: Array, owner: Indices, columns: _Columns,
) -> None:  # fmt: skip
    """Insert all cylinders between two heights within range."""
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        bottom, top = discs[i, BOTTOM], discs[i, TOP]
        if not (bottom <= highest and top >= lowest):
            continue
        far = max_range + r  # most are excluded here, before any call
        if abs(px) <= far and abs(py) <= far and _reached(px, py, r, max_range):
            _add_disc(px, py, r, bottom, top, yaw, owner[i], columns)


@kernel
def fill_columns(
    x: float,
    y: float,
    yaw: float,
    lowest: float,
    highest: float,
    max_range: float,
    grid: GridArrays,
    obstacles: Obstacles,
) -> None:
    """Insert every body between two heights into the columns of a grid that meet it.

    Args:
        x, y, yaw: origin and direction in the world frame, m and rad.
        lowest, highest: range of the rays' heights, m.
        max_range: largest distance of bodies, m.
        grid: ``work`` and ``filled`` hold the result.
    """
    columns = _turned(grid, yaw)
    walls, heights, discs = obstacles.walls, obstacles.wall_heights, obstacles.discs
    for i in range(walls.shape[0]):
        if heights[i, 0] <= highest and heights[i, 1] >= lowest:
            _add_wall(x, y, yaw, walls[i], heights[i], -(2 + i), max_range, columns)
    _add_discs(x, y, yaw, lowest, highest, max_range, discs, obstacles.owner, columns)


@kernel
def _fill_visible(
    x: float, y: float, z: float, yaw: float, lowest: float, highest: float, max_range: float,
    grid: GridArrays, obstacles: Obstacles, order: Indices, bound: Array,
) -> None:  # fmt: skip
    """Like `fill_columns` for rays from a height ``z``, without walls that nearer ones hide.

    Args:
        order, bound: (S,) the walls, nearest first, and lower bounds of their distances, m.
    """
    columns = _turned(grid, yaw)
    walls, heights, hider = obstacles.walls, obstacles.wall_heights, grid.directions[2]
    low, high, most = z, z, max_range
    for c in range(hider.shape[0]):
        hider[c], grid.directions[3, c], grid.directions[4, c] = math.inf, z, z
    for i in order:
        low, high = min(low, heights[i, 0]), max(high, heights[i, 1])
    low, high = max(low, lowest), min(high, highest)
    for k in range(order.shape[0]):
        i = order[k]
        if bound[k] > most:
            break
        if heights[i, 0] <= highest and heights[i, 1] >= lowest:
            _add_visible_wall(
                x, y, z, yaw, walls[i], heights[i], max(heights[i, 0], lowest),
                min(heights[i, 1], highest), -(2 + i), most, max_range, columns, grid.directions,
            )  # fmt: skip
        if k % _OFTEN == _OFTEN - 1:
            most = min(max_range, _farthest(low, high, grid.directions) * (1.0 + _BAND))
    _add_discs(x, y, yaw, lowest, highest, max_range, obstacles.discs, obstacles.owner, columns)


@kernel
def _farthest(low: float, high: float, directions: Array) -> float:
    """Return the distance beyond which bodies between two heights are hidden, m; inf: none is."""
    farthest = 0.0
    for c in range(directions.shape[1]):
        if directions[3, c] > low or directions[4, c] < high:
            return math.inf
        farthest = max(farthest, directions[2, c])
    return farthest


@inline_kernel
def _add_visible_wall(
    ox: float, oy: float, oz: float, yaw: float, wall: Array, heights: Array, low: float,
    high: float, owner: int, most: float, reach: float, columns: _Columns, directions: Array,
) -> None:  # fmt: skip
    """Insert an upright plate into every column in which no nearer one, as low and high, hides it.

    A ray is there at a height between its origin's and that of what it would hit. Of plates at the
    same distance the first in the scene comes first, in whatever order they are inserted.

    Args:
        low, high: the part of its heights that rays reach, m.
        most: distance beyond which it is hidden in every column, m.
        directions: of `GridArrays`.
    """
    cos, sin = columns.cos, columns.sin
    hider, lows, highs = directions[2], directions[3], directions[4]
    px, py = wall[0] - ox, wall[1] - oy
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    length, square = 0.0, ex * ex + ey * ey
    share = min(1.0, max(0.0, -(px * ex + py * ey) / square)) if square > 0.0 else 0.0
    gx, gy, number = px + share * ex, py + share * ey, 0
    nearest = math.sqrt(gx * gx + gy * gy) * (1.0 - _BAND) if square > 0.0 else math.inf
    if nearest <= most:
        number = _covered_roughly(px, py, ex, ey, yaw, columns.azimuth, columns.runs)
    swept = px * ey - py * ex
    surely = abs(swept) * (1.0 - _BAND)
    for run in range(number):
        for c in range(columns.runs[run, 0], columns.runs[run, 1]):
            hides = lows[c] <= low and highs[c] >= high
            if hides and hider[c] < nearest:
                continue
            across = cos[c] * ey - sin[c] * ex
            if across == 0.0 or (hides and surely > hider[c] * abs(across)):
                continue
            t = swept / across
            s = (px * sin[c] - py * cos[c]) / across
            if t < 0.0 or t > reach or s < -OVERLAP or s > 1.0 + OVERLAP:
                continue
            if across * across <= PARALLEL * square:
                continue
            if length == 0.0:  # most plates are hidden
                length = math.hypot(ex, ey)
            _insert_before(
                columns, c, t, t, abs(across) / length, heights[0], heights[1], owner, owner
            )
            wider = low <= oz <= high and low <= lows[c] and high >= highs[c]
            if wider and (t < hider[c] or low < lows[c] or high > highs[c]):
                hider[c], lows[c], highs[c] = t, low, high


@kernel
def heights_of(z: float, grid: GridArrays, max_range: float) -> tuple[float, float]:
    """Return the range of heights of a grid's rays from a height ``z``, m."""
    longest = lowest = highest = 0.0
    for k in range(grid.slope_scale.shape[0]):
        longest = max(longest, abs(grid.slope_scale[k]))
    for k in range(grid.slope.shape[0]):
        lowest, highest = min(lowest, grid.slope[k]), max(highest, grid.slope[k])
    reach = longest * max_range
    return z + lowest * reach, z + highest * reach


@kernel
def meet(slope: float, oz: float, near: float, far: float, low: float, high: float) -> float:
    """Return the horizontal distance at which a ray meets an upright body; inf if it misses.

    The ray rises by ``slope`` per metre from the height ``oz``.
    """
    z = oz + slope * near
    if low <= z <= high:
        return near
    face = high if z > high else low
    if (z > high) == (slope < 0.0) and slope != 0.0:  # hits the top from above, or the reverse
        t = (face - oz) / slope
        if t <= far and far > near:
            return t
    return math.inf


@kernel
def cast_columns(
    x: float, y: float, z: float, yaw: float, max_range: float, floor: bool,
    azimuth: Array, cos: Array, sin: Array, slope: Array, slope_scale: Array, work: Array,
    filled: Indices, directions: Array, runs: Indices,
    walls: Array, wall_heights: Array, discs: Array, owner: Indices,
    order: Indices, bound: Array,
    distance: Array, incidence: Array, body: Indices,
) -> None:  # fmt: skip
    """Write the nearest hit of each ray of a grid.

    Args:
        x, y, z, yaw: origin and direction in the world frame, m and rad.
        max_range: m; farther hits do not count.
        floor: True if the floor z = 0 is hit.
        azimuth to runs: fields of `GridArrays`.
        walls to owner: fields of `Obstacles`.
        order, bound: (S,) the walls, nearest first, and lower bounds of their distances, m.
        distance: (R, C) result, m; inf without a hit.
        incidence: (R, C) result, angle to the normal, rad, 0 without a hit; or (0, 0).
        body: (R, C) result: owner, -(2 + index) for a wall, -1 for nothing and the floor; or (0,
            0).
    """
    grid = GridArrays(azimuth, cos, sin, slope, slope_scale, work, filled, directions, runs)
    lowest, highest = heights_of(z, grid, max_range)
    obstacles = Obstacles(walls, wall_heights, discs, owner)
    if floor:
        lowest = max(lowest, min(0.0, z))
    _fill_visible(x, y, z, yaw, lowest, highest, max_range, grid, obstacles, order, bound)
    wants_incidence, wants_body = incidence.shape[0] > 0, body.shape[0] > 0
    for r in range(slope.shape[0]):
        for c in range(azimuth.shape[0]):
            climb = slope[r] * slope_scale[c]
            best, hit = -z / climb if floor and climb < 0.0 else math.inf, -1
            for k in range(filled[c]):
                here = work[c, k]
                if here[NEAR] >= best:
                    break
                t = meet(climb, z, here[NEAR], here[FAR], here[LOW], here[HIGH])
                if t < best:
                    best, hit = t, k
            stretch = math.sqrt(1.0 + climb * climb)
            found = best * stretch <= max_range
            distance[r, c] = best * stretch if found else math.inf
            if wants_body:
                body[r, c] = int(work[c, hit, WHO]) if found and hit >= 0 else -1
            if wants_incidence:
                incidence[r, c] = 0.0
                if found and best > 0.0:
                    level = hit < 0 or best > work[c, hit, NEAR]  # the floor, a top or a bottom
                    cosine = (abs(climb) if level else work[c, hit, FACING]) / stretch
                    incidence[r, c] = math.acos(min(1.0, cosine))
