"""Read, repair and simplify floor plans."""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from shapely.geometry import shape as shape_of  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.support.strict_json import DEEPEST, parse_foreign_json
from crowdbot.core.support.text_files import input_text
from crowdbot.plugin import Face, InputError, Place, Solid, outlines
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_units_build import (
    check_numbers,
    check_place,
    declared_crs,
    in_metres,
    moved,
)
from crowdbot.plugins.environments.ros_map_build import (
    free_cells,
    outline_cells,
    read_grey,
    read_map,
)

_LOG = logging.getLogger(__name__)
#: Largest file of a vector plan, bytes.
_LARGEST = 8_000_000
#: Largest number of corners that can be simulated.
MOST_CORNERS = 20_000
#: Largest length or width of a plan, m; the usual cause of more is a wrong unit.
MOST_SIDE = 5_000.0
#: Coordinates are rounded to multiples of this, so that shapely gives the same result everywhere,
#: m.
_GRID = 1e-6


@dataclass
class _Plan:
    """The parsed plan: the walkable floor, and solids with their heights."""

    walkable: list[Any] = field(default_factory=list)
    solids: list[tuple[Any, tuple[float, float]]] = field(default_factory=list)


def place_of(spec: FloorPlanFields) -> Place:
    """Return the walls of a plan.

    Raises:
        InputError: its file cannot be read, or is not a plan.
    """
    file = None if spec.file is None else spec.file.file
    image = None if spec.image is None else spec.image.file
    words = spec.model_dump_json(exclude={"zones", "portals"})
    stamps = tuple(map(_stamp, (file, image)))
    return _place_of(words, type(spec), (file, image), stamps, "unit" in spec.model_fields_set)


def _stamp(file: Path | None) -> tuple[int, int]:
    """Return modification time and size, which change with a file that has no hash."""
    if file is None:
        return 0, 0
    found = file.stat()
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=8)
def _place_of(
    words: str,
    model: type[FloorPlanFields],
    files: tuple[Path | None, Path | None],
    stamps: tuple[tuple[int, int], ...],
    told_unit: bool,
) -> Place:
    del stamps  # part of the cache's key
    file, image = files
    spec = model.model_validate_json(words)
    name = "wkt" if file is None else file.name
    plan = _read(spec, file, image, name, told_unit)
    floor = shapely.union_all([_repaired(p, name) for p in plan.walkable])
    floor = _simple(_polygons(floor), spec, name)
    solids = [
        (part, heights)
        for shape, heights in plan.solids
        for part in _simple(_polygons(_repaired(shape, name)), spec, name)
    ]
    count = sum(shapely.get_num_coordinates(p) for p in (*floor, *(s for s, _ in solids)))
    if not count:
        raise InputError(f"{name}: there is neither a floor nor a wall in it{_too_small(plan)}")
    if count > MOST_CORNERS:
        raise InputError(
            f"{name}: the plan has {count} corners, more than {MOST_CORNERS}; raise 'tolerance' "
            "or 'least_area', or cut a part out of it"
        )
    _check_size(floor, spec, name)
    check_place([*floor, *(s for s, _ in solids)], spec, name)
    heights = (0.0, spec.wall_height)
    return Place(
        faces=tuple(_face(p, heights) for p in floor),
        solids=(
            *(Solid(outline=_ring(h), heights=heights) for p in floor for h in p.interiors),
            *(
                Solid(
                    outline=_ring(s.exterior),
                    holes=tuple(_ring(hole) for hole in s.interiors),
                    heights=own,
                )
                for s, own in solids
            ),
        ),
    )


def _too_small(plan: _Plan) -> str:
    """Describe a plan that is smaller than the smallest kept detail; usually the unit is wrong."""
    shapes = [*plan.walkable, *(shape for shape, _ in plan.solids)]
    if not shapes:
        return ""
    width, height = _size(shapes)
    return f"; all of it is {width:.3g} m × {height:.3g} m and left away: see 'unit'"


def _check_size(floor: list[Any], spec: FloorPlanFields, name: str) -> None:
    """Refuse a floor that is larger than any simulated crowd needs."""
    width, height = _size(floor) if floor else (0.0, 0.0)
    if max(width, height) > MOST_SIDE:
        raise InputError(
            f"{name}: the plan is {width:.6g} m × {height:.6g} m, more than {MOST_SIDE:g} m; its "
            f"numbers count as {spec.unit}: see 'unit'"
        )


def _size(shapes: list[Any]) -> tuple[float, float]:
    x0, y0, x1, y1 = shapely.total_bounds(shapes)
    return float(x1 - x0), float(y1 - y0)


def _read(
    spec: FloorPlanFields, file: Path | None, image: Path | None, name: str, told_unit: bool
) -> _Plan:
    if spec.read_as == "ros_map":
        return _Plan(walkable=[_read_ros_map(spec, file, image)])
    text = spec.wkt or "" if file is None else input_text(file, _LARGEST, name)
    if spec.read_as == "wkt":
        found, crs = [(_from_wkt(text, name), dict[str, Any]())], ""
    else:
        content = _from_json(text, name)
        found, crs = list(_features(content, name)), declared_crs(content)
    check_numbers([shape for shape, _ in found], spec, name, crs, told_unit)
    plan = _Plan()
    for shape, properties in found:
        _sort_in(in_metres(shape, spec, name), properties, spec, plan, name)
    return plan


def _read_ros_map(spec: FloorPlanFields, file: Path | None, image: Path | None) -> Any:
    assert file is not None  # the document's validation checked this
    found = read_map(file)
    grey = read_grey(image or file.parent / found.image, see_through=found.mode == "scale")
    cells = free_cells(found, grey, unknown_is_free=spec.unknown == "free")
    if not cells.any():
        raise InputError(f"{file.name}: no cell of its image is free")
    shape = outline_cells(cells, found)
    if spec.origin != (0.0, 0.0) or spec.rotation:
        shape = shapely.transform(shape, lambda points: moved(points, spec))
    tolerance = found.resolution if spec.tolerance is None else spec.tolerance
    return shapely.simplify(shape, tolerance, preserve_topology=True)


# ------------------------------------------------------------------------- vector formats
def _from_wkt(text: str, name: str) -> Any:
    _check_depth(text, name)
    try:
        return shapely.from_wkt(text.strip())
    except shapely.errors.ShapelyError as error:
        raise InputError(f"{name}: is not well-known text: {error}") from error


def _check_depth(text: str, name: str) -> None:
    """Refuse geometries that are nested deeper than the library's stack allows."""
    depth = 0
    for found in re.finditer(r"[()]", text):
        depth += 1 if found[0] == "(" else -1
        if depth > DEEPEST:
            line = text.count("\n", 0, found.start()) + 1
            column = found.start() - text.rfind("\n", 0, found.start())
            raise InputError(
                f"{name}: line {line}, column {column}: nested deeper than {DEEPEST} brackets"
            )


def _from_json(text: str, name: str) -> Any:
    try:
        return parse_foreign_json(text)
    except ValueError as error:
        raise InputError(f"{name}: is not JSON: {error}") from error


def _features(content: Any, name: str) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield each geometry with its properties."""
    kind = content.get("type") if isinstance(content, dict) else None
    if kind == "FeatureCollection":
        for feature in content.get("features") or ():
            yield from _features(feature, name)
    elif kind == "Feature":
        for shape, _ in _features(content.get("geometry"), name):
            yield shape, dict(content.get("properties") or {})
    elif kind in ("Polygon", "MultiPolygon", "LineString", "MultiLineString", "GeometryCollection"):
        try:
            with np.errstate(invalid="ignore"):  # NaN is reported separately
                shape = shape_of(content)
            yield shape, {}
        except Exception as error:  # shapely raises many types for wrong nesting
            raise InputError(f"{name}: a {kind} is damaged: {error}") from error
    elif kind not in ("Point", "MultiPoint"):
        raise InputError(f"{name}: is not GeoJSON: a geometry has type {kind!r}")


def _sort_in(
    shape: Any, properties: dict[str, Any], spec: FloorPlanFields, plan: _Plan, name: str
) -> None:
    """Add a geometry to the floor or the solids; zones and portals are ignored."""
    kind = properties.get("kind", "")
    if kind in ("zone", "portal"):
        return
    for part in shapely.get_parts(shape) if _is_many(shape) else [shape]:
        if _is_many(part):
            _sort_in(part, properties, spec, plan, name)
        elif part.geom_type in ("LineString", "LinearRing"):
            wall = shapely.buffer(part, 0.5 * spec.thickness, cap_style="flat", join_style="mitre")
            plan.solids.append((wall, _heights(properties, spec, name)))
        elif part.geom_type == "Polygon":
            solid = kind == "obstacle" or (kind != "walkable" and spec.polygons == "obstacles")
            if solid:
                plan.solids.append((part, _heights(properties, spec, name)))
            else:
                plan.walkable.append(part)


def _is_many(shape: Any) -> bool:
    return bool(shape.geom_type.startswith("Multi") or shape.geom_type == "GeometryCollection")


def _heights(properties: dict[str, Any], spec: FloorPlanFields, name: str) -> tuple[float, float]:
    try:
        base = float(properties.get("base", 0.0))
        top = float(properties.get("height", spec.wall_height))
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: base and height of an obstacle must be numbers") from error
    if not 0.0 <= base < top < math.inf:
        raise InputError(f"{name}: an obstacle has base {base:g} m and height {top:g} m")
    return base, top


# ----------------------------------------------------------------------------- polygons
def _repaired(shape: Any, name: str) -> Any:
    """Return a valid geometry on a grid, with a warning if it was repaired."""
    if not shapely.is_valid(shape):
        why = shapely.is_valid_reason(shape)
        _LOG.warning("%s: an outline was repaired: %s", name, why)
        shape = shapely.make_valid(shape)
    return shapely.set_precision(shape, _GRID)


def _polygons(shape: Any) -> list[Any]:
    parts = shapely.get_parts(shape)
    nested = [shapely.get_parts(p) for p in parts]
    return [p for group in nested for p in group if p.geom_type == "Polygon" and not p.is_empty]


def _simple(polygons: list[Any], spec: FloorPlanFields, name: str) -> list[Any]:
    """Return polygons without details that are too small, in a stable order."""
    del name
    found = []
    for polygon in polygons:
        if spec.tolerance and spec.read_as != "ros_map":
            polygon = shapely.simplify(polygon, spec.tolerance, preserve_topology=True)
        if polygon.area <= max(spec.least_area, 1e-9):
            continue
        holes = [h for h in polygon.interiors if shapely.Polygon(h).area > spec.least_area]
        found.append(shapely.normalize(shapely.Polygon(polygon.exterior, holes)))
    return sorted(found, key=lambda p: (-p.area, *p.bounds))


def _ring(ring: Any) -> outlines.Outline:
    """Return the corners of a closed ring, counter-clockwise."""
    points = tuple((float(x) + 0.0, float(y) + 0.0) for x, y in ring.coords[:-1])
    return points if shapely.is_ccw(ring) else points[::-1]


def _face(polygon: Any, heights: tuple[float, float]) -> Face:
    outline = _ring(polygon.exterior)
    return Face(points=(*outline, outline[0]), heights=heights)
