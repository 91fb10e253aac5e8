"""Repair of invalid polygons in files of other programs."""

from __future__ import annotations

from typing import Any


def valid_shape(shape: Any) -> Any:
    """Return a valid geometry of shapely in which holes stay holes, and parts are joined.

    Holes may touch or cross their outline, and parts may overlap. GEOS, which considers the lines
    alone, would turn such holes into parts, and overlaps into holes.
    """
    import shapely  # type: ignore[import-untyped,unused-ignore]

    if shapely.is_valid(shape):
        return shape
    if shape.geom_type != "Polygon":
        parts = list(getattr(shape, "geoms", []))
        if not parts:
            return shapely.make_valid(shape)
        return shapely.union_all([valid_shape(part) for part in parts])
    outer = shapely.make_valid(shapely.Polygon(shape.exterior))
    holes = [shapely.make_valid(shapely.Polygon(hole)) for hole in shape.interiors]
    return outer.difference(shapely.union_all(holes))
