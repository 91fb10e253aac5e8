"""Walkable areas for JuPedSim: connected polygons between the walls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array

#: Walls become slits of this width, m.
SLIT = 0.002
#: The floor ends at multiples of this, so that many decisions can share the same area, m.
_GRID = 100.0


@dataclass(frozen=True, slots=True)
class WalkableArea:
    """One connected part of the floor; ``shape`` is a shapely polygon."""

    shape: Any
    shapely: Any

    def contains(self, points: Array) -> NDArray[np.bool_]:
        """Return a mask of the (M, 2) points inside."""
        return np.asarray(
            self.shapely.contains_xy(self.shape, points[:, 0], points[:, 1]), np.bool_
        )

    def nearest(self, point: Array) -> tuple[float, float]:
        """Return the point itself, or the nearest one of the area."""
        here = self.shapely.Point(*point)
        if not self.shape.contains(here):
            inner = self.shape.buffer(-SLIT)
            here = self.shapely.shortest_line(inner, here).interpolate(0.0)
        return (float(here.x), float(here.y))


class WalkableAreas:
    """Cuts the floor along the walls and caches the last cut."""

    def __init__(self, shapely: Any) -> None:
        self._shapely = shapely
        self._key: tuple[object, ...] = ()
        self._areas: list[WalkableArea] = []

    def of(self, points: Array, walls: Array) -> Iterator[tuple[WalkableArea, NDArray[np.bool_]]]:
        """Yield each part of the floor that contains points (M, 2), and a mask of these."""
        ends = np.concatenate([points, walls[:, :2], walls[:, 2:]])
        if not len(ends):
            return
        low = np.floor(ends.min(axis=0) / _GRID) * _GRID - _GRID
        high = np.ceil(ends.max(axis=0) / _GRID) * _GRID + _GRID
        key = (*low, *high, walls.tobytes())
        if key != self._key:
            self._areas, self._key = self._cut(low, high, walls), key
        for area in self._areas:
            inside = area.contains(points)
            if np.any(inside):
                yield area, inside

    def _cut(self, low: Array, high: Array, walls: Array) -> list[WalkableArea]:
        shapely = self._shapely
        lines = shapely.linestrings(walls.reshape(-1, 2, 2))
        slits = shapely.union_all(shapely.buffer(lines, 0.5 * SLIT, quad_segs=1))
        floor = shapely.box(*low, *high).difference(slits)
        parts = shapely.get_parts(floor)
        return [WalkableArea(part, shapely) for part in parts if part.area > SLIT]
