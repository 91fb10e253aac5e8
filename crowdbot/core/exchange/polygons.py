"""Imported polygons and lines as blocks and walls of a floor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Draft

#: Points this near to a line are on it, m; thickness of what has no area, m.
_LEAST, THIN = 1e-6, 0.02
Corner = Sequence[float]


def add_polygon(
    scene: Draft,
    report: Report,
    item: Item,
    corners: Sequence[Corner],
    name: str = "obstacle",
) -> None:
    """Add an outline as a block, or as thin walls where it has no area."""
    points = without_repeats(corners)
    if len(points) < 2:
        report.left_out(item, "an obstacle of fewer than two points", whole=False)
        return
    far = max(points, key=lambda p: math.dist(p, points[0]))
    end = max(points, key=lambda p: math.dist(p, far))
    if not all(_beside(p, far, end) <= _LEAST for p in points):
        _add_block(scene, report, item, points, name)
        return
    note = f"it has no area: a wall {THIN * 100:g} cm thick along its points"
    report.interpreted(item, "environment.walls", note)
    add_wall(scene, item, far, end, name=name)


def _add_block(
    scene: Draft, report: Report, item: Item, points: Sequence[Corner], name: str
) -> None:
    """Add an outline as a block; split one that crosses itself into the parts that it encloses."""
    from shapely import Polygon, make_valid  # type: ignore[import-untyped,unused-ignore]

    whole = Polygon([(p[0], p[1]) for p in points])
    if whole.is_valid:
        scene.part("blocks", name, {"corners": [list(p) for p in points]}, item.mark)
        return
    valid = make_valid(whole)
    parts = [one for part in getattr(valid, "geoms", [valid])
             for one in getattr(part, "geoms", [part])
             if one.geom_type == "Polygon" and one.area > _LEAST]  # fmt: skip
    for part in parts:
        corners = without_repeats([list(p) for p in part.exterior.coords])
        scene.part("blocks", name, {"corners": corners}, item.mark)
    if not parts:
        for start, end in pairwise([*points, points[0]]):
            add_wall(scene, item, start, end, name=name)
        note = f"its outline encloses nothing: walls {THIN * 100:g} cm thick along its points"
        report.interpreted(item, "environment.walls", note)
        return
    note = f"its outline crosses or touches itself: the {len(parts)} parts that it encloses"
    report.interpreted(item, "environment.blocks", note)


def _beside(point: Corner, start: Corner, end: Corner) -> float:
    """Return the distance of a point from a line, m."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    cross = dx * (point[1] - start[1]) - dy * (point[0] - start[0])
    return abs(cross) / math.hypot(dx, dy)


def add_wall(
    scene: Draft, item: Item, start: Corner, end: Corner, thickness: float = THIN,
    name: str = "wall",
) -> None:  # fmt: skip
    """Add a straight wall."""
    value = {"start": list(start), "end": list(end), "thickness": thickness}
    scene.part("walls", name, value, item.mark)


def without_repeats(corners: Sequence[Corner]) -> list[Corner]:
    """Return corners without consecutive duplicates, around the closed outline."""
    found: list[Corner] = []
    for corner in corners:
        if not found or math.dist(corner, found[-1]) > 1e-9:
            found.append(corner)
    while len(found) > 1 and math.dist(found[0], found[-1]) <= 1e-9:
        found.pop()
    return found


def area(points: Sequence[Corner]) -> float:
    """Return the signed area of an outline, m^2."""
    following = [*points[1:], points[0]]
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, following, strict=True))
