"""Ray casting against vertical walls and solid upright cylinders, compiled.

Legs, trunks and pillars are solid cylinders: side, top and bottom can be hit. A wall is a vertical
plate without thickness, between its two heights. An origin inside a cylinder hits it at distance 0
with incidence 0, so that a body that touches or contains a sensor is never invisible.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.sensing.ray_grid import OVERLAP, PARALLEL
from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.types.arrays import Array


@kernel
def segment_gap(wall: Array, x: float, y: float) -> float:
    """Return the distance from a point to a segment, m."""
    dx, dy = from_segment(wall, x, y)
    return math.hypot(dx, dy)


@kernel
def from_segment(wall: Array, x: float, y: float) -> tuple[float, float]:
    """Return the vector from the nearest point of a segment to a point, m."""
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = x - wall[0], y - wall[1]
    square = ex * ex + ey * ey
    s = 0.0
    if square > 0.0:
        s = min(1.0, max(0.0, (px * ex + py * ey) / square))
    return px - s * ex, py - s * ey


@kernel
def _near_walls(walls: Array, x: float, y: float, max_range: float, out: NDArray[np.int64]) -> int:
    """Write the indices of the walls within range; return their number."""
    count = 0
    for i in range(walls.shape[0]):
        if segment_gap(walls[i], x, y) <= max_range:
            out[count] = i
            count += 1
    return count


@kernel
def _near_discs(
    discs: Array, x: float, y: float, max_range: float, gap: Array, out: NDArray[np.int64]
) -> int:
    """Write the cylinders within range, nearest surface first; return their number."""
    count = 0
    for i in range(discs.shape[0]):
        g = math.hypot(discs[i, X] - x, discs[i, Y] - y) - discs[i, RADIUS]
        if g <= max_range:
            gap[count] = g
            out[count] = i
            count += 1
    # Equal gaps are ordered by index, so the sort need not be stable.
    for at in range(1, count):
        g, i = gap[at], out[at]
        j = at
        while j > 0 and gap[j - 1] > g:
            gap[j], out[j] = gap[j - 1], out[j - 1]
            j -= 1
        gap[j], out[j] = g, i
    return count


@kernel
def hit_wall(wall: Array, heights: Array, o: Array, dx: float, dy: float, dz: float) -> float:
    """Return the distance of one ray to one wall; inf if it misses."""
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = wall[0] - o[0], wall[1] - o[1]
    across = dx * ey - dy * ex
    if across * across <= PARALLEL * (ex * ex + ey * ey) * (dx * dx + dy * dy):
        return math.inf
    t = (px * ey - py * ex) / across
    s = (px * dy - py * dx) / across
    z = o[2] + t * dz
    if t < 0.0 or s < -OVERLAP or s > 1.0 + OVERLAP or z < heights[0] or z > heights[1]:
        return math.inf
    return float(t)


@kernel
def wall_incidence(wall: Array, dx: float, dy: float) -> float:
    """Return the angle between a ray and the normal of a wall that it hits."""
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    return math.acos(min(1.0, abs(dx * ey - dy * ex) / math.hypot(ex, ey)))


@kernel
def hit_cylinder(
    px: float,
    py: float,
    r: float,
    bottom: float,
    height: float,
    oz: float,
    dx: float,
    dy: float,
    dz: float,
) -> tuple[float, bool]:
    """Return the distance of one ray to one solid cylinder, and True for its side.

    Inf if it misses.

    The axis is at (px, py) from the origin of the ray, which is ``oz`` above the floor.
    """
    flat = dx * dx + dy * dy
    side = dx * py - dy * px
    room = r * r * flat - side * side
    if room < 0.0:
        return math.inf, False
    enter, leave = -math.inf, math.inf
    if flat > 0.0:
        along, half = dx * px + dy * py, math.sqrt(room)
        enter, leave = (along - half) / flat, (along + half) / flat
    elif px * px + py * py > r * r:
        return math.inf, False
    lateral = True
    if dz != 0.0:
        floor, top = (bottom - oz) / dz, (height - oz) / dz
        low, high = min(floor, top), max(floor, top)
        if low > enter:
            enter, lateral = low, False
        leave = min(leave, high)
    elif oz < bottom or oz > height:
        return math.inf, False
    if leave < 0.0 or enter > leave:
        return math.inf, False
    return max(enter, 0.0), lateral  # 0: the origin is inside or on the surface


@kernel
def cylinder_incidence(
    px: float, py: float, r: float, t: float, lateral: bool, dx: float, dy: float, dz: float
) -> float:
    """Return the angle between a ray and the normal of a cylinder hit at distance ``t``."""
    if t <= 0.0:
        return 0.0
    cosine = abs(dz)
    if lateral:
        cosine = abs(dx * (t * dx - px) + dy * (t * dy - py)) / r
    return math.acos(min(1.0, cosine))


@kernel
def _centre(discs: Array, near: NDArray[np.int64], count: int, o: Array, out: Array) -> None:
    """Write position from the origin and radius of the first ``count`` near discs."""
    for j in range(count):
        i = near[j]
        out[j, 0], out[j, 1], out[j, 2] = discs[i, X] - o[0], discs[i, Y] - o[1], discs[i, RADIUS]


@kernel
def _first_wall(
    walls: Array,
    heights: Array,
    near: NDArray[np.int64],
    count: int,
    o: Array,
    dx: float,
    dy: float,
    dz: float,
) -> tuple[float, int]:
    """Return the distance to the first near wall that a ray hits, and -2 minus its number."""
    best, hit = math.inf, -1
    for j in range(count):
        i = near[j]
        t = hit_wall(walls[i], heights[i], o, dx, dy, dz)
        if t < best:
            best, hit = t, -(2 + i)
    return best, hit


@kernel
def _first_disc(
    discs: Array,
    near: NDArray[np.int64],
    count: int,
    gap: Array,
    centred: Array,
    best: float,
    oz: float,
    dx: float,
    dy: float,
    dz: float,
) -> tuple[float, int, bool]:
    """Return the distance to the first near disc hit before ``best``, its place, and the side.

    Args:
        discs, near, count, gap: all discs; numbers of the near ones, nearest first; how many there
            are; distances to these.
        centred: position from the origin and radius of the near ones.
        best: distance of the nearest hit so far, m.
        oz: height of the origin, m.
        dx, dy, dz: unit vector of the ray.

    Returns:
        the distance, the place among the near discs or -1, and True for a hit of the lateral
        surface.
    """
    winner, side_hit = -1, False
    for j in range(count):
        if gap[j] > best:
            break
        px, py, r = centred[j, 0], centred[j, 1], centred[j, 2]
        side = dx * py - dy * px
        if side * side > r * r:  # quick test: passes beside it
            continue
        i = near[j]
        t, lateral = hit_cylinder(px, py, r, discs[i, BOTTOM], discs[i, TOP], oz, dx, dy, dz)
        if t < best:
            best, winner, side_hit = t, j, lateral
    return best, winner, side_hit


@array_kernel
def cast_rays(
    origins: Array,
    directions: Array,
    max_range: float,
    walls: Array,
    wall_heights: Array,
    discs: Array,
    owner: NDArray[np.int64],
) -> tuple[Array, Array, NDArray[np.int64]]:
    """Return the nearest hit of each ray; see `crowdbot.core.sensing.scene.Scene.cast`.

    Bodies out of range are excluded once per sequence of equal origins, and cylinders are tried
    nearest first, so that a ray stops once no later one can be nearer. Angles are computed for the
    nearest hit alone.
    """
    rays = origins.shape[0]
    distance = np.full(rays, np.inf)
    incidence = np.zeros(rays)
    body = np.full(rays, -1, dtype=np.int64)
    near_wall = np.empty(walls.shape[0], dtype=np.int64)
    near = np.empty(discs.shape[0], dtype=np.int64)
    gap = np.empty(discs.shape[0])
    disc = np.empty((discs.shape[0], 3))  # of near ones: position from the origin, radius
    wall_count = disc_count = 0
    for k in range(rays):
        o = origins[k]
        # Heights do not matter here.
        if k == 0 or o[0] != origins[k - 1, 0] or o[1] != origins[k - 1, 1]:
            wall_count = _near_walls(walls, o[0], o[1], max_range, near_wall)
            disc_count = _near_discs(discs, o[0], o[1], max_range, gap, near)
            _centre(discs, near, disc_count, o, disc)
        dx, dy, dz = directions[k, 0], directions[k, 1], directions[k, 2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        dx, dy, dz = dx / length, dy / length, dz / length
        best, hit = _first_wall(walls, wall_heights, near_wall, wall_count, o, dx, dy, dz)
        best, winner, side_hit = _first_disc(
            discs, near, disc_count, gap, disc, best, o[2], dx, dy, dz
        )
        if best > max_range:
            continue
        distance[k] = best
        if winner >= 0:
            px, py, r = disc[winner, 0], disc[winner, 1], disc[winner, 2]
            body[k] = owner[near[winner]]
            incidence[k] = cylinder_incidence(px, py, r, best, side_hit, dx, dy, dz)
        else:
            body[k], incidence[k] = hit, wall_incidence(walls[-2 - hit], dx, dy)
    return distance, incidence, body
