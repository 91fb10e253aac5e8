"""Depth images, painted body by body.

The floor, and tops and bottoms of bodies, have one depth in all columns of a row, an upright face
has one in all rows of a column. So the image of a body is three shapes, a face, a top and a
bottom, each of which reaches in every column from one row to another, and of all that covers a
pixel the least depth counts.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.bodies import BOTTOM, RADIUS, TOP, X, Y
from crowdbot.core.sensing.outline import (
    AHEAD,
    ASIDE,
    BEGIN,
    DOWN,
    END,
    FARTHEST,
    NOTHING,
    STEPS,
    UP,
    Edges,
    Image,
    Lens,
    columns_of_disc,
    columns_of_wall,
    cross_disc,
    cross_wall,
    measured,
    outline,
)

Array = NDArray[np.float64]


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
        depth = image.dtype.type(measured(height / up[r], lens))
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
    outline(low, high, first, last, up.shape[0], lens, ways, edges, faces)
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
        first, last = columns_of_wall(fore0, left0, fore1, left1, lens, lean.shape[0])
        cross_wall(px, py, qx - px, qy - py, first, last, ways, lean)
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
        first, last = columns_of_disc(fore, ahead * py - aside * px, r, lens, lean.shape[0])
        if first < last:
            cross_disc(px, py, r, first, last, ways, lean)
            _paint_body(first, last, low, high, up, lens, ways, edges, faces, image)


@kernel
def _finish(image: Image) -> None:
    """Say 0 where nothing is in reach."""
    nothing, zero = image.dtype.type(NOTHING), image.dtype.type(0)
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
        image[r] = measured(-z / up[r] if up[r] < 0.0 else math.inf, lens)
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
