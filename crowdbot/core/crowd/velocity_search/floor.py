"""All walls of a floor, for decisions that look beyond the walls they are given."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.crowd.velocity_search.point_grid import PointGrid, point_grid
from crowdbot.core.crowd.velocity_search.records import FLOOR, FloorRecord
from crowdbot.core.geometry.segment_grid import SegmentGrid, grid_of
from crowdbot.core.support.records import Rows, rows_of
from crowdbot.core.types.arrays import Array

#: Arrays that have to live as long as their address is used.
Kept = tuple[Rows[FloorRecord], Array, SegmentGrid, PointGrid]


def floor_of(walls: Array, radius: float, points: tuple[float, float]) -> tuple[Kept, int]:
    """Return the address of a `FloorRecord`, and its arrays, which the caller keeps alive.

    Args:
        walls: (S, 4), m.
        radius: of the widest person, m: cells list the walls that this one may touch.
        points: reach and fading of the `PointGrid`, m; no reach if no function needs it.
    """
    walls = np.ascontiguousarray(walls, np.float64)
    grid, floor = grid_of(walls, radius), rows_of(1, FLOOR)
    ends = walls.reshape(-1, 2) if len(walls) else np.zeros((1, 2))
    by_points = point_grid(walls if points[0] > 0.0 else walls[:0], *points)
    values = (
        walls.ctypes.data, len(walls), *ends.min(axis=0), *ends.max(axis=0), *grid.frame,
        grid.first.ctypes.data, grid.near.ctypes.data, points[0], *by_points.frame,
        *(part.ctypes.data for part in by_points[1:]),
    )  # fmt: skip
    own: Any = floor
    own.view(np.float64)[:] = values
    return (floor, walls, grid, by_points), int(own.ctypes.data)
