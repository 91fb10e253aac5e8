"""Floor as plain geometry: every wall and block is a convex solid, its outline are walls."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.interfaces import Array, EnvironmentParts
from crowdbot.plugins.environments.floor import FloorSpec, WallSpec


def build(spec: FloorSpec) -> EnvironmentParts:
    """Border walls face inwards; the outlines of solids face outwards."""
    solids = [_outline(wall) for wall in spec.walls.values()]
    solids += [np.array(block.corners) for block in spec.blocks.values()]
    border = _edges(np.array(spec.area.polygon))
    if spec.border != "walls":
        border = border[:0]
    # Clockwise, so that the free side of each edge is on its left.
    walls = np.concatenate([border, *(_edges(solid[::-1]) for solid in solids)])
    heights = [0.0, spec.wall_height]
    pillars = [(p.x, p.y, p.radius) for p in spec.pillars.values()]
    (x0, x1), (y0, y1) = spec.area.x, spec.area.y
    return EnvironmentParts(
        walls=walls,
        wall_heights=np.tile(heights, (len(walls), 1)),
        stops_robot=np.arange(len(walls)) < len(border),  # solids stop it as a whole
        stops_crowd=np.ones(len(walls), np.bool_),
        zones={name: np.array(zone.polygon) for name, zone in spec.zones.items()},
        portals={name: (*box.x, *box.y) for name, box in spec.portals.items()},
        pillars=np.array(pillars).reshape(-1, 3),
        pillar_heights=np.tile(heights, (len(pillars), 1)),
        solids=tuple(solids),
        solid_heights=np.tile(heights, (len(solids), 1)),
        periodic_boundary=(x0, x1, y0, y1) if spec.border == "torus" else None,
    )


def _edges(corners: Array) -> Array:
    """Sides (K, 4) of an outline; the inside of a counter-clockwise one is on their left."""
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)


def _outline(wall: WallSpec) -> Array:
    """Corners (4, 2) of a wall, counter-clockwise."""
    start, end = np.array(wall.start), np.array(wall.end)
    along = end - start
    across = np.array([-along[1], along[0]]) * (0.5 * wall.thickness / math.hypot(*along))
    return np.array([start - across, end - across, end + across, start + across])
