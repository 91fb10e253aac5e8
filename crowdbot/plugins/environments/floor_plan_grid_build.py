"""The floor of an occupancy grid: its free cells, with straight lines along slanted walls."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

from crowdbot.plugin import Array, InputError
from crowdbot.plugins.environments.floor_plan_detail_build import simplified
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_units_build import moved
from crowdbot.plugins.environments.grid_lines_build import MOST_TOLERANCE, straightened
from crowdbot.plugins.environments.grid_rings_build import grid_rings
from crowdbot.plugins.environments.map_image_build import read_grey
from crowdbot.plugins.environments.ros_map_build import RosMap, free_cells, read_map, tell_units


def read_grid(spec: FloorPlanFields, file: Path, image: Path | None) -> list[Any]:
    """Return the floor of a map as polygons without a common point, world frame, m.

    Args:
        file: the ``map.yaml``.
        image: instead of the image that it names.

    Raises:
        InputError: the map or its image cannot be read, or no cell is free.
    """
    found, free = cells_of(spec, file, image)
    if not free.any():
        raise InputError(f"{file.name}: no cell of its image is free")
    most = MOST_TOLERANCE * found.resolution
    wished = most if spec.tolerance is None else spec.tolerance
    polygons = floor_polygons(
        free[::-1], min(wished, most) / found.resolution, lambda p: moved(found.at(p), spec)
    )
    return [simplified(p, max(0.0, wished - most)) for p in polygons]


def cells_of(
    spec: FloorPlanFields, file: Path, image: Path | None
) -> tuple[RosMap, NDArray[np.bool_]]:
    """Return a map and its free cells (H, W), the first row on top.

    Raises:
        InputError: as in `read_grid`.
    """
    found = read_map(file)
    tell_units(file.name, found)
    grey = read_grey(image or found.image_beside(file), found.alpha)
    return found, free_cells(found, grey, unknown_is_free=spec.unknown == "free")


def floor_polygons(free: NDArray[np.bool_], tolerance: float, place: Any) -> list[Any]:
    """Return connected free cells as polygons.

    Args:
        free: (H, W), the lowest row first.
        tolerance: see `straightened`.
        place: function from points (K, 2) in cells to the world frame.
    """
    rings = defaultdict[int, list[Array]](list)
    for ring in grid_rings(free):
        rings[ring.region].append(straightened(ring, tolerance))
    return [_polygon(own, place) for own in rings.values()]


def _polygon(rings: list[Array], place: Any) -> Any:
    """Return the polygon of a counter-clockwise ring, and of holes that are clockwise."""
    outer = [r for r in rings if _signed_area(r) > 0.0]
    holes = [r for r in rings if _signed_area(r) <= 0.0]
    return shapely.Polygon(place(outer[0]), [place(hole) for hole in holes])


def _signed_area(ring: Array) -> float:
    x, y = (ring - ring[0]).T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
