"""DXF drawings: entities that are floor or walls, as geometries with properties."""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from typing import Any

import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import InputError, did_you_mean, nearest
from crowdbot.plugins.environments.floor_plan_dxf_file_build import entities, hidden, opened
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_units_build import UNITS

_LOG = logging.getLogger(__name__)
#: Entities whose course is followed; others are left out, and named.
_CURVES = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE", "SOLID", "TRACE")
#: Values of the header variable $INSUNITS that are units of documents too.
_INSUNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
#: Others -> m. No building is drawn in the rest, from angstroms to parsecs.
_RARE_UNITS = {
    7: 1000.0, 10: 0.9144, 14: 0.1, 15: 10.0, 16: 100.0,
    21: 1200 / 3937, 22: 100 / 3937, 23: 3600 / 3937,
}  # fmt: skip
#: Largest distance between a curve and its chords, m.
_CHORD = 0.01
#: Ends this near are the same point, in parts of the drawing's unit.
_CLOSED = 1e-6
#: Outlines that differ by less than this part of their area are one, such as a hatch and its edge.
_SAME = 1e-6
#: An entity whose normal leans more than this from the vertical stands upright.
_FLAT = 0.999

_Found = tuple[Any, dict[str, Any]]
_Point = tuple[float, float, float]


def read_dxf(
    spec: FloorPlanFields, file: Path, most: int, unit_given: bool
) -> tuple[list[_Found], FloorPlanFields]:
    """Return the geometries of a drawing, and the fields with the unit of their numbers.

    What is left out is counted in one warning.

    Args:
        spec: says which layers mean what.
        file: the drawing, ASCII or binary.
        most: largest size, bytes.
        unit_given: True if the document gives the unit.

    Raises:
        InputError: it is not a drawing, its unit is not known, ezdxf is not installed, or a named
            layer is not there.
    """
    drawing = opened(file, most)
    spec, scale = _with_unit(drawing, spec, file.name, unit_given)
    aside, seen = Counter[str](), set[str]()
    chord = _CHORD / UNITS.get(spec.unit, 1.0) / scale
    outlines: dict[tuple[str, str, float], list[tuple[Any, str]]] = {}
    found: list[_Found] = []
    for entity in entities(drawing, file.name, aside):
        layer = str(entity.dxf.get("layer", "0"))
        seen.add(layer)
        meaning = _meaning(drawing, layer, spec, aside)
        if not meaning:
            continue
        for shape in _shapes(entity, chord, aside):
            closed = shape.geom_type == "Polygon"
            if closed and meaning != "walls":
                height = round(float(shape.exterior.coords[0][2]), 6)
                # without `layers` an outline is a hole whatever its layer
                group = ("" if meaning == "any" else layer, meaning, height)
                outlines.setdefault(group, []).append((shape, layer))
            else:
                line = shape.exterior if closed else shape
                found.append((line, {"layer": layer, "kind": "wall"}))
    for (_, meaning, _), rings in outlines.items():
        found += [(shape, {"layer": layer, **_KINDS[meaning]}) for shape, layer in _nested(rings)]
    _check_layers(drawing, seen, spec, file.name)
    listed = ", ".join(f"{count} {name}" for name, count in sorted(aside.items()))
    if aside and not found:
        raise InputError(f"{file.name}: nothing in it can be read: it has {listed}")
    if aside:
        _LOG.warning("%s: left out: %s", file.name, listed)
    return [(_scaled(shape, scale), about) for shape, about in found], spec


#: Meaning of a layer -> properties as GeoJSON writes them; none: as `polygons` says.
_KINDS: dict[str, dict[str, str]] = {
    "floor": {"kind": "walkable"}, "obstacles": {"kind": "obstacle"}, "any": {},
}  # fmt: skip


def _scaled(shape: Any, scale: float) -> Any:
    if scale == 1.0:
        return shape
    return shapely.transform(shape, lambda points: scale * points, include_z=True)


def _with_unit(
    drawing: Any, spec: FloorPlanFields, name: str, unit_given: bool
) -> tuple[FloorPlanFields, float]:
    """Return the fields with the drawing's unit, unless the document gives one, and a factor.

    Raises:
        InputError: the drawing's unit is none of buildings.
    """
    code = int(drawing.header.get("$INSUNITS", 0))
    declared = _INSUNITS.get(code)
    if unit_given:
        if declared is not None and declared != spec.unit:
            _LOG.warning(
                "%s: the drawing declares %s, the document says %s, which counts",
                *(name, declared, spec.unit),
            )
        return spec, 1.0
    if declared is not None:
        return spec.model_copy(update={"unit": declared}), 1.0
    if code == 0:
        _LOG.warning("%s: declares no unit; its numbers count as m: see 'unit'", name)
        return spec, 1.0
    if code not in _RARE_UNITS:
        raise InputError(
            f"{name}: declares a unit that no building is drawn in ($INSUNITS {code}); "
            "write 'unit', such as unit: mm"
        )
    return spec.model_copy(update={"unit": "m"}), _RARE_UNITS[code]


def _meaning(drawing: Any, layer: str, spec: FloorPlanFields, aside: Counter[str]) -> str:
    """Return what a layer holds, such as floor or walls; "" if it is left out."""
    if hidden(drawing, layer):
        aside[f"on layer '{layer}', which is off"] += 1
        return ""
    if not spec.layers:
        return "any"
    for pattern, meaning in spec.layers.items():
        if fnmatchcase(layer.lower(), pattern.lower()):
            if meaning == "ignore":
                return ""
            return meaning
    aside[f"on layer '{layer}', which 'layers' does not name"] += 1
    return ""


def _check_layers(drawing: Any, seen: set[str], spec: FloorPlanFields, name: str) -> None:
    """Refuse patterns that no layer matches.

    Raises:
        InputError: naming the nearest layer.
    """
    known = sorted(seen | {str(layer.dxf.name) for layer in drawing.layers})
    for pattern in spec.layers:
        if not any(fnmatchcase(layer.lower(), pattern.lower()) for layer in known):
            near = did_you_mean(nearest(pattern, known))
            raise InputError(
                f"{name}: no layer is called '{pattern}'{near or '; there are ' + ', '.join(known)}"
            )


def _shapes(entity: Any, chord: float, aside: Counter[str]) -> Iterator[Any]:
    """Yield polygons for closed entities and lines for others; count unusable ones in ``aside``."""
    kind = entity.dxftype()
    if kind not in (*_CURVES, "HATCH"):
        aside[f"{kind} entities"] += 1
    elif kind == "POLYLINE" and (entity.is_poly_face_mesh or entity.is_polygon_mesh):
        aside["POLYLINE entities that are surfaces"] += 1
    elif kind in ("ARC", "CIRCLE", "LWPOLYLINE", "HATCH") and not _lies_flat(entity):
        aside[f"{kind} entities that stand upright"] += 1
    else:
        try:
            shapes = [shape for course in _courses(entity, chord) for shape in _shape(course)]
        except (TypeError, ValueError, ArithmeticError, LookupError):  # no radius, no knots
            shapes = []
        if not shapes:
            aside[f"{kind} entities that are damaged or have no length"] += 1
        if kind == "LWPOLYLINE" and entity.has_width:
            aside["widths of LWPOLYLINE entities"] += 1
        yield from shapes


def _courses(entity: Any, chord: float) -> Iterator[list[_Point]]:
    """Yield the corners of an entity's polylines, at most ``chord`` away from its curves."""
    from ezdxf import path as paths

    if entity.dxftype() == "SPLINE" and _is_periodic(entity):
        yield _periodic(entity, chord)
        return
    found = paths.from_hatch(entity) if entity.dxftype() == "HATCH" else [paths.make_path(entity)]
    for course in found:
        for part in course.sub_paths() if course.has_sub_paths else (course,):
            yield [(p.x, p.y, p.z) for p in part.flattening(chord, segments=8)]


def _is_periodic(spline: Any) -> bool:
    """Return True if the curve is defined between inner knots only, as closed ones are."""
    knots, degree = spline.knots, spline.dxf.degree
    known = len(knots) > 2 * degree
    return bool(known and (knots[0] != knots[degree] or knots[-1] != knots[-1 - degree]))


def _periodic(spline: Any, chord: float) -> list[_Point]:
    """Return the corners of a spline between its inner knots; ezdxf goes beyond them."""
    curve, degree = spline.construction_tool(), spline.dxf.degree
    inner = sorted(set(spline.knots[degree : len(spline.knots) - degree]))
    for parts in (8, 16, 32, 64, 128):
        steps = [a + (b - a) * i / parts for a, b in pairwise(inner) for i in range(parts)]
        points = [(p.x, p.y, p.z) for p in curve.points([*steps, inner[-1]])]
        if max(map(_bend, points, points[1:], points[2:])) <= chord:
            break
    if math.dist(points[0], points[-1]) <= chord:
        points[-1] = points[0]
    return points


def _bend(one: _Point, two: _Point, three: _Point) -> float:
    """Return the distance of the middle point from the middle of the others."""
    return math.dist(two, [(a + b) / 2 for a, b in zip(one, three, strict=True)])


def _lies_flat(entity: Any) -> bool:
    x, y, z = entity.dxf.get("extrusion", (0.0, 0.0, 1.0))
    return bool(abs(z) >= _FLAT * math.hypot(x, y, z))


def _shape(points: list[_Point]) -> Iterator[Any]:
    different = len({point[:2] for point in points})
    if different < 2:
        return
    ends = max(abs(a - b) for a, b in zip(points[0], points[-1], strict=True))
    size = max(abs(v) for p in points for v in p)
    if different >= 3 and ends <= _CLOSED * max(size, 1.0):
        yield shapely.Polygon(points)
    else:
        yield shapely.LineString(points)


def _nested(rings: Iterable[tuple[Any, str]]) -> Iterator[tuple[Any, str]]:
    """Yield areas between outlines: one that lies inside another is its hole, and so on."""
    ordered = _once(sorted(rings, key=lambda ring: -ring[0].area))
    valid = [ring if ring.is_valid else shapely.make_valid(ring) for ring, _ in ordered]
    depth = [sum(other.contains(ring) for other in valid[:i]) for i, ring in enumerate(valid)]
    for i, ring in enumerate(valid):
        if depth[i] % 2:
            continue
        holes = [h for k, h in enumerate(valid)
                 if depth[k] == depth[i] + 1 and k > i and ring.contains(h)]  # fmt: skip
        area = shapely.difference(ring, shapely.union_all(holes)) if holes else ordered[i][0]
        yield area, ordered[i][1]


def _once(ordered: list[tuple[Any, str]]) -> list[tuple[Any, str]]:
    """Return outlines without those that repeat another, which would count as its hole."""
    kept: list[tuple[Any, str]] = []
    for ring, layer in ordered:
        small = _SAME * ring.area
        same = (other for other, _ in reversed(kept) if abs(other.area - ring.area) <= small)
        if not any(_differ(other, ring) <= small for other in same):
            kept.append((ring, layer))
    return kept


def _differ(one: Any, other: Any) -> float:
    pair = [ring if ring.is_valid else shapely.make_valid(ring) for ring in (one, other)]
    return float(shapely.symmetric_difference(*pair).area)
