"""DXF drawings: which entities are floor or walls, as geometries with properties."""

from __future__ import annotations

import io
import logging
from collections import Counter
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import InputError, did_you_mean, nearest
from crowdbot.plugin.for_environments import input_bytes
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_units_build import UNITS

_LOG = logging.getLogger(__name__)
#: Entities whose course is followed; others are left out, and named.
_CURVES = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE", "SOLID", "TRACE")
#: Values of the header variable $INSUNITS.
_INSUNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
#: Entities that are read, with those of blocks each time they are inserted.
_MOST_ENTITIES = 200_000
#: Largest distance between a curve and its chords, m.
_CHORD = 0.01
_BINARY = b"AutoCAD Binary DXF"
#: Ends this near are the same point, in parts of the drawing's unit.
_CLOSED = 1e-6

_Found = tuple[Any, dict[str, Any]]


def read_dxf(
    spec: FloorPlanFields, file: Path, most: int, told_unit: bool
) -> tuple[list[_Found], FloorPlanFields]:
    """Return the geometries of a drawing, and the fields with the unit that it declares.

    Args:
        spec: says which layers mean what.
        file: the drawing, ASCII.
        most: largest size, bytes.
        told_unit: True if the document gives the unit.

    Raises:
        InputError: it is not a drawing, ezdxf is not installed, or a named layer is not there.
    """
    drawing = _opened(file, most)
    spec = _with_unit(drawing, spec, file.name, told_unit)
    aside = Counter[str]()
    chord = _CHORD / UNITS.get(spec.unit, 1.0)
    outlines: dict[tuple[str, str], list[Any]] = {}
    found: list[_Found] = []
    for entity in _entities(drawing, file.name):
        layer = str(entity.dxf.layer)
        meaning = _meaning(drawing, layer, spec, aside)
        if not meaning:
            continue
        for shape in _shapes(entity, chord, aside):
            closed = shape.geom_type == "Polygon"
            if closed and meaning != "walls":
                outlines.setdefault((layer, meaning), []).append(shape)
            else:
                line = shape.exterior if closed else shape
                found.append((line, {"layer": layer, "kind": "wall"}))
    for (layer, meaning), rings in outlines.items():
        properties = {"layer": layer, **_KINDS[meaning]}
        found += [(shape, dict(properties)) for shape in _nested(rings)]
    _check_layers(drawing, spec, file.name)
    if aside:
        listed = ", ".join(f"{count} {what}" for what, count in sorted(aside.items()))
        _LOG.warning("%s: left out: %s", file.name, listed)
    return found, spec


#: Meaning of a layer -> properties as GeoJSON writes them; none: as `polygons` says.
_KINDS: dict[str, dict[str, str]] = {
    "floor": {"kind": "walkable"}, "obstacles": {"kind": "obstacle"}, "any": {},
}  # fmt: skip


def _opened(file: Path, most: int) -> Any:
    content = input_bytes(file, most, file.name)
    if content.startswith(_BINARY):
        raise InputError(f"{file.name}: is binary DXF; save it as ASCII DXF")
    try:
        from ezdxf.filemanagement import read
    except ImportError as error:
        raise InputError(
            f"{file.name}: reading DXF needs ezdxf; install it with 'pip install crowdbot[dxf]'"
        ) from error
    logging.getLogger("ezdxf").setLevel(logging.CRITICAL)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:  # before 2007 drawings were written in the code page of Windows
        text = content.decode("cp1252", errors="replace")
    try:
        return read(io.StringIO(text.replace("\r\n", "\n")))
    except Exception as error:  # ezdxf raises many types for damaged drawings
        why = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(f"{file.name}: is not a DXF drawing: {why}") from error


def _with_unit(drawing: Any, spec: FloorPlanFields, name: str, told_unit: bool) -> FloorPlanFields:
    """Return the fields with the drawing's unit, unless the document gives one."""
    declared = _INSUNITS.get(int(drawing.header.get("$INSUNITS", 0)))
    if declared is None or declared == spec.unit:
        return spec
    if told_unit:
        _LOG.warning(
            "%s: the drawing declares %s, the document says %s, which counts",
            *(name, declared, spec.unit),
        )
        return spec
    return spec.model_copy(update={"unit": declared})


def _entities(drawing: Any, name: str) -> Iterator[Any]:
    """Yield the entities of the model space, with those of inserted blocks.

    Raises:
        InputError: there are too many, or blocks contain each other.
    """
    from ezdxf.disassemble import recursive_decompose

    try:
        for count, entity in enumerate(recursive_decompose(drawing.modelspace())):
            if count >= _MOST_ENTITIES:
                raise InputError(f"{name}: more than {_MOST_ENTITIES} entities, blocks included")
            yield entity
    except RecursionError:
        raise InputError(f"{name}: its blocks contain each other") from None


def _meaning(drawing: Any, layer: str, spec: FloorPlanFields, aside: Counter[str]) -> str:
    """Return what a layer means; empty, and counted, if it is left out."""
    if layer in drawing.layers:
        state = drawing.layers.get(layer)
        if state.is_off() or state.is_frozen():
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


def _check_layers(drawing: Any, spec: FloorPlanFields, name: str) -> None:
    """Refuse patterns that no layer matches.

    Raises:
        InputError: naming the nearest layer.
    """
    known = sorted({str(e.dxf.layer) for e in drawing.modelspace()}
                   | {str(layer.dxf.name) for layer in drawing.layers})  # fmt: skip
    for pattern in spec.layers:
        if not any(fnmatchcase(layer.lower(), pattern.lower()) for layer in known):
            near = did_you_mean(nearest(pattern, known))
            raise InputError(
                f"{name}: no layer is called '{pattern}'{near or '; there are ' + ', '.join(known)}"
            )


def _shapes(entity: Any, chord: float, aside: Counter[str]) -> Iterator[Any]:
    """Yield an entity as polygons where it is closed, else as lines."""
    from ezdxf import path as paths

    kind = entity.dxftype()
    try:
        if kind == "HATCH":
            courses = [*paths.from_hatch(entity)]
        elif kind in _CURVES:
            courses = [paths.make_path(entity)]
        else:
            aside[f"{kind} entities"] += 1
            return
        for course in courses:
            yield from _shape(course, chord)
    except (TypeError, ValueError, ArithmeticError):  # degenerate: no radius, no knots
        aside[f"damaged {kind} entities"] += 1


def _shape(course: Any, chord: float) -> Iterator[Any]:
    for part in course.sub_paths() if course.has_sub_paths else (course,):
        points = [(p.x, p.y, p.z) for p in part.flattening(chord, segments=8)]
        different = len(set(points))
        ends = max(abs(a - b) for a, b in zip(points[0], points[-1], strict=True))
        size = max((abs(v) for p in points for v in p), default=0.0)
        if different >= 3 and ends <= _CLOSED * max(size, 1.0):
            yield shapely.Polygon(points)
        elif different >= 2:
            yield shapely.LineString(points)


def _nested(rings: Iterable[Any]) -> Iterator[Any]:
    """Yield areas between outlines: one that lies inside another is its hole, and so on."""
    ordered = sorted(rings, key=lambda ring: -ring.area)
    valid = [ring if ring.is_valid else shapely.make_valid(ring) for ring in ordered]
    depth = [sum(other.contains(ring) for other in valid[:i]) for i, ring in enumerate(valid)]
    for i, ring in enumerate(valid):
        if depth[i] % 2:
            continue
        holes = [h for k, h in enumerate(valid)
                 if depth[k] == depth[i] + 1 and k > i and ring.contains(h)]  # fmt: skip
        yield shapely.difference(ring, shapely.union_all(holes)) if holes else ordered[i]
