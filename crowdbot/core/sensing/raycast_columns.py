"""Ray casting by columns, compiled: fans of level rays, layered lidars, depth images.

All rays of a column share one horizontal direction, so each upright body is met once for all of
them; columns follow each other by azimuth, so each body is tried only for those that it can cover.
The distances are those of `crowdbot.core.sensing.raycast.cast_rays`, ray by ray.
"""

from __future__ import annotations

import math

from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.sensing.ray_columns import (
    RayColumns,
    add_disc,
    add_wall,
    covered_roughly,
    insert_before,
    reached,
)
from crowdbot.core.sensing.ray_grid import (
    FACING,
    FAR,
    HIGH,
    LOW,
    NEAR,
    OVERLAP,
    OWNER,
    PARALLEL,
    GridArrays,
    Obstacles,
)
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

_BAND = 1e-9  # relative, of squared distances; nearer to a limit the exact distance decides
#: Number of walls after which the farthest visible distance is found again.
_OFTEN = 16


@kernel
def _turned(grid: GridArrays, yaw: float) -> RayColumns:
    """Return the empty columns of a grid, turned by its yaw in the world frame, rad."""
    c0, s0 = math.cos(yaw), math.sin(yaw)
    world_cos, world_sin, filled = grid.directions[0], grid.directions[1], grid.filled
    for c in range(grid.azimuth.shape[0]):
        world_cos[c] = c0 * grid.cos[c] - s0 * grid.sin[c]
        world_sin[c] = s0 * grid.cos[c] + c0 * grid.sin[c]
        filled[c] = 0
    return RayColumns(grid.azimuth, world_cos, world_sin, grid.work, filled, grid.runs)


@kernel
def _add_discs(
    x: float, y: float, yaw: float, lowest: float, highest: float, max_range: float,
    discs: Array, owner: Indices, columns: RayColumns,
) -> None:  # fmt: skip
    """Insert all cylinders between two heights within range."""
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        bottom, top = discs[i, BOTTOM], discs[i, TOP]
        if not (bottom <= highest and top >= lowest):
            continue
        far = max_range + r  # most are excluded here, before any call
        if abs(px) <= far and abs(py) <= far and reached(px, py, r, max_range):
            add_disc(px, py, r, bottom, top, yaw, owner[i], columns)


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
            add_wall(x, y, yaw, walls[i], heights[i], -(2 + i), max_range, columns)
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
    high: float, owner: int, most: float, reach: float, columns: RayColumns, directions: Array,
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
        number = covered_roughly(px, py, ex, ey, yaw, columns.azimuth, columns.runs)
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
            insert_before(
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
                body[r, c] = int(work[c, hit, OWNER]) if found and hit >= 0 else -1
            if wants_incidence:
                incidence[r, c] = 0.0
                if found and best > 0.0:
                    level = hit < 0 or best > work[c, hit, NEAR]  # the floor, a top or a bottom
                    cosine = (abs(climb) if level else work[c, hit, FACING]) / stretch
                    incidence[r, c] = math.acos(min(1.0, cosine))
