"""Outlines: closed polygons as tuples of points, without a numerical library.

An outline is simple if its sides meet only in the corners of neighbours.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

Point = tuple[float, float]
Outline = tuple[Point, ...]
Side = tuple[Point, Point]


def sides(outline: Sequence[Point]) -> Iterator[Side]:
    """Yield the sides in order, the last one back to the first corner."""
    yield from pairwise((*outline, outline[0]))


def signed_area(outline: Sequence[Point]) -> float:
    """Return the signed area, positive for counter-clockwise outlines, m^2."""
    x0, y0 = outline[0]  # near zero, where floats are finest
    return 0.5 * sum(
        (ax - x0) * (by - y0) - (bx - x0) * (ay - y0) for (ax, ay), (bx, by) in sides(outline)
    )


def counter_clockwise(outline: Sequence[Point]) -> Outline:
    """Return the same outline, counter-clockwise."""
    return tuple(outline) if signed_area(outline) > 0.0 else tuple(outline)[::-1]


def turn(a: Point, b: Point, c: Point) -> float:
    """Return a positive number for a left turn at b, m^2."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def is_convex(outline: Sequence[Point]) -> bool:
    """Return True if a simple, counter-clockwise outline never turns right."""
    count = len(outline)
    return all(
        turn(outline[i - 1], outline[i], outline[(i + 1) % count]) >= 0.0 for i in range(count)
    )


def contains(outline: Sequence[Point], x: float, y: float) -> bool:
    """Return True if a point lies inside; undefined on the border. Even-odd rule."""
    odd = False
    for (ax, ay), (bx, by) in sides(outline):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            odd = not odd
    return odd


def distance_to_side(x: float, y: float, side: Side) -> float:
    """Return the distance from a point to a segment, m."""
    (ax, ay), (bx, by) = side
    ex, ey = bx - ax, by - ay
    square = ex * ex + ey * ey
    share = ((x - ax) * ex + (y - ay) * ey) / square if square > 0.0 else 0.0
    share = min(1.0, max(0.0, share))
    return math.hypot(x - ax - share * ex, y - ay - share * ey)


def distance_between(one: Side, other: Side) -> float:
    """Return the distance between two segments, m; 0 if they share a point."""
    if touch(one, other):
        return 0.0
    ends = ((one, other), (other, one))
    return min(distance_to_side(*point, side) for side, points in ends for point in points)


def along(line: Sequence[Point], gap: float) -> Iterator[Point]:
    """Yield positions at a fixed spacing along a polyline, from its start."""
    behind = 0.0  # part of the gap before this segment
    for (x0, y0), (x1, y1) in pairwise(line):
        length = math.hypot(x1 - x0, y1 - y0)
        at = behind
        while at <= length + 1e-9:
            share = at / length if length else 0.0
            yield x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            at += gap
        behind = at - length


def first_crossing(outline: Sequence[Point]) -> tuple[int, int] | None:
    """Return the indices of two sides that intersect; None for a simple outline.

    Sides are processed from left to right, so that long outlines take little time.
    """
    listed = list(sides(outline))
    order = sorted(range(len(listed)), key=lambda k: min(listed[k][0][0], listed[k][1][0]))
    open_: list[int] = []
    for k in order:
        left = min(listed[k][0][0], listed[k][1][0])
        open_ = [j for j in open_ if max(listed[j][0][0], listed[j][1][0]) >= left]
        for j in open_:
            if _clash(listed, j, k):
                return min(j, k), max(j, k)
        open_.append(k)
    return None


def _clash(listed: Sequence[Side], j: int, k: int) -> bool:
    """Return True if two sides meet in more than a shared corner."""
    count = len(listed)
    if (j + 1) % count == k or (k + 1) % count == j:
        first, second = (j, k) if (j + 1) % count == k else (k, j)
        (a, b), (_, c) = listed[first], listed[second]
        back = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0.0
        return back and turn(a, b, c) == 0.0  # straight back over the previous side
    return touch(listed[j], listed[k])


def touch(one: Side, other: Side) -> bool:
    """Return True if two segments share a point."""
    (a, b), (c, d) = one, other
    if max(a[0], b[0]) < min(c[0], d[0]) or max(c[0], d[0]) < min(a[0], b[0]):
        return False
    if max(a[1], b[1]) < min(c[1], d[1]) or max(c[1], d[1]) < min(a[1], b[1]):
        return False
    p, q, r, s = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
    return p * q <= 0.0 and r * s <= 0.0
