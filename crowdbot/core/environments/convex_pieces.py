"""Convex pieces of polygons that are not convex: triangles, joined where they stay convex.

Source of the joining: Hertel, Mehlhorn, "Fast triangulation of simple polygons", FCT 1983.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.outlines import Outline, Side, is_convex, sides, signed_area, turn

#: Smaller triangles are rounding, m^2.
_LEAST_AREA = 1e-9


def convex_pieces(outline: Outline, holes: Sequence[Outline] = ()) -> list[Array]:
    """Return convex outlines (K, 2), counter-clockwise, that fill a polygon without overlap.

    Args:
        outline: simple, counter-clockwise; m.
        holes: simple outlines within it.

    Returns:
        the outline itself if it is convex and has no hole; the same pieces in the same order in
        every call.
    """
    if not holes and is_convex(outline):
        return [np.array(outline)]
    polygon = shapely.Polygon(outline, holes)
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))
    pieces = [_corners(t) for t in triangles if t.area > _LEAST_AREA]
    return [np.array(piece) for piece in _joined(sorted(pieces))]


def _corners(triangle: Any) -> Outline:
    points = tuple((float(x), float(y)) for x, y in triangle.exterior.coords[:-1])
    return points if signed_area(points) > 0.0 else points[::-1]


def _joined(pieces: list[Outline]) -> list[Outline]:
    """Return the pieces after joining neighbours, pair by pair, while the result is convex."""
    open_ = dict(enumerate(pieces))
    owners = {side: k for k, piece in open_.items() for side in sides(piece)}
    done: list[Outline] = []
    while open_:
        piece = open_.pop(next(iter(open_)))
        while (found := _partner(piece, open_, owners)) is not None:
            k, piece = found
            del open_[k]
        done.append(piece)
    return done


def _partner(
    piece: Outline, others: dict[int, Outline], owners: dict[Side, int]
) -> tuple[int, Outline] | None:
    """Return the index of the first other piece that can be joined, and the joined outline."""
    beside = {owners.get((b, a), -1) for a, b in sides(piece)}
    for k in sorted(beside & others.keys()):
        together = _join(piece, others[k])
        if together is not None:
            return k, together
    return None


def _join(one: Outline, other: Outline) -> Outline | None:
    """Return two pieces as one convex outline, if they share a whole side; otherwise None."""
    where = {point: k for k, point in enumerate(other)}
    for i, start in enumerate(one):
        end = one[(i + 1) % len(one)]
        k = where.get(end)
        if k is None or other[(k + 1) % len(other)] != start:
            continue
        # Once around from the common side's end, then on from its start around the other.
        first = [one[(i + 1 + n) % len(one)] for n in range(len(one))]
        second = [other[(k + 2 + n) % len(other)] for n in range(len(other) - 2)]
        together = _without_straight_corners((*first, *second))
        return together if is_convex(together) else None
    return None


def _without_straight_corners(outline: Outline) -> Outline:
    count = len(outline)
    kept = tuple(
        outline[i]
        for i in range(count)
        if turn(outline[i - 1], outline[i], outline[(i + 1) % count]) != 0.0
    )
    return kept if len(kept) >= 3 else outline
