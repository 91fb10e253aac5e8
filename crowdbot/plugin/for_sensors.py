"""Tools for sensors' build functions: rays in columns, bodies of people, depth images."""

from __future__ import annotations

from crowdbot.core.sensing.body_model import BOTTOM, RADIUS, TOP, X, Y, trunk_radius
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.sensing.depth_renderer import MOST_MILLIMETRES, DepthRenderer
from crowdbot.core.sensing.ray_grid import FAR, HIGH, LOW, NEAR, GridArrays, Obstacles, RayGrid
from crowdbot.core.sensing.raycast_columns import fill_columns, heights_of, meet
from crowdbot.core.sensing.raycast_tilted import NO_RAYS, grid_rays

__all__ = [
    "BOTTOM",
    "FAR",
    "HIGH",
    "LOW",
    "MOST_MILLIMETRES",
    "NEAR",
    "NO_RAYS",
    "RADIUS",
    "TOP",
    "DepthRenderer",
    "GridArrays",
    "Obstacles",
    "RayGrid",
    "X",
    "Y",
    "depth_mm",
    "fill_columns",
    "grid_rays",
    "heights_of",
    "meet",
    "trunk_radius",
]
