"""Detect legs: runs of lidar points as narrow as a leg, or as two legs side by side; compiled.

As leg detectors do (Arras, Mozos, Burgard, "Using boosted features for the detection of people in
2D range data", ICRA 2007), but by three rules instead of a trained classifier: narrow, not the
visible end of a partly hidden object, and not a piece of a straight wall.
"""

from __future__ import annotations

import math

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

#: Columns of a cluster: place (m), width (m), first point, end, 1 if a pillar or wall stood there,
#: 1 if something nearer hides a part of it.
X, Y, WIDTH, FIRST, END, STILL, PARTLY = range(7)
COLUMNS = 7
#: One leg is at most as wide, and two side by side, m.
LEG, LEGS = 0.16, 0.45
#: Neighbouring points farther apart than this plus a share of their distance: two bodies, m.
_GAP, _GAP_SHARE = 0.06, 0.013
#: The surface of a leg lies so far before its axis, m.
_DEPTH = 0.04
#: A neighbour nearer than the end of a run by this hides what continues there, m; and how near in
#: bearing, rad.
_IN_FRONT, _BESIDE = 0.1, 0.03
#: Neighbours of a run that lie on one line with it, within this, make it a piece of a wall, m.
_STRAIGHT, _PIECE = 0.04, 1.5


@kernel
def find_clusters(points: Array, reach: float, out: Array) -> int:
    """Write the runs that may be legs, and return how many.

    Args:
        points: (P, 2) base frame, m, those of one lidar in the order of its beams.
        reach: farther ones are left out, m.
        out: (K, `COLUMNS`) base frame; no more than K are written.
    """
    count = first = 0
    for i in range(1, points.shape[0] + 1):
        if i < points.shape[0] and not _separate(points, i - 1, i):
            continue
        if count < out.shape[0] and _is_narrow(points, first, i - 1, reach):
            _write(points, first, i, out[count])
            count += 1
        first = i
    return count


@kernel
def _separate(points: Array, a: int, b: int) -> bool:
    dx, dy = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    away = math.sqrt(points[b, 0] ** 2 + points[b, 1] ** 2)
    most = _GAP + _GAP_SHARE * away
    return bool(dx * dx + dy * dy > most * most)


@kernel
def _is_narrow(points: Array, a: int, b: int, reach: float) -> bool:
    """Return True if the run from point a to point b may be legs."""
    wide = math.hypot(points[b, 0] - points[a, 0], points[b, 1] - points[a, 1])
    x, y = 0.5 * (points[a, 0] + points[b, 0]), 0.5 * (points[a, 1] + points[b, 1])
    if wide > LEGS or x * x + y * y > reach * reach:
        return False
    before, after = _hidden(points, a, a - 1), _hidden(points, b, b + 1)
    if before and after:
        return False
    return not _on_wall(points, a, b)


@kernel
def _hidden(points: Array, edge: int, beside: int) -> bool:
    """Return True if the end of a run is hidden by something nearer."""
    if beside < 0 or beside >= points.shape[0]:
        return False
    x, y, p, q = points[edge, 0], points[edge, 1], points[beside, 0], points[beside, 1]
    far, near = math.sqrt(x * x + y * y), math.sqrt(p * p + q * q)
    return near < far - _IN_FRONT and abs(x * q - y * p) < _BESIDE * max(far * near, 1e-9)


@kernel
def _on_wall(points: Array, a: int, b: int) -> bool:
    """Return True if two points before or behind a run, or one on either side, lie in its line."""
    last = points.shape[0] - 1
    ahead = b + 2 <= last and _in_line(points, a, b, b + 1, b + 2)
    behind = a >= 2 and _in_line(points, b, a, a - 1, a - 2)
    between = a >= 1 and b < last and _in_line(points, a - 1, a, b, b + 1)
    return ahead or behind or between


@kernel
def _in_line(points: Array, i: int, j: int, k: int, m: int) -> bool:
    """Return True if points j and k lie near the chord from i to m, which is not too long."""
    x, y = points[i, 0], points[i, 1]
    dx, dy = points[m, 0] - x, points[m, 1] - y
    long = math.sqrt(dx * dx + dy * dy)
    if long > _PIECE or long < 0.12:
        return False
    off = max(
        abs(dx * (points[j, 1] - y) - dy * (points[j, 0] - x)),
        abs(dx * (points[k, 1] - y) - dy * (points[k, 0] - x)),
    )
    if off > _STRAIGHT * long:
        return False
    # pieces of a wall are about as far apart as its points
    step = max(
        math.hypot(points[k, 0] - points[j, 0], points[k, 1] - points[j, 1]),
        math.hypot(points[m, 0] - points[k, 0], points[m, 1] - points[k, 1]),
    )
    return step < 0.75 * long


@kernel
def _write(points: Array, first: int, end: int, row: Array) -> None:
    a, b = first, end - 1
    x, y = 0.5 * (points[a, 0] + points[b, 0]), 0.5 * (points[a, 1] + points[b, 1])
    away = max(math.hypot(x, y), 1e-9)
    row[X], row[Y] = x + _DEPTH * x / away, y + _DEPTH * y / away
    row[WIDTH] = math.hypot(points[b, 0] - points[a, 0], points[b, 1] - points[a, 1])
    row[FIRST], row[END], row[STILL] = first, end, 0.0
    partly = _hidden(points, a, a - 1) or _hidden(points, b, b + 1)
    row[PARTLY] = 1.0 if partly else 0.0
