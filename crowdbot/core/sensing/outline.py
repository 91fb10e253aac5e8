"""Where bodies show in the image of a level pinhole camera.

Depth is measured along the optical axis: an upright face has one depth in all rows of a column.
Heights are here those over the camera, and rays to the left and up have positive slopes. What is
hit is what `crowdbot.core.sensing.columns.cast_columns` hits, pixel by pixel.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.columns import OVERLAP

Array = NDArray[np.float64]
Edges = NDArray[np.float32]
#: Depths in m, or whole millimetres.
Image = NDArray[np.float32] | NDArray[np.uint16]
#: Focal length, column and row of the axis, pixels; nearest and farthest depth measured, m;
#: steps per metre to which depth is rounded, or 0.
Lens = tuple[float, float, float, float, float, float]

#: What is known of a body in a column: its top shows in the rows [UP, BEGIN), its face in
#: [BEGIN, END) and its bottom in [END, DOWN); as float32, which the processor compares several at
#: once.
UP, BEGIN, END, DOWN = range(4)
EDGES = 4
#: Scratch per column: direction ahead and to the left in the world, where a body begins and ends.
AHEAD, ASIDE, NEAR, FAR = range(4)
WAYS = 4
FARTHEST, STEPS = 4, 5  # of a lens
_ROOM = 1e-6  # m; what is so close before the camera has no projection
_TOUCH = 1e-12  # m; depths of bodies around the camera
#: Whole millimetres that stand for nothing in reach, until an image is finished.
NOTHING = np.float32(65535.0)


@kernel
def measured(depth: float, lens: Lens) -> np.float32:
    """A depth as the camera gives it: 0 for too near, inf, or `NOTHING`, for too far."""
    _, _, _, nearest, farthest, steps = lens
    if steps > 0.0:
        rounded = np.rint(np.float32(depth) * np.float32(steps))
        return np.float32(0.0) if depth < nearest else rounded if depth <= farthest else NOTHING
    return np.float32(0.0 if depth < nearest else depth if depth <= farthest else math.inf)


@kernel
def _between(right: float, left: float, lens: Lens, columns: int) -> tuple[int, int]:
    """Columns whose rays go to the left by ``right`` to ``left`` per metre, one more a side."""
    focal, centre, _, _, _, _ = lens
    first = max(0.0, centre - focal * left)
    last = min(columns - 1.0, centre - focal * right + 1.0)
    return (int(first), int(last) + 1) if first <= last else (0, 0)


@kernel
def columns_of_disc(
    fore: float, left: float, r: float, lens: Lens, columns: int
) -> tuple[int, int]:
    """First column that may meet an upright cylinder, and the one after the last.

    Args:
        fore, left: of its axis, seen by the camera, m.
    """
    if fore <= r + _ROOM:  # beside or around the camera
        return 0, columns
    middle, half = fore * left, r * math.sqrt(fore * fore + left * left - r * r)
    over = 1.0 / (fore * fore - r * r)
    return _between((middle - half) * over, (middle + half) * over, lens, columns)


@kernel
def columns_of_wall(
    fore0: float, left0: float, fore1: float, left1: float, lens: Lens, columns: int,
) -> tuple[int, int]:  # fmt: skip
    """As `columns_of_disc`, of an upright plate with two ends."""
    if fore0 <= _ROOM or fore1 <= _ROOM:
        return 0, columns
    slope0, slope1 = left0 / fore0, left1 / fore1
    return _between(min(slope0, slope1), max(slope0, slope1), lens, columns)


@kernel
def cross_disc(
    px: float, py: float, r: float, first: int, last: int, ways: Array, leans: Array
) -> None:
    """Write depths at which rays of columns enter and leave a cylinder; inf for a miss.

    Args:
        px, py: its axis, seen from the camera in the directions of the world, m.
        first, last: first column, and the one after the last.
    """
    lean, ahead, aside = leans[first:last], ways[AHEAD, first:last], ways[ASIDE, first:last]
    near, far = ways[NEAR, first:last], ways[FAR, first:last]
    for c in range(lean.shape[0]):
        along = ahead[c] * px + aside[c] * py
        across = ahead[c] * py - aside[c] * px
        room = r * r - across * across
        half = math.sqrt(max(room, 0.0))
        hit = (room >= 0.0) & (along + half >= 0.0)
        near[c] = max(0.0, along - half) * lean[c] if hit else math.inf
        far[c] = (along + half) * lean[c]


@kernel
def cross_wall(
    px: float, py: float, ex: float, ey: float, first: int, last: int, ways: Array, leans: Array
) -> None:
    """As `cross_disc`, of an upright plate from p to p + e."""
    lean, ahead, aside = leans[first:last], ways[AHEAD, first:last], ways[ASIDE, first:last]
    near, far = ways[NEAR, first:last], ways[FAR, first:last]
    for c in range(lean.shape[0]):
        across = ahead[c] * ey - aside[c] * ex
        way = (px * ey - py * ex) / across
        share = (px * aside[c] - py * ahead[c]) / across
        hit = (way >= 0.0) & (share >= -OVERLAP) & (share <= 1.0 + OVERLAP)
        near[c] = far[c] = way * lean[c] if hit else math.inf


@kernel
def outline(
    low: float, high: float, first: int, last: int, rows: float, lens: Lens, ways: Array,
    edges: Edges, faces: Image,
) -> None:  # fmt: skip
    """Work out in which rows of the columns [first, last) a body shows, and how its face reads.

    A ray of row r is at the depth d over a height h if r < horizon - h focal / d.

    Args:
        low, high: heights of the body, m.
    """
    focal, _, horizon, _, farthest, _ = lens
    near, far, face = ways[NEAR, first:last], ways[FAR, first:last], faces[first:last]
    up, begin = edges[UP, first:last], edges[BEGIN, first:last]
    end, down = edges[END, first:last], edges[DOWN, first:last]
    for c in range(near.shape[0]):
        hit = near[c] <= farthest
        scale, behind = focal / max(near[c], _TOUCH), focal / max(far[c], _TOUCH)
        over, over_behind = np.ceil(horizon - high * scale), np.ceil(horizon - high * behind)
        under, under_behind = np.floor(horizon - low * scale), np.floor(horizon - low * behind)
        up[c] = min(max(over_behind, 0.0), rows) if hit else math.inf
        begin[c] = min(max(over, 0.0), rows) if hit else math.inf
        end[c] = min(max(under + 1.0, 0.0), rows) if hit else -math.inf
        down[c] = min(max(under_behind + 1.0, 0.0), rows) if hit else -math.inf
        face[c] = measured(near[c], lens)
