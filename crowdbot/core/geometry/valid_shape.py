"""Repair of invalid polygons in files of other programs."""

from __future__ import annotations

from typing import Any


def valid_shape(shape: Any) -> Any:
    """Return a valid geometry of shapely in which holes stay holes, and parts are joined.

    Holes may touch or leave their outline, and parts may overlap: by the lines alone, as GEOS
    does it, such holes become part of the whole, and overlaps become holes.
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
