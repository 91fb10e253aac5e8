"""Planar lidar."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component
from crowdbot.plugins.sensors.lidar import LidarSpec


class Lidar2dSpec(LidarSpec):
    """Beams from ``angle_min`` (included) to ``angle_max`` (excluded), counter-clockwise."""

    kind: Literal["lidar2d"] = "lidar2d"


LIDAR2D = Component(spec=Lidar2dSpec, summary="planar laser scanner")
