"""Depth images, painted body by body.

Depth is measured along the optical axis: an upright face has one depth in all rows of a column;
the floor, and tops and bottoms of bodies, have one depth in all columns of a row. So the image of
a body is three shapes, a face, a top and a bottom, each of which reaches in every column from one
row to another, and of all that covers a pixel the least depth counts. What is hit is what
`crowdbot.core.sensing.columns.cast_columns` hits, pixel by pixel.

Heights are here those over the camera, and rays to the left and up have positive slopes.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.bodies import BOTTOM, RADIUS, TOP, X, Y
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
_NOTHING = np.float32(65535.0)


@kernel
def _measured(depth: float, lens: Lens) -> np.float32:
    """A depth as the camera gives it: 0 for too near, inf, or `_NOTHING`, for too far."""
    _, _, _, nearest, farthest, steps = lens
    if steps > 0.0:
        rounded = np.rint(np.float32(depth) * np.float32(steps))
        return np.float32(0.0) if depth < nearest else rounded if depth <= farthest else _NOTHING
    return np.float32(0.0 if depth < nearest else depth if depth <= farthest else math.inf)


@kernel
def _between(right: float, left: float, lens: Lens, columns: int) -> tuple[int, int]:
    """Columns whose rays go to the left by ``right`` to ``left`` per metre, one more a side."""
    focal, centre, _, _, _, _ = lens
    first = max(0.0, centre - focal * left)
    last = min(columns - 1.0, centre - focal * right + 1.0)
    return (int(first), int(last) + 1) if first <= last else (0, 0)


@kernel
def _columns_of_disc(
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
def _columns_of_wall(
    fore0: float, left0: float, fore1: float, left1: float, lens: Lens, columns: int,
) -> tuple[int, int]:  # fmt: skip
    """As `_columns_of_disc`, of an upright plate with two ends."""
    if fore0 <= _ROOM or fore1 <= _ROOM:
        return 0, columns
    slope0, slope1 = left0 / fore0, left1 / fore1
    return _between(min(slope0, slope1), max(slope0, slope1), lens, columns)


@kernel
def _cross_disc(
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
def _cross_wall(
    px: float, py: float, ex: float, ey: float, first: int, last: int, ways: Array, leans: Array
) -> None:
    """As `_cross_disc`, of an upright plate from p to p + e."""
    lean, ahead, aside = leans[first:last], ways[AHEAD, first:last], ways[ASIDE, first:last]
    near, far = ways[NEAR, first:last], ways[FAR, first:last]
    for c in range(lean.shape[0]):
        across = ahead[c] * ey - aside[c] * ex
        way = (px * ey - py * ex) / across
        share = (px * aside[c] - py * ahead[c]) / across
        hit = (way >= 0.0) & (share >= -OVERLAP) & (share <= 1.0 + OVERLAP)
        near[c] = far[c] = way * lean[c] if hit else math.inf


@kernel
def _outline(
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
        face[c] = _measured(near[c], lens)


@kernel
def _range(edge: Edges, rows: int) -> tuple[int, int]:
    """The least and the greatest row of an edge, in columns in which the body shows."""
    least, greatest = np.float32(rows), np.float32(0.0)
    for row in edge:
        if np.float32(0.0) <= row <= np.float32(rows):
            least, greatest = min(least, row), max(greatest, row)
    return int(least), int(greatest)


@kernel
def _paint_face(
    rows: tuple[int, int], columns: tuple[int, int], edges: Edges, faces: Image, image: Image
) -> None:
    """Paint a face into rows, not all of which it covers in every column."""
    left, right = columns
    begin, end, face = edges[BEGIN, left:right], edges[END, left:right], faces[left:right]
    for r in range(*rows):
        row, line = np.float32(r), image[r, left:right]
        for c in range(line.shape[0]):
            shows = (begin[c] <= row) & (row < end[c]) & (face[c] < line[c])
            line[c] = face[c] if shows else line[c]


@kernel
def _paint_full_face(
    rows: tuple[int, int], columns: tuple[int, int], faces: Image, image: Image
) -> None:
    """Paint a face into rows that it covers in every column in which it shows."""
    left, right = columns
    face = faces[left:right]
    for r in range(*rows):
        line = image[r, left:right]
        for c in range(line.shape[0]):
            line[c] = face[c] if face[c] < line[c] else line[c]


@kernel
def _paint_level(
    height: float, between: tuple[int, int], rows: tuple[int, int], columns: tuple[int, int],
    up: Array, lens: Lens, edges: Edges, image: Image,
) -> None:  # fmt: skip
    """Paint a top or a bottom at a height, which reaches from one edge to another."""
    left, right = columns
    begin, end = edges[between[0], left:right], edges[between[1], left:right]
    for r in range(*rows):
        row, line = np.float32(r), image[r, left:right]
        depth = image.dtype.type(_measured(height / up[r], lens))
        for c in range(line.shape[0]):
            shows = (begin[c] <= row) & (row < end[c]) & (depth < line[c])
            line[c] = depth if shows else line[c]


@kernel
def _paint_outlined(
    low: float, high: float, columns: tuple[int, int], up: Array, lens: Lens, edges: Edges,
    faces: Image, image: Image,
) -> None:  # fmt: skip
    """Paint a body into the columns of its outline, where nothing nearer is."""
    left, right = columns
    rows = up.shape[0]
    first_begin, last_begin = _range(edges[BEGIN, left:right], rows)
    first_end, last_end = _range(edges[END, left:right], rows)
    if first_begin > last_begin:  # it shows nowhere
        return
    if high < 0.0:  # else the camera does not see the top
        first, _ = _range(edges[UP, left:right], rows)
        _paint_level(high, (UP, BEGIN), (first, last_begin), columns, up, lens, edges, image)
    if low > 0.0:
        _, last = _range(edges[DOWN, left:right], rows)
        _paint_level(low, (END, DOWN), (first_end, last), columns, up, lens, edges, image)
    if last_begin < first_end:
        _paint_face((first_begin, last_begin), columns, edges, faces, image)
        _paint_full_face((last_begin, first_end), columns, faces, image)
        _paint_face((first_end, last_end), columns, edges, faces, image)
    else:
        _paint_face((first_begin, last_end), columns, edges, faces, image)


@kernel
def _paint_body(
    first: int, last: int, low: float, high: float, up: Array, lens: Lens, ways: Array,
    edges: Edges, faces: Image, image: Image,
) -> None:  # fmt: skip
    """Paint what was found of a body in the columns [first, last)."""
    _outline(low, high, first, last, up.shape[0], lens, ways, edges, faces)
    _paint_outlined(low, high, (first, last), up, lens, edges, faces, image)


@kernel
def _in_view(low: float, high: float, up: Array, farthest: float) -> bool:
    """Whether a body reaches into the heights between which rays run."""
    lowest, highest = min(0.0, up[up.shape[0] - 1]), max(0.0, up[0])
    return bool(low <= highest * farthest and high >= lowest * farthest)


@kernel
def _paint_walls(
    x: float, y: float, z: float, ahead: float, aside: float, lens: Lens, up: Array, lean: Array,
    walls: Array, heights: Array, ways: Array, edges: Edges, faces: Image, image: Image,
) -> None:  # fmt: skip
    """Paint upright plates, seen in the direction (ahead, aside) of the world."""
    farthest = lens[FARTHEST]
    for i in range(walls.shape[0]):
        px, py, qx, qy = walls[i, 0] - x, walls[i, 1] - y, walls[i, 2] - x, walls[i, 3] - y
        fore0, fore1 = ahead * px + aside * py, ahead * qx + aside * qy
        if max(fore0, fore1) < 0.0 or min(fore0, fore1) > farthest:
            continue
        low, high = heights[i, 0] - z, heights[i, 1] - z
        if not _in_view(low, high, up, farthest):
            continue
        left0, left1 = ahead * py - aside * px, ahead * qy - aside * qx
        first, last = _columns_of_wall(fore0, left0, fore1, left1, lens, lean.shape[0])
        _cross_wall(px, py, qx - px, qy - py, first, last, ways, lean)
        _paint_body(first, last, low, high, up, lens, ways, edges, faces, image)


@kernel
def _paint_discs(
    x: float, y: float, z: float, ahead: float, aside: float, lens: Lens, up: Array, lean: Array,
    discs: Array, ways: Array, edges: Edges, faces: Image, image: Image,
) -> None:  # fmt: skip
    """Paint upright cylinders, seen in the direction (ahead, aside) of the world."""
    farthest = lens[FARTHEST]
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        fore = ahead * px + aside * py
        if not -r < fore < farthest + r:  # most of them, and the absent, who are at infinity
            continue
        low, high = discs[i, BOTTOM] - z, discs[i, TOP] - z
        if not _in_view(low, high, up, farthest):
            continue
        first, last = _columns_of_disc(fore, ahead * py - aside * px, r, lens, lean.shape[0])
        if first < last:
            _cross_disc(px, py, r, first, last, ways, lean)
            _paint_body(first, last, low, high, up, lens, ways, edges, faces, image)


@kernel
def _finish(image: Image) -> None:
    """Say 0 where nothing is in reach."""
    nothing, zero = image.dtype.type(_NOTHING), image.dtype.type(0)
    for r in range(image.shape[0]):
        line = image[r]
        for c in range(line.shape[0]):
            line[c] = zero if line[c] == nothing else line[c]


@kernel
def paint(
    x: float, y: float, z: float, yaw: float, lens: Lens, up: Array, lean: Array, cos: Array,
    sin: Array, walls: Array, wall_heights: Array, discs: Array, ways: Array, edges: Edges,
    faces: Image, image: Image,
) -> None:  # fmt: skip
    """Depth along the axis of a level camera; 0 for too near, inf for nothing in reach.

    The floor z = 0 is seen. Of whole numbers 0 stands for both.

    Args:
        x, y, z, yaw: camera in the world frame, m and rad.
        lens: of the camera.
        up: (H,) rise of the rows' rays per metre of depth, falling evenly.
        lean, cos, sin: (W,) depth per metre of way over the floor; of the columns' azimuths.
        walls, wall_heights: (S, 4), (S, 2).
        discs: (D, 5) upright cylinders.
        ways, edges, faces: (`WAYS`, W), (`EDGES`, W), (W,) scratch, the last like the image.
        image: (H, W) result; of whole numbers only if the lens has steps.
    """
    for r in range(up.shape[0]):
        image[r] = _measured(-z / up[r] if up[r] < 0.0 else math.inf, lens)
    ahead, aside = math.cos(yaw), math.sin(yaw)
    for c in range(lean.shape[0]):
        ways[AHEAD, c] = ahead * cos[c] - aside * sin[c]
        ways[ASIDE, c] = aside * cos[c] + ahead * sin[c]
    _paint_walls(
        x, y, z, ahead, aside, lens, up, lean, walls, wall_heights, ways, edges, faces, image
    )
    _paint_discs(x, y, z, ahead, aside, lens, up, lean, discs, ways, edges, faces, image)
    if lens[STEPS] > 0.0:
        _finish(image)
