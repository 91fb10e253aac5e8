"""Depth images, painted column by column.

An upright face has one depth in all rows of a column, since depth is measured along the optical
axis; the floor, and tops and bottoms of bodies, have one depth in all columns of a row. So a
column is a few runs of equal numbers, the least of which counts. What is hit is what
`crowdbot.core.sensing.columns.cast_columns` hits, pixel by pixel.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.columns import FAR, HIGH, LOW, NEAR, fill_columns, heights_of

Array = NDArray[np.float64]


@kernel
def _rows_above(
    bound: float, also_at: bool, z: float, depth: float, rise: Array, guess: float
) -> int:
    """How many rays, from the first on, are above ``bound`` (or at it) at a depth.

    Args:
        rise: (R,) falling.
        guess: roughly how many they are; it costs time to be wrong.
    """
    rows = rise.shape[0]
    row = rows if guess >= rows else int(guess) if guess > 0.0 else 0
    while row > 0:
        height = z + rise[row - 1] * depth
        if height > bound or (also_at and height == bound):
            break
        row -= 1
    while row < rows:
        height = z + rise[row] * depth
        if not (height > bound or (also_at and height == bound)):
            break
        row += 1
    return row


@kernel
def _hidden(
    z: float, near: float, far: float, low: float, high: float, rise: Array, first: int, last: int
) -> bool:
    """Whether a body shows in none of the rows but [first, last)."""
    rows = rise.shape[0]
    if first > 0:
        over = rise[first - 1]
        if not z + over * near > high or (over < 0.0 and not (high - z) / over > far):
            return False
    if last < rows:
        under = rise[last]
        if not z + under * near < low or (under > 0.0 and not (low - z) / under > far):
            return False
    return True


@kernel
def _paint(
    z: float, near: float, far: float, low: float, high: float, rise: Array, per_row: float,
    column: Array,
) -> tuple[int, int]:  # fmt: skip
    """Paint one body, from ``near`` to ``far`` along the axis, where nothing nearer is.

    Args:
        per_row: by how much ``rise`` falls from row to row, on average.

    Returns:
        first row of its face, and the one after the last.
    """
    # Exact where it falls evenly; nonsense, which does no harm, where a length is zero.
    rows_per_metre = 1.0 / (near * per_row)
    middle = rise[0] / per_row
    begin = _rows_above(high, False, z, near, rise, middle - (high - z) * rows_per_metre)
    end = _rows_above(low, True, z, near, rise, middle - (low - z) * rows_per_metre)
    face = column[begin:end]  # indexed from 0, so that several rows are painted at once
    for r in range(face.shape[0]):
        here = face[r]
        face[r] = near if near < here else here
    if far > near:
        for r in range(begin - 1, -1, -1):  # comes down on the top
            if rise[r] >= 0.0 or (high - z) / rise[r] > far:
                break
            column[r] = min(column[r], (high - z) / rise[r])
        for r in range(max(begin, end), rise.shape[0]):  # comes up from below
            if rise[r] <= 0.0 or (low - z) / rise[r] > far:
                break
            column[r] = min(column[r], (low - z) / rise[r])
    return begin, end


@kernel
def paint_depth(
    x: float, y: float, z: float, yaw: float, azimuth: Array, cos: Array, sin: Array,
    rise: Array, lean: Array, max_range: float, walls: Array, wall_heights: Array, discs: Array,
    owner: NDArray[np.int64], work: Array, count: NDArray[np.int64], ways: Array,
    runs: NDArray[np.int64], floor: Array, depth: Array,
) -> None:  # fmt: skip
    """Depth along the axis of a camera, m; inf where nothing is. The floor z = 0 is seen.

    Args:
        rise: (R,) falling: the first row is on top.
        lean: (C,) cosines of the azimuths.
        max_range: m over the floor; what is farther may be left out.
        floor: (R,) scratch.
        depth: (C, R) result, columns by rising azimuth.

    Everything else is as in `crowdbot.core.sensing.columns.cast_columns`.
    """
    lowest, highest = heights_of(z, rise, lean, max_range)
    fill_columns(
        x, y, yaw, lowest, highest, azimuth, cos, sin, max_range,
        walls, wall_heights, discs, owner, work, count, ways, runs,
    )  # fmt: skip
    floor_depths(z, rise, floor)
    for c in range(azimuth.shape[0]):
        paint_column(z, rise, lean[c], work[c, : count[c]], floor, depth[c])


@kernel
def floor_depths(z: float, rise: Array, floor: Array) -> None:
    """Write the depth (R,) at which rows of rays from a height ``z`` meet the floor, m; or inf."""
    for r in range(floor.shape[0]):
        floor[r] = -z / rise[r] if rise[r] < 0.0 else math.inf


@kernel
def paint_column(
    z: float, rise: Array, lean: float, bodies: Array, floor: Array, column: Array
) -> None:
    """Depth (R,) along the axis in one column, m.

    Args:
        z: height of the camera, m.
        lean: cosine of the column's azimuth.
        bodies: (K, `WORK_COLUMNS`) what `fill_columns` found in the column, nearest first.
        floor: (R,) of `floor_depths`.
        column: (R,) result.
    """
    rows = rise.shape[0]
    per_row = (rise[0] - rise[rows - 1]) / max(rows - 1, 1)
    for r in range(rows):
        column[r] = floor[r]
    first = last = 0  # rows that a face covers: what comes later is farther
    for k in range(bodies.shape[0]):
        body = bodies[k]
        near, far = body[NEAR] * lean, body[FAR] * lean
        if _hidden(z, near, far, body[LOW], body[HIGH], rise, first, last):
            continue
        begin, end = _paint(z, near, far, body[LOW], body[HIGH], rise, per_row, column)
        if begin <= last and end >= first and last > first:
            first, last = min(first, begin), max(last, end)
        elif end - begin > last - first:
            first, last = begin, end
