"""Build the arrays of a place: `Place` -> `EnvironmentParts`."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from crowdbot.core.environments.convex_pieces import convex_pieces
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.spec.component_specs import EnvironmentSpec
from crowdbot.dsl.spec.outlines import counter_clockwise, sides
from crowdbot.dsl.spec.place import Heights, Place

#: A side: x0, y0, x1, y1; bottom and top; True if it stops the robot, and people.
_Row = tuple[tuple[float, float, float, float], Heights, bool, bool]


def place_parts(spec: EnvironmentSpec, place: Place) -> EnvironmentParts:
    """Return all simulated parts of a place, with the zones and portals of its spec.

    Solids stop the robot as convex pieces; sensors and people use their sides.
    """
    rows = [*_faces(place), *_solids(place)]
    pieces = [
        (piece, solid)
        for solid in place.solids
        for piece in convex_pieces(counter_clockwise(solid.outline), solid.holes)
    ]
    return EnvironmentParts(
        walls=np.array([row[0] for row in rows], np.float64).reshape(-1, 4),
        wall_heights=_heights([row[1] for row in rows]),
        stops_robot=np.array([row[2] for row in rows], np.bool_),
        stops_crowd=np.array([row[3] for row in rows], np.bool_),
        zones={name: np.array(zone.polygon) for name, zone in spec.zones.items()},
        portals={name: (*box.x, *box.y) for name, box in spec.portals.items()},
        pillars=np.array([(p.x, p.y, p.radius) for p in place.pillars]).reshape(-1, 3),
        pillar_heights=_heights([p.heights for p in place.pillars]),
        solids=tuple(piece for piece, _ in pieces),
        solid_heights=_heights([solid.heights for _, solid in pieces]),
        solids_stop_crowd=np.array([solid.stops_crowd for _, solid in pieces], np.bool_),
        periodic_boundary=place.torus,
        left_out=tuple(np.array(outline, np.float64) for outline in place.left_out),
    )


def _heights(rows: list[Heights]) -> Array:
    return np.array(rows, np.float64).reshape(-1, 2)


def _faces(place: Place) -> Iterator[_Row]:
    for face in place.faces:
        for (ax, ay), (bx, by) in pairwise(face.points):
            yield (ax, ay, bx, by), face.heights, face.stops_robot, face.stops_crowd


def _solids(place: Place) -> Iterator[_Row]:
    for solid in place.solids:
        for ring in solid.rings:
            for (ax, ay), (bx, by) in sides(ring):
                yield (ax, ay, bx, by), solid.heights, False, solid.stops_crowd
