"""An environment as an occupancy grid of ROS: ``map.yaml`` and a PGM image, for nav2."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray
from scipy import ndimage

from crowdbot.core.environments.outline_map import OutlineMap
from crowdbot.core.types.arrays import Array, Point
from crowdbot.errors import InputError

#: Grey values of nav2's map saver.
FREE, UNKNOWN, OCCUPIED = 254, 205, 0
#: More cells take too long, and too much memory.
MOST_CELLS = 100_000_000
#: Free floor around everything, m.
_MARGIN = 0.5


@dataclass(frozen=True, slots=True)
class GridMap:
    """Grey values (H, W), first row on top; x and y of the lower left corner and a cell's side."""

    cells: NDArray[np.uint8]
    origin: Point
    resolution: float

    def to_pgm(self) -> bytes:
        """Return the PGM image."""
        height, width = self.cells.shape
        return b"P5\n%d %d\n255\n" % (width, height) + self.cells.tobytes()

    def to_yaml(self, image: str) -> str:
        """Return the text of ``map.yaml``."""
        x, y = (round(value, 9) for value in self.origin)  # no -1.4000000000000001
        return (
            f"image: {image}\nmode: trinary\nresolution: {self.resolution!r}\n"
            f"origin: [{x!r}, {y!r}, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )


def grid_map(
    outline: OutlineMap, walls: Array, inside: Iterable[Point], resolution: float, below: float
) -> GridMap:
    """Return a grid map: obstacle cells are occupied, unreachable cells are unknown.

    Args:
        outline: the polygons.
        walls: (S, 4) outer walls, m; every cell that one touches is occupied.
        inside: positions from which the floor is reached; without any, all other cells are free.
        resolution: side of a cell, m.
        below: obstacles that begin higher are left out, m.

    Raises:
        InputError: there would be too many cells.
    """
    shapes = [
        s for s, (base, _) in zip(outline.obstacles, outline.heights, strict=True) if base < below
    ]
    everything = [*shapes, *shapely.linestrings(walls.reshape(-1, 2, 2))]
    points = [shapely.Point(p) for p in inside]
    low_x, low_y, high_x, high_y = shapely.total_bounds([*everything, *points])
    x0 = math.floor((low_x - _MARGIN) / resolution) * resolution
    y0 = math.floor((low_y - _MARGIN) / resolution) * resolution
    columns = math.ceil((high_x + _MARGIN - x0) / resolution)
    rows = math.ceil((high_y + _MARGIN - y0) / resolution)
    if columns * rows > MOST_CELLS:
        raise InputError(f"{columns} x {rows} cells are too many; write a larger --resolution")
    taken = np.zeros((rows, columns), np.bool_)
    for shape in everything:
        _take(taken, shape, (x0, y0), resolution)
    cells = np.where(taken, OCCUPIED, FREE).astype(np.uint8)
    starts = [(int((p.y - y0) / resolution), int((p.x - x0) / resolution)) for p in points]
    if starts:
        regions, _ = ndimage.label(~taken)
        reached = {int(regions[cell]) for cell in starts} - {0}
        cells[~taken & ~np.isin(regions, sorted(reached))] = UNKNOWN
    return GridMap(np.ascontiguousarray(cells[::-1]), (x0, y0), resolution)


def _take(taken: NDArray[np.bool_], shape: object, origin: Point, side: float) -> None:
    """Mark the cells that a polygon or a line touches."""
    low_x, low_y, high_x, high_y = shapely.bounds(shape)
    i0, i1 = int((low_x - origin[0]) / side), int((high_x - origin[0]) / side)
    j0, j1 = int((low_y - origin[1]) / side), int((high_y - origin[1]) / side)
    xs = origin[0] + (np.arange(i0, i1 + 1) + 0.5) * side
    ys = origin[1] + (np.arange(j0, j1 + 1) + 0.5) * side
    x, y = np.meshgrid(xs, ys)
    # A cell is touched if its centre is nearer than half a side, or a little more in a corner.
    near = shapely.distance(shapely.points(x, y), shape) <= 0.5 * side + 1e-9
    taken[j0 : j1 + 1, i0 : i1 + 1] |= near
