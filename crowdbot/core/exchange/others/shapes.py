"""Shapes of other simulators as rectangles and outlines of crowdbot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.scene import Data
from crowdbot.core.geometry.valid_shape import valid_shape

Corners = list[list[float]]


def rectangle_in(corners: Sequence[Sequence[float]], floor: Any = None) -> tuple[Data, str]:
    """Return a rectangle along the axes within an outline, and how it was found.

    The outline's own bounds, if it is a rectangle along the axes; else the square in the largest
    circle that fits.

    Args:
        corners: the outline, m.
        floor: polygon of shapely that the rectangle has to lie in, where the two overlap.
    """
    from shapely import Polygon, maximum_inscribed_circle  # type: ignore[import-untyped,unused-ignore]

    polygon = valid_shape(Polygon([(c[0], c[1]) for c in corners]))
    if floor is not None:
        common = polygon.intersection(floor)
        parts = [part for part in getattr(common, "geoms", [common]) if part.area > 1e-6]
        polygon = max(parts, key=lambda part: part.area, default=polygon)
    if polygon.is_empty:
        xs, ys = [c[0] for c in corners], [c[1] for c in corners]
        return box(min(xs), max(xs), min(ys), max(ys)), ""
    x0, y0, x1, y1 = polygon.bounds
    if polygon.area >= 0.999 * (x1 - x0) * (y1 - y0):
        return box(x0, x1, y0, y1), ""
    circle = maximum_inscribed_circle(polygon, tolerance=0.01)
    (x, y), half = circle.coords[0], 0.7071 * circle.length
    return box(x - half, x + half, y - half, y + half), "the square in its largest circle"


def box(x0: float, x1: float, y0: float, y1: float) -> Data:
    """Return a rectangle as scenarios write it, rounded to micrometres."""
    return {"x": [round(x0, 6), round(x1, 6)], "y": [round(y0, 6), round(y1, 6)]}


def area_of(rectangle: Data) -> Data:
    """Return a rectangle of a floor as an area that is written in a stream or spawn."""
    (x0, x1), (y0, y1) = rectangle["x"], rectangle["y"]
    return {
        "centre": [round(0.5 * (x0 + x1), 6), round(0.5 * (y0 + y1), 6)],
        "size": [round(x1 - x0, 6), round(y1 - y0, 6)],
    }


def middle(area: Data) -> list[float]:
    """Return the middle of a rectangle, m."""
    return [0.5 * (area["x"][0] + area["x"][1]), 0.5 * (area["y"][0] + area["y"][1])]


def size(area: Data) -> float:
    """Return the area of a rectangle, m^2."""
    return float((area["x"][1] - area["x"][0]) * (area["y"][1] - area["y"][0]))


def pairs(item: Item, least: int = 3) -> Corners:
    """Return a list of points ``[x, y]``, without the last if it repeats the first.

    Raises:
        SpecError: E402, it is not such a list, or has too few points.
    """
    found = []
    for point in item.every():
        numbers = [part.number() for part in point.every()]
        if len(numbers) != 2:
            point.refuse(f"a point has {len(numbers)} numbers, not 2")
        found.append(numbers)
    if len(found) > 1 and found[0] == found[-1]:
        found.pop()
    if len(found) < least:
        item.refuse(f"{len(found)} points, and at least {least} are needed")
    return found
