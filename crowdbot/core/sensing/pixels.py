"""The rays of a pinhole camera, one through the centre of each pixel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pinhole
from crowdbot.core.sensing.depth import OUTLINE, WAYS, paint

Array = NDArray[np.float64]


class Pixels:
    """Photographs depth with a camera that looks along a level axis.

    Attributes:
        shape: rows H and columns W.
        up: (H,) by how much rays rise per metre of depth; the first row is on top.
        left: (W,) by how much they go to the left; the first column is on the left.
        lean: (W,) cosines of the columns' azimuths: depth per metre of way over the floor.
    """

    def __init__(self, pinhole: Pinhole, nearest: float, farthest: float) -> None:
        """Take a camera that measures depths from ``nearest`` to ``farthest``, m."""
        self.shape = pinhole.height, pinhole.width
        column, row = pinhole.centre
        self.up = (row - np.arange(pinhole.height, dtype=np.float64)) / pinhole.focal
        self.left = (column - np.arange(pinhole.width, dtype=np.float64)) / pinhole.focal
        self.lean: Array = 1.0 / np.sqrt(1.0 + self.left**2)
        azimuth = np.arctan(self.left)
        self._cos, self._sin = np.cos(azimuth), np.sin(azimuth)
        self._lens = pinhole.focal, column, row, nearest, farthest
        self._ways = np.empty((WAYS, pinhole.width))
        self._outline = np.empty((OUTLINE, pinhole.width), np.float32)

    def photograph(
        self,
        at: tuple[float, float, float],
        yaw: float,
        walls: Array,
        wall_heights: Array,
        discs: Array,
    ) -> NDArray[np.float32]:
        """What the camera sees of walls, upright cylinders and the floor z = 0.

        Args:
            at: where it is, world frame, m.
            yaw: where it looks, world frame, rad.
            walls, wall_heights: (S, 4), (S, 2), m, as in `crowdbot.core.sensing.scene.Scene`.
            discs: (D, 5) cylinders, as in `crowdbot.core.sensing.bodies`.

        Returns:
            (H, W) depth along the axis, m: 0 for too near, inf for nothing in reach.
        """
        image = np.empty(self.shape, np.float32)
        paint(
            *at, yaw, self._lens, self.up, self.lean, self._cos, self._sin,
            walls, wall_heights, discs, self._ways, self._outline, image,
        )  # fmt: skip
        return image
