"""Straight lines along the borders of a grid's cells, within part of a cell.

The border of a slanted wall is a staircase. A line may replace a part of it if it crosses the lines
between the centres of each free cell and the solid cell beside it, near their middles. So no line
passes the centre of a cell, none meets another, and a wall of one cell stays a wall. Among all
closed paths around a ring the one with the fewest lines is taken, and among these the nearest one.
The condition is like that of Selinger, "Potrace: a polygon-based tracing algorithm", 2003.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.environments.grid_rings_build import GridRing

#: Largest tolerance that keeps the centre of each cell on its side, cells.
MOST_TOLERANCE = 0.5
#: Part of the tolerance that is kept clear of the centres.
_CLEAR = 0.99
#: Corners pinched between two solid cells are cut by this at least, cells.
_LEAST_CUT = 0.02
#: Longest line in steps along the border: longer ones take too long to look for.
_MOST_STEPS = 600
#: With a smaller tolerance a line cannot cut the corners of a staircase, cells.
_CUTS_STEPS = 0.36
_GATE, _CORNER, _END = 0, 1, 2

Ints = NDArray[np.int64]


class _Events(NamedTuple):
    """Gates to cross, corners to pass and possible ends of lines along a ring, in order.

    Attributes:
        kind: (N,) one of the constants above.
        table: (N, 4) right and left end of a gate; else a point, and zeros.
    """

    kind: Ints
    table: Array


def straightened(ring: GridRing, tolerance: float) -> Array:
    """Return the corners (K, 2) of a ring of few lines.

    Args:
        tolerance: largest distance from the border, cells, at most 0.5; 0 keeps every corner.
    """
    if tolerance <= 0.0:
        return _ends(ring, _LEAST_CUT, between=False)[1]
    events = _around(ring, tolerance)
    ends = np.flatnonzero(events.kind == _END)
    before = np.zeros(len(ends), np.int64)
    _fewest_lines(events.kind, events.table, ends, tolerance, before)
    way, at = list[int](), len(ends) - 1
    while at > 0:
        at = int(before[at])
        way.append(at)
    return events.table[ends[way[::-1]], :2]


def _ends(ring: GridRing, cut: float, *, between: bool) -> tuple[Array, Array]:
    """Return the possible ends of lines: their way along the ring, sorted, and points (K, 2).

    These are corners, places beside pinched ones, and, ``between`` them, the middles of steps.
    """
    corners = ring.corners.astype(np.float64)
    after = np.roll(corners, -1, axis=0) - corners
    length = np.abs(after).sum(axis=1)
    heading = after / length[:, np.newaxis]
    came = np.roll(heading, 1, axis=0)
    turn = came[:, 0] * heading[:, 1] - came[:, 1] * heading[:, 0]
    at = np.concatenate([[0.0], np.cumsum(length)[:-1]])
    whole, pinched = ~ring.pinched, ring.pinched
    step = between & (length == 1.0) & (turn != np.roll(turn, -1))
    ways = [at[whole], at[pinched] - cut, at[pinched] + cut, at[step] + 0.5]
    points = [
        corners[whole],
        (corners - cut * came)[pinched],
        (corners + cut * heading)[pinched],
        (corners + 0.5 * heading)[step],
    ]
    way, first = np.unique(np.concatenate(ways) % length.sum(), return_index=True)
    return way, np.concatenate(points)[first]


def _around(ring: GridRing, tolerance: float) -> _Events:
    """Return a ring's events, from one end of a line around to the same end."""
    corners = ring.corners.astype(np.float64)
    after = np.roll(corners, -1, axis=0) - corners
    length = np.abs(after).sum(axis=1)
    heading = after / length[:, np.newaxis]
    at = np.concatenate([[0.0], np.cumsum(length)[:-1]])
    left = np.column_stack([-heading[:, 1], heading[:, 0]])
    reach = _CLEAR * tolerance
    ways, kinds, rows = [], [], []
    long = length > 1.0
    for own, far in ((np.ones(len(at), np.bool_), np.full(len(at), 0.5)), (long, length - 0.5)):
        middle = corners + far[:, np.newaxis] * heading
        ways.append((at + far)[own])
        kinds.append(np.full(own.sum(), _GATE))
        rows.append(np.hstack([middle - reach * left, middle + reach * left])[own])
    cuts = tolerance >= _CUTS_STEPS
    sharp = (long & np.roll(long, 1)) | (not cuts)
    ways.append(at[sharp])
    kinds.append(np.full(sharp.sum(), _CORNER))
    rows.append(np.hstack([corners, np.zeros_like(corners)])[sharp])
    way, points = _ends(ring, min(MOST_TOLERANCE, tolerance), between=cuts)
    ways.append(way)
    kinds.append(np.full(len(way), _END))
    rows.append(np.hstack([points, np.zeros_like(points)]))
    return _from_anchor(np.concatenate(ways), np.concatenate(kinds), np.concatenate(rows), ring)


def _from_anchor(ways: Array, kinds: Ints, rows: Array, ring: GridRing) -> _Events:
    """Sort events along the ring, starting after its longest straight part."""
    order = np.lexsort([kinds, ways])
    kinds, rows, ways = kinds[order], rows[order], ways[order]
    ends = np.flatnonzero(kinds == _END)
    gaps = np.diff(ways[ends], append=ways[ends[0]] + _length(ring))
    anchor = ends[int(np.argmax(gaps))]
    kinds, rows = np.roll(kinds, -anchor), np.roll(rows, -anchor, axis=0)
    return _Events(np.append(kinds, _END), np.vstack([rows, rows[:1]]))


def _length(ring: GridRing) -> float:
    return float(np.abs(np.roll(ring.corners, -1, axis=0) - ring.corners).sum())


@kernel
def _fewest_lines(kind: Ints, table: Array, ends: Ints, reach: float, before: Ints) -> None:
    """Fill in, for each end of a line, the end before it on the best way from the first one."""
    # Two numbers for each end, in columns of the table that ends do not use: lines, and how far
    # they are from the middles of the gates.
    for k in range(1, len(ends)):
        table[ends[k], 2], table[ends[k], 3] = np.inf, np.inf
    for k in range(len(ends) - 1):
        start = ends[k]
        px, py = table[start, 0], table[start, 1]
        _spread(kind, table, reach, before, k, start, px, py)


@kernel
def _spread(
    kind: Ints, table: Array, reach: float, before: Ints,
    k: int, start: int, px: float, py: float,
) -> None:  # fmt: skip
    """Try all lines from one end onwards, while one may pass everything on the way."""
    lines, far = table[start, 2] + 1.0, table[start, 3]
    right_x, right_y, left_x, left_y = 0.0, 0.0, 0.0, 0.0
    opened = False
    other = k
    sxx, sxy, syy = 0.0, 0.0, 0.0  # of the middles of the gates passed, from the start
    for e in range(start + 1, min(len(kind), start + 1 + _MOST_STEPS)):
        rx, ry = table[e, 0] - px, table[e, 1] - py
        if kind[e] == _END:
            other += 1
            size = rx * rx + ry * ry
            inside = not opened or (
                right_x * ry - right_y * rx >= 0.0 and rx * left_y - ry * left_x >= 0.0
            )
            if inside and size > 0.0:
                off = far + (sxx * ry * ry - 2.0 * sxy * rx * ry + syy * rx * rx) / size
                if lines < table[e, 2] or (lines == table[e, 2] and off < table[e, 3]):
                    table[e, 2], table[e, 3] = lines, off
                    before[other] = k
            continue
        if kind[e] == _CORNER:
            size = rx * rx + ry * ry
            if size <= reach * reach:
                continue
            along, side = math.sqrt(size - reach * reach), reach
            lx, ly = rx * along - ry * side, ry * along + rx * side
            rx, ry = rx * along + ry * side, ry * along - rx * side
        else:
            lx, ly = table[e, 2] - px, table[e, 3] - py
            mx, my = 0.5 * (rx + lx), 0.5 * (ry + ly)
            sxx, sxy, syy = sxx + mx * mx, sxy + mx * my, syy + my * my
        if not opened:
            right_x, right_y, left_x, left_y, opened = rx, ry, lx, ly, True
            continue
        if right_x * ry - right_y * rx > 0.0:
            right_x, right_y = rx, ry
        if left_x * ly - left_y * lx < 0.0:
            left_x, left_y = lx, ly
        if right_x * left_y - right_y * left_x < 0.0:
            return
