"""The solid parts around and within the floor of a plan."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import Face, Solid, outlines

#: A wall of a robot's world is as thick as this behind its face, m.
_BEHIND = 0.2
#: What is left free around such a wall before it counts as being in the way, m.
_SLACK = 0.01
#: Smaller overlaps are rounding, m^2.
_LEAST_AREA = 1e-9

Heights = tuple[float, float]


def around_floor(floor: list[Any], heights: Heights) -> tuple[tuple[Face, ...], tuple[Solid, ...]]:
    """Return the walls around a floor, and the solids inside it.

    An outer wall is a one-sided face. Where walls are so thin that the solid behind a face would
    reach into other floor, everything around the floor is solid instead.

    Args:
        floor: polygons without a common point, except for single ones; m.
        heights: bottom and top of everything, m.
    """
    outer = [p for p in floor if not any(_lies_in_hole(p, other) for other in floor)]
    inner = [p for p in floor if not any(p is other for other in outer)]
    if any(_reaches_floor(p, floor) for p in outer):
        x0, y0, x1, y1 = shapely.total_bounds(floor)
        block = shapely.box(x0 - _BEHIND, y0 - _BEHIND, x1 + _BEHIND, y1 + _BEHIND)
        return (), tuple(_solids([block.difference(shapely.union_all(floor))], heights))
    faces = tuple(Face(points=_closed(p.exterior), heights=heights) for p in outer)
    holes = [shapely.Polygon(h) for p in floor for h in p.interiors]
    return faces, tuple(_solids([_without(h, inner) for h in holes], heights))


def as_solid(polygon: Any, heights: Heights) -> Solid:
    """Return a polygon as a solid, with its holes."""
    holes = tuple(_ring(hole) for hole in polygon.interiors)
    return Solid(outline=_ring(polygon.exterior), holes=holes, heights=heights)


def _solids(shapes: list[Any], heights: Heights) -> Iterator[Solid]:
    for shape in shapes:
        for part in shapely.get_parts(shape):
            if part.geom_type == "Polygon" and part.area > _LEAST_AREA:
                yield as_solid(part, heights)


def _lies_in_hole(polygon: Any, other: Any) -> bool:
    """Return True if a polygon lies in a hole of another one."""
    point = polygon.representative_point()
    return any(shapely.Polygon(hole).contains(point) for hole in other.interiors)


def _without(hole: Any, islands: list[Any]) -> Any:
    """Return a hole without the floor in it; the hole itself, corner by corner, if there is none.

    Floor farther inside lies in the hole of an island and is taken away with it: the islands' own
    holes are solids of their own.
    """
    shapely.prepare(hole)
    inside = [
        shapely.Polygon(p.exterior) for p in islands if hole.contains(p.representative_point())
    ]
    return hole.difference(shapely.union_all(inside)) if inside else hole


def _reaches_floor(polygon: Any, floor: list[Any]) -> bool:
    """Return True if what is behind a wall of a polygon would reach into floor."""
    boxes = [box for side in pairwise(_closed(polygon.exterior)) if (box := _behind(*side))]
    tree = shapely.STRtree(boxes)
    return any(len(tree.query(p, predicate="intersects")) for p in floor)


def _behind(a: outlines.Point, b: outlines.Point) -> Any:
    """Return the box behind a side, without its borders; None for a very short side."""
    length = math.dist(a, b)
    if length <= 2.0 * _SLACK:
        return None
    ex, ey = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    far = length - _SLACK
    corners = [(_SLACK, _SLACK), (far, _SLACK), (far, _BEHIND), (_SLACK, _BEHIND)]
    return shapely.Polygon([(a[0] + s * ex + r * ey, a[1] + s * ey - r * ex) for s, r in corners])


def _ring(ring: Any) -> outlines.Outline:
    """Return the corners of a closed ring, counter-clockwise."""
    points = tuple((float(x) + 0.0, float(y) + 0.0) for x, y in ring.coords[:-1])
    return points if shapely.is_ccw(ring) else points[::-1]


def _closed(ring: Any) -> outlines.Outline:
    outline = _ring(ring)
    return (*outline, outline[0])
