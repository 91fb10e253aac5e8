"""Simpler outlines of a floor plan, without details that are too small."""

from __future__ import annotations

from typing import Any

import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields

#: Smaller pieces are rounding, m^2.
_LEAST_AREA = 1e-9
#: An outline that loses more of its area to simplification keeps its corners.
_MOST_LOSS = 0.5


def without_details(polygons: list[Any], spec: FloorPlanFields, small: list[Any]) -> list[Any]:
    """Return polygons without details that are too small, in a stable order.

    Args:
        small: what is left out because of its area is added.
    """
    least = max(spec.smallest, _LEAST_AREA)
    found = []
    for polygon in polygons:
        if polygon.area <= least:
            small += [polygon] if polygon.area > _LEAST_AREA else []
            continue
        polygon = simplified(polygon, 0.0 if spec.read_as == "ros_map" else spec.tolerance or 0.0)
        holes = [(h, shapely.Polygon(h)) for h in polygon.interiors]
        kept = [h for h, filled in holes if filled.area > spec.smallest]
        small += [f for _, f in holes if _LEAST_AREA < f.area <= spec.smallest]
        found.append(shapely.normalize(shapely.Polygon(polygon.exterior, kept)))
    return sorted(found, key=lambda p: (-p.area, *p.bounds))


def simplified(polygon: Any, tolerance: float) -> Any:
    """Return a polygon with fewer corners; thin parts that would collapse keep theirs."""
    if not tolerance:
        return polygon
    simple = shapely.simplify(polygon, tolerance, preserve_topology=True)
    rings = [polygon.exterior, *polygon.interiors]
    fewer = [simple.exterior, *simple.interiors]
    if len(rings) != len(fewer):
        return polygon
    chosen = [
        one if shapely.Polygon(other).area < _MOST_LOSS * shapely.Polygon(one).area else other
        for one, other in zip(rings, fewer, strict=True)
    ]
    found = shapely.Polygon(chosen[0], chosen[1:])
    return found if found.is_valid else polygon
