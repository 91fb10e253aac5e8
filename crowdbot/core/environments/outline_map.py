"""An environment as polygons: the floor within its outer walls, and the obstacles on it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.types.arrays import Array, Point
from crowdbot.core.types.environment import EnvironmentParts

#: Number of sides of the polygon for a pillar.
_PILLAR_SIDES = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class OutlineMap:
    """Polygons of shapely, world frame, m.

    Attributes:
        floor: area enclosed by outer walls; empty on an open floor.
        lines: walls that do not enclose an area.
        line_heights: (L, 2) bottom and top of these, m.
        obstacles: obstacles that stand, lie or hang.
        heights: (O, 2) bottom and top of each obstacle, m.
    """

    floor: tuple[Any, ...]
    lines: tuple[Any, ...]
    line_heights: Array
    obstacles: tuple[Any, ...]
    heights: Array


def outline_map(parts: EnvironmentParts, inside: Iterable[Point]) -> OutlineMap:
    """Return the polygons of an environment.

    Args:
        inside: positions on the floor, such as zones and robots' starts; without any, all enclosed
            areas are floor.
    """
    outer = parts.walls[parts.stops_robot]
    rings, _, loose, _ = _polygonized(outer)
    points = [shapely.Point(p) for p in inside]
    floor = [r for r in rings if not points or any(r.intersects(p) for p in points)]
    obstacles, heights = _obstacles(parts)
    tops = parts.wall_heights[parts.stops_robot]
    usual = tops[0] if len(tops) else np.array([0.0, 2.5])
    return OutlineMap(
        floor=tuple(floor),
        lines=tuple(loose),
        line_heights=np.tile(usual, (len(loose), 1)),
        obstacles=tuple(obstacles),
        heights=np.array(heights, np.float64).reshape(-1, 2),
    )


def floor_points(found: OutlineMap) -> list[tuple[float, float]]:
    """Return a position on every part of the floor that obstacles leave, m."""
    left = shapely.union_all(found.floor).difference(shapely.union_all(found.obstacles))
    points = [p.representative_point() for p in shapely.get_parts(left)]
    return [(p.x, p.y) for p in points if not p.is_empty]


def to_geojson(
    found: OutlineMap, zones: Mapping[str, Array], portals: Mapping[str, tuple[float, ...]]
) -> str:
    """Return the map as GeoJSON, which the environment ``floor_plan`` can read."""
    features = [_feature(p, {"kind": "walkable"}) for p in found.floor]
    for shapes, heights in ((found.obstacles, found.heights), (found.lines, found.line_heights)):
        for shape, (base, top) in zip(shapes, heights.tolist(), strict=True):
            features.append(_feature(shape, {"kind": "obstacle", "base": base, "height": top}))
    for name, corners in zones.items():
        features.append(_feature(shapely.Polygon(corners), {"kind": "zone", "name": name}))
    for name, (x0, x1, y0, y1) in portals.items():
        box = shapely.box(x0, y0, x1, y1)
        features.append(_feature(box, {"kind": "portal", "name": name}))
    content = {"type": "FeatureCollection", "features": features}
    return json.dumps(content, indent=1) + "\n"


def _feature(shape: Any, properties: dict[str, Any]) -> dict[str, Any]:
    geometry = json.loads(shapely.to_geojson(shapely.normalize(shape)))
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def _polygonized(walls: Array) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
    """Return closed rings of walls, cuts, open walls, and invalid rings."""
    lines = shapely.linestrings(walls.reshape(-1, 2, 2))
    noded = shapely.union_all(lines)
    parts = shapely.get_parts(noded)
    found = shapely.polygonize_full(parts)
    rings, cuts, dangles, invalid = ([*shapely.get_parts(group)] for group in found)
    return rings, cuts, [*dangles, *cuts], invalid


def _obstacles(parts: EnvironmentParts) -> tuple[list[Any], list[tuple[float, float]]]:
    """Return pieces merged by equal heights, and pillars as polygons around them."""
    shapes, heights = list[Any](), list[tuple[float, float]]()
    rows = [tuple(row) for row in parts.solid_heights.tolist()]
    for own in dict.fromkeys(rows):
        pieces = [shapely.Polygon(s) for s, r in zip(parts.solids, rows, strict=True) if r == own]
        for shape in shapely.get_parts(shapely.union_all(pieces)):
            shapes.append(shapely.remove_repeated_points(shapely.normalize(shape)))
            heights.append((own[0], own[1]))
    angles = (np.arange(_PILLAR_SIDES) + 0.5) * (2.0 * math.pi / _PILLAR_SIDES)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) / math.cos(math.pi / _PILLAR_SIDES)
    for (x, y, radius), (base, top) in zip(
        parts.pillars.tolist(), parts.pillar_heights.tolist(), strict=True
    ):
        shapes.append(shapely.Polygon([x, y] + radius * circle))
        heights.append((base, top))
    return shapes, heights
