"""Place: what an environment is made of, in plain numbers; world frame, m.

Specs say what their place is made of, so that documents can be checked before anything is built.
`crowdbot.core.environments.place_parts` makes the arrays of it that plant, sensors, crowd, routes,
drawings and scores read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from crowdbot.dsl.spec.outlines import (
    Outline,
    Point,
    contains,
    counter_clockwise,
    distance_between,
    distance_to_side,
    sides,
)

#: Bottom and top, m.
Heights = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """A wall that is seen from one side: a line of points with the free side on its left.

    Attributes:
        points: two or more.
        heights: bottom and top.
        stops_robot, stops_crowd: whom it stops.
    """

    points: tuple[Point, ...]
    heights: Heights
    stops_robot: bool = True
    stops_crowd: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """Something with an outline that stands, lies or hangs; the outline need not be convex.

    Attributes:
        outline: a simple polygon, in either sense.
        holes: simple polygons within it, apart from each other.
        heights: bottom and top.
        stops_crowd: False for what people step over, such as a kerb.
    """

    outline: Outline
    heights: Heights
    holes: tuple[Outline, ...] = ()
    stops_crowd: bool = True

    @property
    def rings(self) -> tuple[Outline, ...]:
        """Outline and holes; the free side of each is on its left."""
        outer = counter_clockwise(self.outline)[::-1]
        return (outer, *(counter_clockwise(hole) for hole in self.holes))


@dataclass(frozen=True, slots=True, kw_only=True)
class Pillar:
    """Something round that stands, lies or hangs."""

    x: float
    y: float
    radius: float
    heights: Heights


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Place:
    """Everything that a place is made of; what is not filled is floor.

    Told apart by identity, so that what was found out about a place is remembered at no cost.

    Attributes:
        torus: x0, x1, y0, y1 of a floor whose opposite borders are one, m.
    """

    faces: tuple[Face, ...] = ()
    solids: tuple[Solid, ...] = ()
    pillars: tuple[Pillar, ...] = ()
    torus: tuple[float, float, float, float] | None = None

    def bodies(self, height: float) -> Place:
        """What people of a height go around: it begins below their heads, and is not a step."""
        return Place(
            faces=tuple(f for f in self.faces if f.stops_crowd and f.heights[0] < height),
            solids=tuple(s for s in self.solids if s.stops_crowd and s.heights[0] < height),
            pillars=tuple(p for p in self.pillars if p.heights[0] < height),
            torus=self.torus,
        )

    def segments(self) -> Iterator[tuple[Point, Point]]:
        """Sides of everything that is not round."""
        for face in self.faces:
            yield from zip(face.points, face.points[1:], strict=False)
        for solid in self.solids:
            for ring in solid.rings:
                yield from sides(ring)

    def clearance(self, x: float, y: float) -> float:
        """Distance from a point to the nearest surface, m; below 0 inside something."""
        gap = min((distance_to_side(x, y, side) for side in self.segments()), default=math.inf)
        inside = any(
            contains(s.outline, x, y) and not any(contains(hole, x, y) for hole in s.holes)
            for s in self.solids
        )
        gap = -gap if inside else gap
        round_ = (math.hypot(x - p.x, y - p.y) - p.radius for p in self.pillars)
        return min(gap, *round_, math.inf)

    def is_clear(self, start: Point, goal: Point, radius: float) -> bool:
        """Whether a body of a radius (m) can walk straight from one point to another."""
        way = (start, goal)
        if any(distance_between(way, side) < radius for side in self.segments()):
            return False
        if any(distance_to_side(p.x, p.y, way) < p.radius + radius for p in self.pillars):
            return False
        return self.clearance(*start) >= radius
