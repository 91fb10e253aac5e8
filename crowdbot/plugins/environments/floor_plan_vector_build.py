"""GeoJSON and WKT plans: geometries with their kind and storey."""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from shapely.geometry import shape as shape_of  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import InputError, did_you_mean, nearest
from crowdbot.plugin.for_environments import parse_foreign_json, valid_shape
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_properties_build import (
    in_small_letters,
    is_door,
    kind_of,
    label_of,
    levels_of,
    solid_by_another_name,
)
from crowdbot.plugins.environments.floor_plan_units_build import (
    UNITS,
    check_numbers,
    declared_crs,
    in_metres,
)
from crowdbot.plugins.environments.floor_plan_wkt_build import geometry_of

_LOG = logging.getLogger(__name__)
#: The values of the property ``kind``, and which of them are solid, floor, or neither.
_SOLID, _FLOOR, _NEITHER = ("obstacle", "wall"), ("walkable",), ("zone", "portal")
_KINDS = (*_FLOOR, *_SOLID, *_NEITHER)
_WITH_SIDES = ("Polygon", "MultiPolygon", "LineString", "MultiLineString", "GeometryCollection")
_POINTS = ("Point", "MultiPoint")
_LINES = ("LineString", "MultiLineString")
#: Geometries at heights that differ by more lie on different storeys, m.
_STOREY = 2.0
#: Part of the floor that may be covered twice without a warning.
_COVERED_TWICE = 0.25


@dataclass
class ImportedPlan:
    """The parsed plan: the walkable floor, and solids with their heights."""

    walkable: list[Any] = field(default_factory=list)
    solids: list[tuple[Any, tuple[float, float]]] = field(default_factory=list)


_Found = tuple[Any, dict[str, Any]]


def read_vector(spec: FloorPlanFields, text: str, name: str, unit_given: bool) -> ImportedPlan:
    """Return the plan in a text of WKT or GeoJSON.

    Args:
        spec: says which of both, and how numbers become metres.
        text: without a byte order mark.
        name: the file's name, for messages.
        unit_given: True if the document gives the unit.

    Raises:
        InputError: it is not a plan, or one of several storeys.
    """
    aside = Counter[str]()
    if spec.read_as == "wkt":
        found, crs = [(geometry_of(text, name), dict[str, Any]())], ""
    else:
        content = _from_json(text, name)
        found, crs = list(_features(content, name, aside)), declared_crs(content)
    return sorted_plan(found, spec, name, crs, unit_given, aside)


def sorted_plan(
    found: list[_Found], spec: FloorPlanFields, name: str, crs: str, unit_given: bool,
    aside: Counter[str] | None = None,
) -> ImportedPlan:  # fmt: skip
    """Return the floor and the solids among geometries.

    Args:
        found: geometries with their properties.
        spec: says how numbers become metres, and which storey is read.
        name: the file's name, for messages.
        crs: reference system that the file declares, or "".
        unit_given: True if the document gives the unit.
        aside: what was left out already.

    Raises:
        InputError: it is not a plan, or one of several storeys.
    """
    aside = Counter() if aside is None else aside
    if all(shape.is_empty for shape, _ in found):
        raise InputError(f"{name}: the plan is empty")
    found = [one for one in found if _is_of_place(*one, name, aside)]
    if aside:
        listed = ", ".join(
            f"{count} feature(s) {reason}" for reason, count in sorted(aside.items())
        )
        _LOG.warning("%s: left out: %s", name, listed)
    found = _on_one_storey([one for one in found if not one[0].is_empty], spec, name)
    check_numbers([shape for shape, _ in found], spec, name, crs, unit_given)
    if spec.polygons == "walkable" and (renamed := solid_by_another_name(p for _, p in found)):
        _LOG.warning(
            "%s: taken for floor: %s; only the property 'kind' makes solids", name, renamed
        )
    plan = ImportedPlan()
    for shape, properties in found:
        _sort_in(in_metres(shape, spec, name), properties, spec, plan, name)
    _check_cover(plan.walkable, name)
    _check_swallowed(found, plan.walkable, spec, name)
    return plan


def _from_json(text: str, name: str) -> Any:
    try:
        return parse_foreign_json(text)
    except ValueError as error:
        if _is_by_lines(text):
            raise InputError(
                f"{name}: has one feature in each line; make them a FeatureCollection: "
                "jq -s '{type: \"FeatureCollection\", features: .}' FILE > plan.geojson"
            ) from error
        raise InputError(f"{name}: is not JSON: {error}") from error


def _is_by_lines(text: str) -> bool:
    """Return True if the first line is a document of its own, as in newline-delimited GeoJSON."""
    first = next((line for line in text.removeprefix("\ufeff").splitlines() if line.strip()), "")
    try:
        return isinstance(parse_foreign_json(first.removeprefix("\x1e")), dict)
    except ValueError:
        return False


def _features(content: Any, name: str, aside: Counter[str]) -> Iterator[_Found]:
    """Yield each geometry with its properties; count what has no place."""
    kind = content.get("type") if isinstance(content, dict) else None
    if kind == "FeatureCollection":
        features = content.get("features")
        if not isinstance(features, list):
            raise InputError(f"{name}: is not GeoJSON: 'features' is not a list")
        if not features:
            raise InputError(f"{name}: the plan is empty: it has no features")
        for feature in features:
            yield from _features(feature, name, aside)
    elif kind == "Feature":
        properties, geometry = content.get("properties") or {}, content.get("geometry")
        if not isinstance(properties, dict):
            raise InputError(f"{name}: is not GeoJSON: a feature's properties are not an object")
        if geometry is None:
            aside["without geometry"] += 1
            return
        if (of_imdf := content.get("feature_type")) is not None:
            properties = {"feature_type": of_imdf, **properties}
        for shape, _ in _features(geometry, name, aside):
            yield shape, in_small_letters(properties)
    elif kind in (*_WITH_SIDES, *_POINTS):
        yield _geometry(content, name), {}
    else:
        near = did_you_mean(nearest(str(kind), ("FeatureCollection", "Feature", *_WITH_SIDES)))
        raise InputError(f"{name}: is not GeoJSON: a geometry has type {kind!r}{near}")


def _geometry(content: dict[str, Any], name: str) -> Any:
    """Return a geometry; members of a collection that are null are left out, heights unknown."""
    kind = content["type"]
    members = content.get("geometries")
    try:
        if kind == "GeometryCollection" and isinstance(members, list):
            content = {**content, "geometries": [_placed(m) for m in members if m is not None]}
        content = _placed(content)
        with np.errstate(invalid="ignore"):  # NaN is reported separately
            return shape_of(content)
    except Exception as error:  # shapely raises many types for wrong nesting
        raise InputError(f"{name}: a {kind} is damaged: {str(error).strip()}") from error


def _placed(content: Any) -> Any:
    """Return a geometry in which heights that are null are NaN."""
    if not isinstance(content, dict) or "coordinates" not in content:
        return content
    return {**content, "coordinates": _with_heights(content["coordinates"])}


def _with_heights(value: Any) -> Any:
    if isinstance(value, bool):
        raise ValueError(f"{str(value).lower()} is not a number")
    if not isinstance(value, list):
        return value
    if len(value) > 2 and isinstance(value[0], (int, float)):
        return [*value[:2], *(math.nan if height is None else height for height in value[2:3])]
    return [_with_heights(part) for part in value]


def _is_of_place(shape: Any, properties: dict[str, Any], name: str, aside: Counter[str]) -> bool:
    """Return True if a feature is floor or solid; count others that may have been meant as such.

    Raises:
        InputError: its kind is a misspelled one.
    """
    kind = kind_of(properties)
    if kind in _NEITHER:
        return False
    if kind and kind not in _KINDS:
        near = nearest(kind, _KINDS)
        if near:
            raise InputError(
                f"{name}: kind '{kind}' is not one of {', '.join(_KINDS)}{did_you_mean(near)}"
            )
        aside[f"of kind '{kind}' (known: {', '.join(_KINDS)})"] += 1
        return False
    if shape.geom_type in _POINTS:
        aside["that are points"] += 1
    elif kind in _FLOOR and shape.geom_type in _LINES:
        aside[f"of kind '{kind}' that are lines"] += 1
    elif not kind and shape.geom_type in _LINES and is_door(properties):
        aside["that are lines of doors or openings"] += 1
    elif shape.is_empty:
        aside["with an empty geometry"] += 1
    elif shape.length == 0.0:
        aside["without length"] += 1
    else:
        return True
    return False


# --------------------------------------------------------------------------------- storeys
def _on_one_storey(found: list[_Found], spec: FloorPlanFields, name: str) -> list[_Found]:
    """Return what lies on the chosen storey, or on none in particular.

    Raises:
        InputError: there are several and none is chosen, or the chosen one is missing.
    """
    labels = _labels(found, spec)
    counts = Counter(label for own in labels for label in own)
    known = ", ".join(f"'{label}' ({count})" for label, count in sorted(counts.items()))
    if spec.level is None:
        if len(counts) > 1:
            raise InputError(
                f"{name}: there are {len(counts)} storeys in it: {known}; write which 'level' to "
                "read"
            )
        return found
    level = label_of(spec.level)
    if level not in counts:
        near = did_you_mean(nearest(level, counts))
        listed = f"one of {known}" if counts else "in it; it names no storeys"
        raise InputError(f"{name}: level '{level}' is not {listed}{near}")
    return [one for one, own in zip(found, labels, strict=True) if not own or level in own]


def _labels(found: list[_Found], spec: FloorPlanFields) -> list[tuple[str, ...]]:
    """Return the storeys of each feature: named, or else by height if heights differ much."""
    named = [levels_of(properties) for _, properties in found]
    heights = [_height_of(shape) * UNITS.get(spec.unit, 1.0) for shape, _ in found]
    finite = [z for z in heights if math.isfinite(z)]
    if any(named) or not finite or max(finite) - min(finite) <= _STOREY:
        return named
    return [(label_of(round(z, 1)),) if math.isfinite(z) else () for z in heights]


def _height_of(shape: Any) -> float:
    """Return the mean height of a geometry's corners, or NaN without heights."""
    heights = shapely.get_coordinates(shape, include_z=True)[:, 2]
    heights = heights[np.isfinite(heights)]
    return float(heights.mean()) if len(heights) else math.nan


def _check_cover(walkable: Iterable[Any], name: str) -> None:
    """Warn if much of the floor is covered twice, as by storeys that are not named."""
    floors = [valid_shape(p) for p in walkable]
    once = shapely.union_all(floors).area if len(floors) > 1 else 0.0
    twice = sum(p.area for p in floors) - once
    if once and twice > _COVERED_TWICE * once:
        _LOG.warning(
            "%s: polygons of the floor lie upon each other, %.3g m² of it, and are joined; if "
            "they are storeys, keep one of them", name, twice,
        )  # fmt: skip


def _check_swallowed(
    found: Iterable[_Found], walkable: list[Any], spec: FloorPlanFields, name: str
) -> None:
    """Warn of polygons that say nothing about themselves and lie on the floor of another one."""
    if spec.polygons != "walkable" or len(walkable) < 2:
        return
    marked_floors = [properties for _, properties in found if kind_of(properties) in _FLOOR]
    floors = [valid_shape(p) for p in walkable]
    inner, outer = shapely.STRtree(floors).query(floors, predicate="within")
    areas = shapely.area(floors)
    swallowed = {int(i) for i, o in zip(inner, outer, strict=True) if areas[i] < areas[o]}
    if swallowed and not marked_floors:
        _LOG.warning(
            "%s: %d of its polygons lie within others and change nothing, since all are floor: "
            "obstacles have the property \"kind\": \"obstacle\", and rooms need no polygon around "
            "them", name, len(swallowed),
        )  # fmt: skip


# ------------------------------------------------------------------------ floor and solids
def _sort_in(
    shape: Any, properties: dict[str, Any], spec: FloorPlanFields, plan: ImportedPlan, name: str
) -> None:
    """Add a geometry to the floor or the solids."""
    kind = kind_of(properties)
    for part in shapely.get_parts(shape) if is_many(shape) else [shape]:
        if is_many(part):
            _sort_in(part, properties, spec, plan, name)
        elif part.geom_type in ("LineString", "LinearRing"):
            wall = shapely.buffer(part, 0.5 * spec.thickness, cap_style="flat", join_style="mitre")
            plan.solids.append((wall, _heights(properties, spec, name)))
        elif part.geom_type == "Polygon":
            solid = kind in _SOLID or (kind not in _FLOOR and spec.polygons == "obstacles")
            if solid:
                plan.solids.append((part, _heights(properties, spec, name)))
            else:
                plan.walkable.append(part)


def is_many(shape: Any) -> bool:
    """Return True if a geometry is a collection."""
    return bool(shape.geom_type.startswith("Multi") or shape.geom_type == "GeometryCollection")


def _heights(properties: dict[str, Any], spec: FloorPlanFields, name: str) -> tuple[float, float]:
    base, top = properties.get("base"), properties.get("height")
    try:
        base = 0.0 if base is None else float(base)
        top = spec.wall_height if top is None else float(top)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: base and height of an obstacle must be numbers") from error
    if not 0.0 <= base < top < math.inf:
        raise InputError(f"{name}: an obstacle has base {base:g} m and height {top:g} m")
    return base, top
