"""The office as plain geometry."""

from __future__ import annotations

import numpy as np
from crowdbot.plugin import EnvironmentParts
from numpy.typing import NDArray

from crowdbot_acme.office import OfficeSpec

Array = NDArray[np.float64]


def build(spec: OfficeSpec) -> EnvironmentParts:
    """Outer walls face inwards; the two pieces beside the door are solids that face outwards."""
    outer = _box(0.0, spec.length, -0.5 * spec.width, 0.5 * spec.width)
    middle, half, gap = 0.5 * spec.length, 0.5 * spec.thickness, 0.5 * spec.door
    pieces = (
        _box(middle - half, middle + half, -0.5 * spec.width, -gap),
        _box(middle - half, middle + half, gap, 0.5 * spec.width),
    )
    walls = np.concatenate([_sides(outer), *(_sides(piece[::-1]) for piece in pieces)])
    heights = [0.0, spec.wall_height]
    return EnvironmentParts(
        walls=walls,
        wall_heights=np.tile(heights, (len(walls), 1)),
        stops_robot=np.arange(len(walls)) < len(outer),  # the solids stop it as a whole
        stops_crowd=np.ones(len(walls), np.bool_),
        zones={name: np.array(zone.polygon) for name, zone in spec.zones.items()},
        portals={name: (*box.x, *box.y) for name, box in spec.portals.items()},
        solids=pieces,
        solid_heights=np.tile(heights, (len(pieces), 1)),
    )


def _box(x0: float, x1: float, y0: float, y1: float) -> Array:
    """Corners (4, 2), counter-clockwise."""
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def _sides(corners: Array) -> Array:
    """Sides (K, 4) of an outline; the inside of a counter-clockwise one is on their left."""
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)
