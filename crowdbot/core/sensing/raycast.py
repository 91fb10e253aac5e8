"""Ray casting against vertical walls and solid upright cylinders, compiled.

A person is a solid cylinder from the floor to its height: side, top and bottom can be hit. A
wall is a vertical plate without thickness, between its two heights. An origin inside a cylinder
hits it at distance 0 with incidence 0, so that a body that touches or swallows a sensor never
becomes invisible to it.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Ends of a wall are longer by this fraction, so that no ray slips through a corner.
_OVERLAP = 1e-9


@numba.njit(cache=True, error_model="numpy")
def _segment_gap(wall: Array, x: float, y: float) -> float:
    """Distance from a point to a segment, m."""
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = x - wall[0], y - wall[1]
    square = ex * ex + ey * ey
    s = 0.0
    if square > 0.0:
        s = min(1.0, max(0.0, (px * ex + py * ey) / square))
    return math.hypot(px - s * ex, py - s * ey)


@numba.njit(cache=True, error_model="numpy")
def _near_walls(walls: Array, x: float, y: float, max_range: float, out: NDArray[np.int64]) -> int:
    """Write the indices of the walls within range; return how many there are."""
    count = 0
    for i in range(walls.shape[0]):
        if _segment_gap(walls[i], x, y) <= max_range:
            out[count] = i
            count += 1
    return count


@numba.njit(cache=True, error_model="numpy")
def _near_people(
    people: Array,
    present: NDArray[np.bool_],
    radius: Array,
    x: float,
    y: float,
    max_range: float,
    gap: Array,
    out: NDArray[np.int64],
) -> int:
    """Write the present people within range, nearest surface first; return how many there are."""
    count = 0
    for i in range(people.shape[0]):
        if not present[i]:
            continue
        g = math.hypot(people[i, 0] - x, people[i, 1] - y) - radius[i]
        if g <= max_range:
            gap[count] = g
            out[count] = i
            count += 1
    # Equal gaps are ordered by index, so that the sort needs not be stable.
    for at in range(1, count):
        g, i = gap[at], out[at]
        j = at
        while j > 0 and gap[j - 1] > g:
            gap[j], out[j] = gap[j - 1], out[j - 1]
            j -= 1
        gap[j], out[j] = g, i
    return count


@numba.njit(cache=True, error_model="numpy")
def _hit_wall(
    wall: Array, heights: Array, o: Array, dx: float, dy: float, dz: float
) -> tuple[float, float]:
    """Distance and incidence of one ray on one wall; distance inf if it misses."""
    ex, ey = wall[2] - wall[0], wall[3] - wall[1]
    px, py = wall[0] - o[0], wall[1] - o[1]
    across = dx * ey - dy * ex
    if across == 0.0:  # parallel, or a wall without length
        return math.inf, 0.0
    t = (px * ey - py * ex) / across
    s = (px * dy - py * dx) / across
    z = o[2] + t * dz
    if t < 0.0 or s < -_OVERLAP or s > 1.0 + _OVERLAP or z < heights[0] or z > heights[1]:
        return math.inf, 0.0
    return t, math.acos(min(1.0, abs(across) / math.hypot(ex, ey)))


@numba.njit(cache=True, error_model="numpy")
def _hit_cylinder(
    cx: float, cy: float, r: float, height: float, o: Array, dx: float, dy: float, dz: float
) -> tuple[float, float]:
    """Distance and incidence of one ray on one solid cylinder; distance inf if it misses."""
    px, py = cx - o[0], cy - o[1]
    flat = dx * dx + dy * dy
    side = dx * py - dy * px
    room = r * r * flat - side * side
    if room < 0.0:
        return math.inf, 0.0
    enter, leave = -math.inf, math.inf
    if flat > 0.0:
        along, half = dx * px + dy * py, math.sqrt(room)
        enter, leave = (along - half) / flat, (along + half) / flat
    elif px * px + py * py > r * r:
        return math.inf, 0.0
    lateral = True
    if dz != 0.0:
        floor, top = -o[2] / dz, (height - o[2]) / dz
        low, high = min(floor, top), max(floor, top)
        if low > enter:
            enter, lateral = low, False
        leave = min(leave, high)
    elif o[2] < 0.0 or o[2] > height:
        return math.inf, 0.0
    if leave < 0.0 or enter > leave:
        return math.inf, 0.0
    if enter <= 0.0:  # the origin is inside or on the surface
        return 0.0, 0.0
    cosine = abs(dz)
    if lateral:
        cosine = abs(dx * (enter * dx - px) + dy * (enter * dy - py)) / r
    return enter, math.acos(min(1.0, cosine))


@numba.njit(cache=True, error_model="numpy")
def cast_rays(
    origins: Array,
    directions: Array,
    max_range: float,
    walls: Array,
    wall_heights: Array,
    people: Array,
    present: NDArray[np.bool_],
    radius: Array,
    height: Array,
) -> tuple[Array, Array, NDArray[np.int64]]:
    """Nearest hit of each ray; see `crowdbot.core.sensing.scene.Scene.cast`.

    Bodies out of range are sorted out once per run of equal origins, and people are tried from
    the nearest to the farthest, so that a ray stops at the first that no later one can beat.
    """
    rays = origins.shape[0]
    distance = np.full(rays, np.inf)
    incidence = np.zeros(rays)
    body = np.full(rays, -1, dtype=np.int64)
    near_wall = np.empty(walls.shape[0], dtype=np.int64)
    near = np.empty(people.shape[0], dtype=np.int64)
    gap = np.empty(people.shape[0])
    wall_count = people_count = 0
    for k in range(rays):
        o = origins[k]
        if k == 0 or (
            o[0] != origins[k - 1, 0] or o[1] != origins[k - 1, 1]
        ):  # heights do not matter to what is near
            wall_count = _near_walls(walls, o[0], o[1], max_range, near_wall)
            people_count = _near_people(people, present, radius, o[0], o[1], max_range, gap, near)
        dx, dy, dz = directions[k, 0], directions[k, 1], directions[k, 2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        dx, dy, dz = dx / length, dy / length, dz / length
        best, angle, hit = math.inf, 0.0, -1
        for j in range(wall_count):
            i = near_wall[j]
            t, a = _hit_wall(walls[i], wall_heights[i], o, dx, dy, dz)
            if t < best:
                best, angle, hit = t, a, -(2 + i)
        for j in range(people_count):
            if gap[j] > best:
                break
            i = near[j]
            side = dx * (people[i, 1] - o[1]) - dy * (people[i, 0] - o[0])
            if side * side > radius[i] * radius[i]:  # quick: passes beside it
                continue
            t, a = _hit_cylinder(people[i, 0], people[i, 1], radius[i], height[i], o, dx, dy, dz)
            if t < best:
                best, angle, hit = t, a, i
        if best <= max_range:
            distance[k], incidence[k], body[k] = best, angle, hit
    return distance, incidence, body
