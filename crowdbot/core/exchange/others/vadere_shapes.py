"""Shapes of Vadere: rectangles, polygons and circles."""

from __future__ import annotations

import math
from dataclasses import dataclass

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.others.shapes import Corners, box, rectangle_in
from crowdbot.core.exchange.polygons import add_polygon
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Data, Draft

_FORMS = ("RECTANGLE", "POLYGON", "CIRCLE")


@dataclass(frozen=True, slots=True)
class VadereShape:
    """A shape of Vadere: a polygon or a circle.

    Attributes:
        corners: its outline, m; empty for a circle.
        circle: x, y and radius, m; None for others.
    """

    corners: Corners
    circle: tuple[float, float, float] | None = None


def read_shape(item: Item) -> VadereShape:
    """Return a shape.

    Raises:
        SpecError: E402, its type is unknown, or a number is missing.
    """
    kind = item.need("type").text()
    if kind not in _FORMS:
        item.need("type").refuse(f"no shape '{kind[:40]}'", _FORMS)
    if kind == "RECTANGLE":
        x, y = item.need("x").number(), item.need("y").number()
        w, h = item.need("width").number(1e-6), item.need("height").number(1e-6)
        return VadereShape([[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
    if kind == "CIRCLE":
        centre = item.need("center")
        at = centre.need("x").number(), centre.need("y").number()
        return VadereShape([], (*at, item.need("radius").number(1e-6)))
    points = [[p.need("x").number(), p.need("y").number()] for p in item.need("points").every()]
    if len(points) < 3:
        item.refuse("a polygon of fewer than 3 points")
    return VadereShape(points)


def read_area(item: Item, report: Report) -> Data:
    """Return a rectangle within a shape.

    Raises:
        SpecError: as `read_shape`.
    """
    shape = read_shape(item)
    if shape.circle is not None:
        x, y, radius = shape.circle
        half = math.sqrt(0.5) * radius
        report.interpreted(item, "area", "where an area is needed: the square in its circle")
        return box(x - half, x + half, y - half, y + half)
    found, how = rectangle_in(shape.corners)
    if how:
        report.interpreted(item, "area", f"where an area is needed: {how}")
    return found


def add_obstacle(item: Item, scene: Draft, report: Report) -> None:
    """Add an obstacle as a block, or as a pillar.

    Raises:
        SpecError: as `read_shape`.
    """
    shape = read_shape(item.need("shape"))
    if shape.circle is None:
        add_polygon(scene, report, item, shape.corners)
        return
    x, y, radius = shape.circle
    scene.part("pillars", "obstacle", {"x": x, "y": y, "radius": radius}, item.mark)
