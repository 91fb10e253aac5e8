"""Compare the place of an occupancy grid with the cells of its image."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

from crowdbot.plugin import Agreement, Array, Place
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields
from crowdbot.plugins.environments.floor_plan_grid_build import cells_of
from crowdbot.plugins.environments.floor_plan_units_build import moved

#: Largest number of cells that are named.
_MOST_NAMED = 10
#: Rows of cells compared at once.
_ROWS = 256


def agreement(spec: FloorPlanFields, place: Place) -> Agreement:
    """Return the cells whose centres are floor in the image only, or in the place only.

    Raises:
        InputError: the map or its image cannot be read.
    """
    assert spec.file is not None  # only files hold grids
    file = spec.file.file
    image = None if spec.image is None else spec.image.file
    found, free = cells_of(spec, file, image)
    free = free[::-1]
    # Where nothing is a face, solid parts are all around: floor ends there.
    around = [face.points for face in place.faces] or [s.outline for s in place.solids]
    outer = _union(map(shapely.Polygon, around))
    solid = _union(shapely.Polygon(s.outline, s.holes) for s in place.solids)
    small = _union(map(shapely.Polygon, place.left_out))
    wrong, left_out, where = 0, 0, list[tuple[float, float]]()
    for first in range(0, len(free), _ROWS):
        rows = free[first : first + _ROWS]
        j, i = np.nonzero(np.ones_like(rows))
        at = moved(found.at(np.column_stack([i + 0.5, j + first + 0.5])), spec)
        on_floor = _contains(outer, at) & ~_contains(solid, at)
        differ = on_floor != rows.ravel()
        small_here = differ & _contains(small, at)
        left_out += int(small_here.sum())
        differ &= ~small_here
        wrong += int(differ.sum())
        where += [(float(x), float(y)) for x, y in at[differ][: _MOST_NAMED - len(where)]]
    name = (image or found.image_beside(file)).name
    return Agreement(name, free.size, wrong, left_out, tuple(where))


def _union(shapes: Iterable[Any]) -> Any:
    whole = shapely.union_all(list(shapes))
    shapely.prepare(whole)
    return whole


def _contains(shape: Any, at: Array) -> NDArray[np.bool_]:
    return np.asarray(shapely.contains_xy(shape, at[:, 0], at[:, 1]))
