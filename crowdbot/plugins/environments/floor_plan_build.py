"""Build the place of a floor plan: read it, repair and simplify its outlines."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import InputError, Place
from crowdbot.plugin.for_environments import input_text, valid_shape
from crowdbot.plugins.environments.floor_plan_detail_build import without_details
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_grid_build import read_grid
from crowdbot.plugins.environments.floor_plan_solids_build import around_floor, as_solid
from crowdbot.plugins.environments.floor_plan_units_build import check_place
from crowdbot.plugins.environments.floor_plan_vector_build import (
    ImportedPlan,
    read_vector,
    sorted_plan,
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


def place_of(spec: FloorPlanFields) -> Place:
    """Return the walls of a plan.

    Raises:
        InputError: its file cannot be read, or is not a plan.
    """
    file = None if spec.file is None else spec.file.file
    image = None if spec.image is None else spec.image.file
    words = spec.model_dump_json(exclude={"zones", "portals"})
    stamps = tuple(map(_stamp, (file, image)))
    unit_given = "unit" in spec.model_fields_set
    found = _place_or_problem(words, type(spec), (file, image), stamps, unit_given)
    if isinstance(found, InputError):
        raise found.with_traceback(None)
    return found


def _stamp(file: Path | None) -> tuple[int, int]:
    """Return modification time and size, which change with a file that has no hash."""
    if file is None:
        return 0, 0
    found = file.stat()
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=8)
def _place_or_problem(
    words: str,
    model: type[FloorPlanFields],
    files: tuple[Path | None, Path | None],
    stamps: tuple[tuple[int, int], ...],
    unit_given: bool,
) -> Place | InputError:
    """Return the place, or why there is none: several checks of a document ask for it."""
    del stamps  # part of the cache's key
    try:
        return _place_of(model.model_validate_json(words), *files, unit_given)
    except InputError as error:
        if isinstance(error.__context__, OSError):  # it may be readable later
            raise
        return error


def _place_of(
    spec: FloorPlanFields, file: Path | None, image: Path | None, unit_given: bool
) -> Place:
    name = "wkt" if file is None else file.name
    plan = _read(spec, file, image, name, unit_given)
    small = list[Any]()
    floor = shapely.union_all([_repaired(p, name) for p in plan.walkable])
    floor = without_details(_polygons(floor), spec, small)
    solids = [
        (part, heights)
        for shape, heights in plan.solids
        for part in without_details(_polygons(_repaired(shape, name)), spec, small)
    ]
    _check(plan, floor, [part for part, _ in solids], spec, name)
    _tell_small(small, spec, name)
    faces, around = around_floor(floor, (0.0, spec.wall_height))
    return Place(
        faces=faces,
        solids=(*around, *(as_solid(part, heights) for part, heights in solids)),
        left_out=tuple(as_solid(p, (0.0, spec.wall_height)).outline for p in small),
    )


def _read(
    spec: FloorPlanFields, file: Path | None, image: Path | None, name: str, unit_given: bool
) -> ImportedPlan:
    if spec.read_as == "ros_map":
        assert file is not None  # the document's validation checked this
        return ImportedPlan(walkable=read_grid(spec, file, image))
    if spec.read_as == "dxf":
        from crowdbot.plugins.environments.floor_plan_dxf_build import read_dxf

        assert file is not None
        found, spec = read_dxf(spec, file, _LARGEST, unit_given)
        return sorted_plan(found, spec, name, "", unit_given)
    text = spec.wkt or "" if file is None else input_text(file, _LARGEST, name)
    return read_vector(spec, text.removeprefix("\ufeff"), name, unit_given)


# --------------------------------------------------------------------------------- checks
def _check(
    plan: ImportedPlan, floor: list[Any], solids: list[Any], spec: FloorPlanFields, name: str
) -> None:
    """Refuse a plan without parts, and one with too many or too large ones."""
    count = sum(shapely.get_num_coordinates(p) for p in (*floor, *solids))
    if not count:
        raise InputError(f"{name}: there is neither a floor nor a wall in it{_too_small(plan)}")
    if count > MOST_CORNERS:
        raise InputError(
            f"{name}: the plan has {count} corners, more than {MOST_CORNERS}; raise 'tolerance' "
            "or 'least_area', or cut a part out of it"
        )
    _check_size(floor, spec, name)
    check_place([*floor, *solids], spec, name)


def _too_small(plan: ImportedPlan) -> str:
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


def _size(shapes: Sequence[Any]) -> tuple[float, float]:
    x0, y0, x1, y1 = shapely.total_bounds(shapes)
    return float(x1 - x0), float(y1 - y0)


def _tell_small(small: list[Any], spec: FloorPlanFields, name: str) -> None:
    """Warn about pieces that are left out."""
    if not small:
        return
    largest = max(small, key=lambda p: p.area)
    x, y = largest.representative_point().coords[0]
    _LOG.warning(
        "%s: left out: %d piece%s smaller than least_area, %g m²; the largest has %.2g m², "
        "around (%.2f, %.2f)", name, len(small), "s" * (len(small) > 1), spec.smallest,
        largest.area, x, y,
    )  # fmt: skip


# ----------------------------------------------------------------------------- polygons
def _repaired(shape: Any, name: str) -> Any:
    """Return a valid geometry on a grid, with a warning if it was repaired."""
    if not shapely.is_valid(shape):
        why = shapely.is_valid_reason(shape)
        _LOG.warning("%s: an outline was repaired: %s", name, why)
        shape = valid_shape(shape)
    return shapely.set_precision(shape, _GRID)


def _polygons(shape: Any) -> list[Any]:
    parts = shapely.get_parts(shape)
    nested = [shapely.get_parts(p) for p in parts]
    return [p for group in nested for p in group if p.geom_type == "Polygon" and not p.is_empty]
