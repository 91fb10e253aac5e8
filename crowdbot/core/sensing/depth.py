"""Depth images, rendered body by body.

The floor and the tops and bottoms of bodies have a constant depth per row, an upright face has a
constant depth per column. So the image of a body consists of a face, a top and a bottom, each a
range of rows in every column, and the smallest depth wins in each pixel.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.sensing.projection import (
    BEGIN,
    DOWN,
    END,
    HIDER,
    HIDER_HIGH,
    HIDER_LOW,
    NEAR,
    NOTHING,
    RAY_X,
    RAY_Y,
    UP,
    Edges,
    Image,
    Lens,
    RenderPass,
    columns_of_disc,
    columns_of_wall,
    cross_disc,
    cross_wall,
    depth_reading,
    project_body,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices


@kernel
def _range(edge: Edges, rows: int) -> tuple[int, int]:
    """Return the smallest and largest row of an edge, in columns where the body is visible."""
    least, greatest = np.float32(rows), np.float32(0.0)
    for row in edge:
        if np.float32(0.0) <= row <= np.float32(rows):
            least, greatest = min(least, row), max(greatest, row)
    return int(least), int(greatest)


@kernel
def _render_face(rows: tuple[int, int], columns: tuple[int, int], target: RenderPass) -> None:
    """Render a face into rows, some of which it covers only in some columns."""
    left, right = columns
    face = target.faces[left:right]
    begin, end = target.edges[BEGIN, left:right], target.edges[END, left:right]
    for r in range(*rows):
        row, line = np.float32(r), target.image[r, left:right]
        for c in range(line.shape[0]):
            shows = (begin[c] <= row) & (row < end[c]) & (face[c] < line[c])
            line[c] = face[c] if shows else line[c]


@kernel
def _render_full_face(rows: tuple[int, int], columns: tuple[int, int], target: RenderPass) -> None:
    """Render a face into rows that it covers in all its columns."""
    left, right = columns
    face = target.faces[left:right]
    for r in range(*rows):
        line = target.image[r, left:right]
        for c in range(line.shape[0]):
            line[c] = face[c] if face[c] < line[c] else line[c]


@kernel
def _render_level(
    height: float,
    between: tuple[int, int],
    rows: tuple[int, int],
    columns: tuple[int, int],
    target: RenderPass,
) -> None:
    """Render a top or a bottom at a height, from one edge to another."""
    left, right = columns
    image = target.image
    begin, end = target.edges[between[0], left:right], target.edges[between[1], left:right]
    for r in range(*rows):
        row, line = np.float32(r), image[r, left:right]
        depth = image.dtype.type(depth_reading(height / target.slope[r], target.lens))
        for c in range(line.shape[0]):
            shows = (begin[c] <= row) & (row < end[c]) & (depth < line[c])
            line[c] = depth if shows else line[c]


@kernel
def _render_body(low: float, high: float, first: int, last: int, target: RenderPass) -> None:
    """Render a body in the columns [first, last), where nothing nearer is."""
    project_body(low, high, first, last, target)
    columns, edges, rows = (first, last), target.edges, target.slope.shape[0]
    first_begin, last_begin = _range(edges[BEGIN, first:last], rows)
    first_end, last_end = _range(edges[END, first:last], rows)
    if first_begin > last_begin:  # it is not visible
        return
    if high < 0.0:  # otherwise the camera does not see the top
        top, _ = _range(edges[UP, first:last], rows)
        _render_level(high, (UP, BEGIN), (top, last_begin), columns, target)
    if low > 0.0:
        _, bottom = _range(edges[DOWN, first:last], rows)
        _render_level(low, (END, DOWN), (first_end, bottom), columns, target)
    if last_begin < first_end:
        _render_face((first_begin, last_begin), columns, target)
        _render_full_face((last_begin, first_end), columns, target)
        _render_face((first_end, last_end), columns, target)
    else:
        _render_face((first_begin, last_end), columns, target)


@kernel
def _in_view(low: float, high: float, slope: Array, farthest: float) -> bool:
    """Return True if a body intersects the range of heights of the rays."""
    lowest, highest = min(0.0, slope[slope.shape[0] - 1]), max(0.0, slope[0])
    return bool(low <= highest * farthest and high >= lowest * farthest)


@kernel
def _is_hidden(low: float, high: float, first: int, last: int, rays: Array) -> bool:
    """Return True if nearer plates, as low and as high, hide a plate in the columns [first, last).

    A ray is there at a height between the camera's, 0, and that of what it would hit.
    """
    near, hider = rays[NEAR, first:last], rays[HIDER, first:last]
    lows, highs = rays[HIDER_LOW, first:last], rays[HIDER_HIGH, first:last]
    for c in range(near.shape[0]):
        if near[c] < hider[c] or (near[c] < math.inf and (low < lows[c] or high > highs[c])):
            return False
    return True


@kernel
def _hide_behind(low: float, high: float, first: int, last: int, rays: Array) -> None:
    """Record that a plate hides what is behind it, where it is nearer than the hider so far."""
    near, hider = rays[NEAR, first:last], rays[HIDER, first:last]
    lows, highs = rays[HIDER_LOW, first:last], rays[HIDER_HIGH, first:last]
    for c in range(near.shape[0]):
        wider = low <= lows[c] and high >= highs[c]
        if near[c] < math.inf and (near[c] < hider[c] or hider[c] == math.inf) and wider:
            hider[c], lows[c], highs[c] = near[c], low, high


@kernel
def _render_walls(
    x: float, y: float, z: float, cos_yaw: float, sin_yaw: float, walls: Array, heights: Array,
    order: Indices, target: RenderPass,
) -> None:  # fmt: skip
    """Render upright plates, seen from a camera at (x, y, z), that nearer ones do not hide.

    Args:
        order: (S,) the plates, about nearest first.
    """
    lens, cosines, rays = target.lens, target.cos_azimuth, target.rays
    for i in order:
        px, py, qx, qy = walls[i, 0] - x, walls[i, 1] - y, walls[i, 2] - x, walls[i, 3] - y
        forward0, forward1 = cos_yaw * px + sin_yaw * py, cos_yaw * qx + sin_yaw * qy
        if max(forward0, forward1) < 0.0 or min(forward0, forward1) > lens.farthest:
            continue
        low, high = heights[i, 0] - z, heights[i, 1] - z
        if not _in_view(low, high, target.slope, lens.farthest):
            continue
        left0, left1 = cos_yaw * py - sin_yaw * px, cos_yaw * qy - sin_yaw * qx
        first, last = columns_of_wall(forward0, left0, forward1, left1, lens, cosines.shape[0])
        cross_wall(px, py, qx - px, qy - py, first, last, rays, cosines)
        if _is_hidden(low, high, first, last, rays):
            continue
        _render_body(low, high, first, last, target)
        if low <= 0.0 <= high:
            _hide_behind(low, high, first, last, rays)


@kernel
def _render_discs(
    x: float, y: float, z: float, cos_yaw: float, sin_yaw: float, discs: Array, target: RenderPass
) -> None:
    """Render upright cylinders, seen from a camera at (x, y, z)."""
    lens, cosines, rays = target.lens, target.cos_azimuth, target.rays
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        forward = cos_yaw * px + sin_yaw * py
        # Most are out of view, and absent people are at infinity.
        if not -r < forward < lens.farthest + r:
            continue
        low, high = discs[i, BOTTOM] - z, discs[i, TOP] - z
        if not _in_view(low, high, target.slope, lens.farthest):
            continue
        left = cos_yaw * py - sin_yaw * px
        first, last = columns_of_disc(forward, left, r, lens, cosines.shape[0])
        if first < last:
            cross_disc(px, py, r, first, last, rays, cosines)
            _render_body(low, high, first, last, target)


@kernel
def _finish(image: Image) -> None:
    """Replace the marker for nothing in range by 0."""
    nothing, zero = image.dtype.type(NOTHING), image.dtype.type(0)
    for r in range(image.shape[0]):
        line = image[r]
        for c in range(line.shape[0]):
            line[c] = zero if line[c] == nothing else line[c]


@kernel
def render_depth(
    x: float, y: float, z: float, yaw: float,
    focal: float, column: float, row: float, nearest: float, farthest: float, steps: float,
    slope: Array, cos_azimuth: Array, cos: Array, sin: Array,
    walls: Array, wall_heights: Array, order: Indices, discs: Array,
    rays: Array, edges: Edges, faces: Image, image: Image,
) -> None:  # fmt: skip
    """Render depth along the axis of a level camera: 0 if too near, inf if nothing is in range.

    The floor z = 0 is visible. In images of whole numbers, 0 stands for both.

    Args:
        x, y, z, yaw: camera in the world frame, m and rad.
        focal to steps: fields of `Lens`.
        slope, cos_azimuth: (H,), (W,) as in `RenderPass`.
        cos, sin: (W,) of the columns' azimuths.
        walls, wall_heights, discs: (S, 4), (S, 2), (D, 5) as in
            `crowdbot.core.sensing.ray_grid.Obstacles`.
        order: (S,) the walls, about nearest first.
        rays, edges, faces: scratch as in `RenderPass`.
        image: (H, W) result; whole numbers only if the lens has steps.
    """
    lens = Lens(focal, column, row, nearest, farthest, steps)
    target = RenderPass(lens, slope, cos_azimuth, rays, edges, faces, image)
    for r in range(slope.shape[0]):
        image[r] = depth_reading(-z / slope[r] if slope[r] < 0.0 else math.inf, lens)
    cos_yaw, sin_yaw = math.cos(yaw), math.sin(yaw)
    for c in range(cos.shape[0]):
        rays[RAY_X, c] = cos_yaw * cos[c] - sin_yaw * sin[c]
        rays[RAY_Y, c] = sin_yaw * cos[c] + cos_yaw * sin[c]
        rays[HIDER, c], rays[HIDER_LOW, c], rays[HIDER_HIGH, c] = math.inf, 0.0, 0.0
    _render_walls(x, y, z, cos_yaw, sin_yaw, walls, wall_heights, order, target)
    _render_discs(x, y, z, cos_yaw, sin_yaw, discs, target)
    if steps > 0.0:
        _finish(image)
