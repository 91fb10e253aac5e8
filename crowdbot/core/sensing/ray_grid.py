"""Grids of rays and the obstacles that they may hit, for compiled code."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.types.arrays import Array, Indices

#: Largest number of bodies per column; the farthest are dropped.
DEEPEST = 32
#: Data of a body in a column: its start and end (m over the floor), cosine of the level angle
#: between ray and normal, bottom and top (m), its owner.
NEAR, FAR, FACING, LOW, HIGH, OWNER = range(6)
WORK_COLUMNS = 6
#: Ends of a wall are extended by this fraction, so that no ray passes through a corner.
OVERLAP = 1e-9
#: Square of the sine of an angle between a ray and a wall below which they count as parallel: where
#: the ray runs along the wall, rounding would decide at which distance they meet.
PARALLEL = 1e-24


class Obstacles(NamedTuple):
    """Everything that rays can hit, for compiled code; see `Scene.obstacles`.

    Attributes:
        walls, wall_heights: (S, 4), (S, 2) upright plates: x0, y0, x1, y1; bottom and top, m.
        discs: (D, 5) upright cylinders, columns as in `crowdbot.core.sensing.body_model`, m.
        owner: (D,) owner of each cylinder: a person's index, or -(2 + S + index) for a pillar.
    """

    walls: Array
    wall_heights: Array
    discs: Array
    owner: Indices


class GridArrays(NamedTuple):
    """A `RayGrid` for compiled code, with R rows and C columns.

    Attributes:
        azimuth, cos, sin: (C,) rising, within one turn, rad; 0 is straight ahead.
        slope, slope_scale: (R,), (C,).
        work: (C, K, `WORK_COLUMNS`) scratch: the K nearest bodies of each column, nearest first.
        filled: (C,) scratch: number of bodies per column.
        directions: (5, C) scratch: the columns' directions in the world frame; distance, bottom and
            top of the plate that hides what is behind it, m.
        runs: (3, 2) scratch.
    """

    azimuth: Array
    cos: Array
    sin: Array
    slope: Array
    slope_scale: Array
    work: Array
    filled: Indices
    directions: Array
    runs: Indices


class RayGrid:
    """Directions of a constant grid of rays, relative to the sensor.

    The ray of row r and column c goes along ``azimuth[c]`` and rises by
    ``slope[r] * slope_scale[c]`` per metre over the floor.

    Attributes:
        azimuth: (C,) rising, within one turn, rad; 0 is straight ahead.
        slope: (R,).
        slope_scale: (C,) 1 by default; for a pinhole camera the cosine of the azimuth.
        arrays: all of these, and scratch space.
    """

    def __init__(
        self, azimuth: ArrayLike, slope: ArrayLike, slope_scale: ArrayLike | None = None
    ) -> None:
        self.azimuth = np.array(azimuth, dtype=np.float64)
        self.slope = np.array(slope, dtype=np.float64)
        given = np.ones_like(self.azimuth) if slope_scale is None else slope_scale
        self.slope_scale = np.array(given, np.float64)
        # What a level ray hits hides everything behind it.
        deepest = DEEPEST if np.any(self.slope) else 1
        columns = len(self.azimuth)
        self.arrays = GridArrays(
            self.azimuth, np.cos(self.azimuth), np.sin(self.azimuth), self.slope,
            self.slope_scale, np.empty((columns, deepest, WORK_COLUMNS)),
            np.zeros(columns, np.int64), np.empty((5, columns)), np.empty((3, 2), np.int64),
        )  # fmt: skip

    @property
    def shape(self) -> tuple[int, int]:
        """Return rows and columns."""
        return len(self.slope), len(self.azimuth)
