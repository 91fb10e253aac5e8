"""Ray casting for sensors with roll or pitch; their rays also hit the floor.

Level sensors use faster methods, in which the rays of a column share one direction seen from above
(`crowdbot.core.sensing.raycast_columns`, `crowdbot.core.sensing.depth`). Here every ray has its own
direction. Seen from above a body covers a sector; the circle is divided into `_BINS`, each with a
list of its bodies, nearest first, and a ray tries those of its bin. Hits equal those of
`crowdbot.core.sensing.raycast.cast_rays`, plus the floor.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.sensing.ray_grid import RayGrid
from crowdbot.core.sensing.raycast import (
    cylinder_incidence,
    hit_cylinder,
    hit_wall,
    segment_gap,
    wall_incidence,
)
from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.types.arrays import Array

Indices = NDArray[np.int64]
#: The rotation of a level sensor.
NO_RAYS: Array = np.zeros((0, 3))
_BINS = 720
_WIDTH = 2.0 * math.pi / _BINS
_ON_IT = 1e-6  # m; a wall through the sensor may be hit in every direction


def grid_rays(grid: RayGrid) -> Array:
    """Return the directions (R * C, 3) of a grid's rays, row by row, in its own frame; length 1."""
    azimuth, slope, scale = grid.azimuth, grid.slope, grid.slope_scale
    rays = np.empty((*grid.shape, 3))
    rays[..., 0], rays[..., 1] = np.cos(azimuth), np.sin(azimuth)
    rays[..., 2] = slope[:, np.newaxis] * scale
    flat: Array = rays.reshape(-1, 3)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    return flat


@kernel
def _bins_of(px: float, py: float, qx: float, qy: float, r: float) -> tuple[int, int]:
    """Return first bin and number of bins of a body with the ends p and q, seen from above.

    Args:
        r: radius of a cylinder around p, which equals q; -1 for a wall.
    """
    if r >= 0.0:
        away = math.hypot(px, py)
        if away <= r * (1.0 + 1e-9):
            return 0, _BINS
        half = math.asin(r / away)
        begin, span = math.atan2(py, px) - half, 2.0 * half
    else:
        begin = math.atan2(py, px)
        turn = math.atan2(qy, qx) - begin  # a wall covers less than half a turn
        if turn > math.pi:
            turn -= 2.0 * math.pi
        elif turn < -math.pi:
            turn += 2.0 * math.pi
        span = abs(turn)
        if turn < 0.0:
            begin += turn
    first = math.floor((begin + math.pi) / _WIDTH) - 1
    return first, min(_BINS, math.floor(span / _WIDTH) + 4)


@array_kernel
def _sort_bodies(
    x: float, y: float, max_range: float, walls: Array, discs: Array
) -> tuple[Indices, Array]:
    """Return the numbers of bodies in range, nearest first, and the gaps (m) to all bodies.

    Cylinders are numbered after the walls, from ``len(walls)`` on.
    """
    count = walls.shape[0]
    gap = np.full(count + discs.shape[0], math.inf)
    for i in range(count):
        gap[i] = segment_gap(walls[i], x, y)
    for i in range(discs.shape[0]):
        gap[count + i] = math.hypot(discs[i, X] - x, discs[i, Y] - y) - discs[i, RADIUS]
    near = np.flatnonzero(gap <= max_range)
    order = near[np.argsort(gap[near], kind="mergesort")]
    return order, gap


@array_kernel
def _fill_bins(
    x: float, y: float, walls: Array, discs: Array, order: Indices, gap: Array
) -> tuple[Indices, Indices]:
    """Return the start of each bin's bodies in a list (`_BINS` + 1,), and the list."""
    cover = np.empty((order.shape[0], 2), np.int64)
    begin = np.zeros(_BINS + 1, np.int64)
    for j in range(order.shape[0]):
        i = order[j]
        if i >= walls.shape[0]:
            disc = discs[i - walls.shape[0]]
            px, py = disc[X] - x, disc[Y] - y
            cover[j] = _bins_of(px, py, px, py, disc[RADIUS])
        elif gap[i] <= _ON_IT:
            cover[j] = (0, _BINS)
        else:
            w = walls[i]
            cover[j] = _bins_of(w[0] - x, w[1] - y, w[2] - x, w[3] - y, -1.0)
        for k in range(cover[j, 1]):
            begin[(cover[j, 0] + k) % _BINS + 1] += 1
    for b in range(_BINS):
        begin[b + 1] += begin[b]
    members, filled = np.empty(begin[_BINS], np.int64), begin[:_BINS].copy()
    for j in range(order.shape[0]):
        for k in range(cover[j, 1]):
            b = (cover[j, 0] + k) % _BINS
            members[filled[b]] = order[j]
            filled[b] += 1
    return begin, members


@array_kernel
def cast_tilted_rays(
    x: float, y: float, z: float, turn: Array, rays: Array, max_range: float,
    walls: Array, wall_heights: Array, discs: Array, owner: Indices,
    distance: Array, incidence: Array, body: Indices,
) -> None:  # fmt: skip
    """Write the nearest hit of each ray, see `crowdbot.core.sensing.scene.Scene.cast_tilted`.

    ``distance`` (N,) must start as inf, ``incidence`` (N,) as 0, ``body`` (N,) as -1.
    """
    order, gap = _sort_bodies(x, y, max_range, walls, discs)
    begin, members = _fill_bins(x, y, walls, discs, order, gap)
    o, many = np.array((x, y, z)), walls.shape[0]
    for k in range(rays.shape[0]):
        u, v, w = rays[k, 0], rays[k, 1], rays[k, 2]
        dx = turn[0, 0] * u + turn[0, 1] * v + turn[0, 2] * w
        dy = turn[1, 0] * u + turn[1, 1] * v + turn[1, 2] * w
        dz = turn[2, 0] * u + turn[2, 1] * v + turn[2, 2] * w
        b = int((math.atan2(dy, dx) + math.pi) / _WIDTH) % _BINS
        best, hit, on_side = math.inf, -1, False
        if dz < 0.0:
            best = -max(z, 0.0) / dz
        for m in range(begin[b], begin[b + 1]):
            i = members[m]
            if gap[i] > best:
                break
            if i < many:
                t, lateral = hit_wall(walls[i], wall_heights[i], o, dx, dy, dz), True
            else:
                d = discs[i - many]
                px, py, r = d[X] - x, d[Y] - y, d[RADIUS]
                side = dx * py - dy * px
                if side * side > r * r * (dx * dx + dy * dy):  # quick test: passes beside it
                    continue
                t, lateral = hit_cylinder(px, py, r, d[BOTTOM], d[TOP], z, dx, dy, dz)
            if t < best:
                best, hit, on_side = t, i, lateral
        if best > max_range:
            continue
        distance[k] = best
        if hit < 0:
            incidence[k] = math.acos(min(1.0, -dz))
        elif hit < many:
            body[k], incidence[k] = -(2 + hit), wall_incidence(walls[hit], dx, dy)
        else:
            d = discs[hit - many]
            body[k] = owner[hit - many]
            incidence[k] = cylinder_incidence(
                d[X] - x, d[Y] - y, d[RADIUS], best, on_side, dx, dy, dz
            )
