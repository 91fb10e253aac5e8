"""Project bodies to the image of a level pinhole camera.

Depth is measured along the optical axis: an upright face has one depth in all rows of a column.
Heights are here those over the camera, and rays to the left and up have positive slopes. Hits equal
those of `crowdbot.core.sensing.raycast_columns.cast_columns`, pixel by pixel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.ray_grid import OVERLAP, PARALLEL
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

Edges = NDArray[np.float32]
#: Depths in m, or whole millimetres.
Image = NDArray[np.float32] | NDArray[np.uint16]

#: Rows of a body in a column: its top is visible in the rows [UP, BEGIN), its face in [BEGIN, END)
#: and its bottom in [END, DOWN); as float32, which vectorises well.
UP, BEGIN, END, DOWN = range(4)
EDGE_ROWS = 4
#: Rows of `RenderPass.rays`, with a column per image column: direction in the world frame; depths
#: at which the ray enters and leaves a body, m; depth, bottom and top of the plate that hides what
#: is behind it, m.
RAY_X, RAY_Y, NEAR, FAR, HIDER, HIDER_LOW, HIDER_HIGH = range(7)
RAY_ROWS = 7
_ROOM = 1e-6  # m; closer points have no projection
_TOUCH = 1e-12  # m; depth of bodies around the camera
#: Whole millimetres that mark nothing in range, until an image is finished.
NOTHING = np.float32(65535.0)


class Lens(NamedTuple):
    """A pinhole camera and its measuring range.

    Attributes:
        focal: focal length, pixels.
        column, row: position of the optical axis in the image, pixels.
        nearest, farthest: measured depths, m.
        steps: steps per metre to which depth is rounded, or 0.
    """

    focal: float
    column: float
    row: float
    nearest: float
    farthest: float
    steps: float


class RenderPass(NamedTuple):
    """State of rendering one image of H rows and W columns.

    Attributes:
        lens: the camera's lens.
        slope: (H,) rise of the rows' rays per metre of depth, decreasing evenly.
        cos_azimuth: (W,) depth per metre over the floor, along each column.
        rays: (`RAY_ROWS`, W) directions of the columns, and scratch for one body.
        edges: (`EDGE_ROWS`, W) scratch: the rows of one body.
        faces: (W,) scratch: depths of its face, like the image.
        image: (H, W) the result.
    """

    lens: Lens
    slope: Array
    cos_azimuth: Array
    rays: Array
    edges: Edges
    faces: Image
    image: Image


@kernel
def depth_reading(depth: float, lens: Lens) -> np.float32:
    """Return the camera's reading of a depth: 0 if too near; inf, or `NOTHING`, if too far."""
    if lens.steps > 0.0:
        rounded = np.rint(np.float32(depth) * np.float32(lens.steps))
        if depth < lens.nearest:
            return np.float32(0.0)
        return rounded if depth <= lens.farthest else NOTHING
    if depth < lens.nearest:
        return np.float32(0.0)
    return np.float32(depth if depth <= lens.farthest else math.inf)


@kernel
def _between(right: float, left: float, lens: Lens, columns: int) -> tuple[int, int]:
    """Return columns whose rays go left by ``right`` to ``left`` per metre.

    One more on each side is included.
    """
    first = max(0.0, lens.column - lens.focal * left)
    last = min(columns - 1.0, lens.column - lens.focal * right + 1.0)
    return (int(first), int(last) + 1) if first <= last else (0, 0)


@kernel
def columns_of_disc(
    forward: float, left: float, r: float, lens: Lens, columns: int
) -> tuple[int, int]:
    """Return the first column that may hit an upright cylinder, and the one after the last.

    Args:
        forward, left: position of its axis from the camera, m.
    """
    if forward <= r + _ROOM:  # beside or around the camera
        return 0, columns
    middle, half = forward * left, r * math.sqrt(forward * forward + left * left - r * r)
    over = 1.0 / (forward * forward - r * r)
    return _between((middle - half) * over, (middle + half) * over, lens, columns)


@kernel
def columns_of_wall(
    forward0: float, left0: float, forward1: float, left1: float, lens: Lens, columns: int
) -> tuple[int, int]:
    """Return the first column that may hit an upright plate, and the one after the last."""
    if forward0 <= _ROOM or forward1 <= _ROOM:
        return 0, columns
    slope0, slope1 = left0 / forward0, left1 / forward1
    return _between(min(slope0, slope1), max(slope0, slope1), lens, columns)


@kernel
def cross_disc(
    px: float, py: float, r: float, first: int, last: int, rays: Array, cosines: Array
) -> None:
    """Write the depths at which the columns' rays enter and leave a cylinder; inf for a miss.

    Args:
        px, py: its axis, relative to the camera in world directions, m.
        first, last: first column, and the one after the last.
        rays, cosines: as in `RenderPass`.
    """
    cosine, dx, dy = cosines[first:last], rays[RAY_X, first:last], rays[RAY_Y, first:last]
    near, far = rays[NEAR, first:last], rays[FAR, first:last]
    for c in range(cosine.shape[0]):
        along = dx[c] * px + dy[c] * py
        across = dx[c] * py - dy[c] * px
        room = r * r - across * across
        half = math.sqrt(max(room, 0.0))
        hit = (room >= 0.0) & (along + half >= 0.0)
        near[c] = max(0.0, along - half) * cosine[c] if hit else math.inf
        far[c] = (along + half) * cosine[c]


@kernel
def cross_wall(
    px: float, py: float, ex: float, ey: float, first: int, last: int, rays: Array, cosines: Array
) -> None:
    """Write the depths at which the columns' rays meet an upright plate from p to p + e."""
    cosine, dx, dy = cosines[first:last], rays[RAY_X, first:last], rays[RAY_Y, first:last]
    near, far = rays[NEAR, first:last], rays[FAR, first:last]
    least = PARALLEL * (ex * ex + ey * ey)
    for c in range(cosine.shape[0]):
        across = dx[c] * ey - dy[c] * ex
        distance = (px * ey - py * ex) / across
        share = (px * dy[c] - py * dx[c]) / across
        hit = (distance >= 0.0) & (share >= -OVERLAP) & (share <= 1.0 + OVERLAP)
        hit &= across * across > least
        near[c] = far[c] = distance * cosine[c] if hit else math.inf


@kernel
def project_body(low: float, high: float, first: int, last: int, target: RenderPass) -> None:
    """Compute the rows of the columns [first, last) that show a body, and its face's depths.

    A ray of row r is at the depth d over a height h if r < horizon - h focal / d.

    Args:
        low, high: heights of the body, m.
        target: `rays` give its start and end; `edges` and `faces` are written.
    """
    lens, rays, edges = target.lens, target.rays, target.edges
    focal, horizon, rows = lens.focal, lens.row, float(target.slope.shape[0])
    near, far, face = rays[NEAR, first:last], rays[FAR, first:last], target.faces[first:last]
    up, begin = edges[UP, first:last], edges[BEGIN, first:last]
    end, down = edges[END, first:last], edges[DOWN, first:last]
    for c in range(near.shape[0]):
        hit = near[c] <= lens.farthest
        scale, behind = focal / max(near[c], _TOUCH), focal / max(far[c], _TOUCH)
        over, over_behind = np.ceil(horizon - high * scale), np.ceil(horizon - high * behind)
        under, under_behind = np.floor(horizon - low * scale), np.floor(horizon - low * behind)
        up[c] = min(max(over_behind, 0.0), rows) if hit else math.inf
        begin[c] = min(max(over, 0.0), rows) if hit else math.inf
        end[c] = min(max(under + 1.0, 0.0), rows) if hit else -math.inf
        down[c] = min(max(under_behind + 1.0, 0.0), rows) if hit else -math.inf
        face[c] = depth_reading(near[c], lens)
