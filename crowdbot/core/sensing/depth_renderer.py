"""Depth images of a pinhole camera, one ray through the centre of each pixel."""

from __future__ import annotations

import numpy as np

from crowdbot.core.sensing.depth import render_depth
from crowdbot.core.sensing.projection import EDGE_ROWS, RAY_ROWS, Image, Lens
from crowdbot.core.sensing.walls_near import Walls
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import Pinhole

#: Depths beyond 65535 mm cannot be represented, m.
MOST_MILLIMETRES = 65.534


class DepthRenderer:
    """Renders depth for a camera with a horizontal axis.

    Attributes:
        shape: rows H and columns W.
        slope: (H,) rise of the rays per metre of depth; the first row is on top.
        left: (W,) leftward shift of the rays per metre of depth; the first column is on the left.
        cos_azimuth: (W,) cosines of the columns' azimuths: depth per metre over the floor.
        reach: largest distance over the floor at which anything is seen, m.
    """

    def __init__(self, pinhole: Pinhole, nearest: float, farthest: float) -> None:
        """Build a renderer for depths from ``nearest`` to ``farthest``, m."""
        self.shape = pinhole.height, pinhole.width
        column, row = pinhole.centre
        self.slope = (row - np.arange(pinhole.height, dtype=np.float64)) / pinhole.focal
        self.left = (column - np.arange(pinhole.width, dtype=np.float64)) / pinhole.focal
        self.cos_azimuth: Array = 1.0 / np.sqrt(1.0 + self.left**2)
        azimuth = np.arctan(self.left)
        self._cos, self._sin = np.cos(azimuth), np.sin(azimuth)
        self._lens = Lens(pinhole.focal, column, row, nearest, farthest, 0.0)
        self.reach = farthest / float(self.cos_azimuth.min()) + 1e-6
        self._lens_mm = self._lens._replace(steps=1000.0)
        self._rays = np.empty((RAY_ROWS, pinhole.width))
        self._edges = np.empty((EDGE_ROWS, pinhole.width), np.float32)

    def render_depth(
        self,
        image: Image,
        at: tuple[float, float, float],
        yaw: float,
        walls: Walls,
        discs: Array,
    ) -> None:
        """Write the camera's view of walls, upright cylinders and the floor z = 0.

        Args:
            image: (H, W) depth along the axis. float32 in m: 0 if too near, inf if nothing is in
                range. uint16 as in `crowdbot.core.sensing.depth_mm`, 0 for both; only for a camera
                with a range below `MOST_MILLIMETRES`.
            at: its position, world frame, m.
            yaw: its heading, world frame, rad.
            walls: those that it may see.
            discs: (D, 5) cylinders, as in `crowdbot.core.sensing.body_model`.
        """
        lens = self._lens_mm if image.dtype == np.uint16 else self._lens
        faces = np.empty(self.shape[1], image.dtype)
        render_depth(
            *at, yaw, *lens, self.slope, self.cos_azimuth, self._cos, self._sin, walls.segments,
            walls.heights, walls.order, discs, self._rays, self._edges, faces, image,
        )  # fmt: skip
