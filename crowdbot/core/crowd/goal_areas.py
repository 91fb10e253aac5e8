"""Rotatable rectangles of the floor: goals entered at any point, and entrances."""

from __future__ import annotations

import math

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import record_type


class PlaceRecord:
    """A point or area of a route, or an entrance.

    Attributes:
        x, y: middle, m.
        width, height: size along its own x and y, m; zeros: the point itself.
        turn: its rotation, rad.
        pause: how long people stay there, s.
    """

    x: float
    y: float
    width: float
    height: float
    turn: float
    pause: float


PLACE = record_type(PlaceRecord)


@kernel
def point_in_area(
    x: float, y: float, area: PlaceRecord, margin: float, u: float, v: float
) -> tuple[float, float]:
    """Return the point of a shrunk area at fractions u and v of its own x and y.

    Args:
        x, y: middle of the area, m.
        area: its size.
        margin: distance from its sides where there is room, m.
    """
    a = (2.0 * u - 1.0) * max(0.0, 0.5 * area.width - margin)
    b = (2.0 * v - 1.0) * max(0.0, 0.5 * area.height - margin)
    c, s = math.cos(area.turn), math.sin(area.turn)
    return x + c * a - s * b, y + s * a + c * b


@kernel
def into_area(
    px: float, py: float, x: float, y: float, area: PlaceRecord, margin: float
) -> tuple[float, float]:
    """Return the nearest point to p in a shrunk area, in the area's own frame, m."""
    c, s = math.cos(area.turn), math.sin(area.turn)
    a, b = c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)
    ha, hb = max(0.0, 0.5 * area.width - margin), max(0.0, 0.5 * area.height - margin)
    a, b = min(max(a, -ha), ha), min(max(b, -hb), hb)
    return x + c * a - s * b, y + s * a + c * b


@kernel
def area_fraction(
    x0: float, y0: float, x1: float, y1: float, x: float, y: float, area: PlaceRecord
) -> float:
    """Return the fraction of the way from p0 to p1 at which an area is entered.

    Above 1 if never.
    """
    c, s = math.cos(area.turn), math.sin(area.turn)
    a0, b0 = c * (x0 - x) + s * (y0 - y), c * (y0 - y) - s * (x0 - x)
    a1, b1 = c * (x1 - x) + s * (y1 - y), c * (y1 - y) - s * (x1 - x)
    enter, leave = 0.0, 1.0
    for start, step, half in ((a0, a1 - a0, 0.5 * area.width), (b0, b1 - b0, 0.5 * area.height)):
        if step == 0.0:
            if abs(start) > half:
                return 2.0
            continue
        one, other = (-half - start) / step, (half - start) / step
        enter, leave = max(enter, min(one, other)), min(leave, max(one, other))
    return enter if enter <= leave else 2.0
