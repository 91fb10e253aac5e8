"""Place: the geometry of an environment, in plain numbers; world frame, m.

Specs give their place so that documents can be checked before anything is built.
`crowdbot.core.environments.place_parts` converts it to arrays for plant, sensors, crowd, routes,
drawings and scores.
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
    """A one-sided wall: a polyline with the free side on its left.

    Attributes:
        points: two or more.
        heights: bottom and top.
        stops_robot, stops_crowd: True if it stops the robot, or people.
    """

    points: tuple[Point, ...]
    heights: Heights
    stops_robot: bool = True
    stops_crowd: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """An obstacle with an outline that stands, lies or hangs; it need not be convex.

    Attributes:
        outline: a simple polygon, in either orientation.
        holes: simple polygons within it, apart from each other.
        heights: bottom and top.
        stops_crowd: False if people step over it, such as a kerb.
    """

    outline: Outline
    heights: Heights
    holes: tuple[Outline, ...] = ()
    stops_crowd: bool = True

    @property
    def rings(self) -> tuple[Outline, ...]:
        """Return outline and holes; the free side of each is on its left."""
        outer = counter_clockwise(self.outline)[::-1]
        return (outer, *(counter_clockwise(hole) for hole in self.holes))


@dataclass(frozen=True, slots=True, kw_only=True)
class Pillar:
    """A round obstacle that stands, lies or hangs."""

    x: float
    y: float
    radius: float
    heights: Heights


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Place:
    """The complete geometry of a place; everything that is not filled is floor.

    Compared by identity, so that results about a place can be cached cheaply.

    Attributes:
        torus: x0, x1, y0, y1 of a floor with periodic boundaries, m.
        left_out: outlines of what is too small to be kept; they are drawn, and stop no one.
    """

    faces: tuple[Face, ...] = ()
    solids: tuple[Solid, ...] = ()
    pillars: tuple[Pillar, ...] = ()
    torus: tuple[float, float, float, float] | None = None
    left_out: tuple[Outline, ...] = ()

    def bodies(self, height: float) -> Place:
        """Return the place with only the obstacles that block people of a height (m)."""
        return Place(
            faces=tuple(f for f in self.faces if f.stops_crowd and f.heights[0] < height),
            solids=tuple(s for s in self.solids if s.stops_crowd and s.heights[0] < height),
            pillars=tuple(p for p in self.pillars if p.heights[0] < height),
            torus=self.torus,
        )

    def segments(self) -> Iterator[tuple[Point, Point]]:
        """Yield the sides of all walls and solids, but not pillars."""
        for face in self.faces:
            yield from zip(face.points, face.points[1:], strict=False)
        for solid in self.solids:
            for ring in solid.rings:
                yield from sides(ring)

    def clearance(self, x: float, y: float) -> float:
        """Return the distance from a point to the nearest surface, m; negative inside."""
        gap = min((distance_to_side(x, y, side) for side in self.segments()), default=math.inf)
        inside = any(
            contains(s.outline, x, y) and not any(contains(hole, x, y) for hole in s.holes)
            for s in self.solids
        )
        gap = -gap if inside else gap
        round_ = (math.hypot(x - p.x, y - p.y) - p.radius for p in self.pillars)
        return min(gap, *round_, math.inf)

    def is_clear(self, start: Point, goal: Point, radius: float) -> bool:
        """Return True if a body of a radius (m) can walk straight from one point to another."""
        way = (start, goal)
        if any(distance_between(way, side) < radius for side in self.segments()):
            return False
        if any(distance_to_side(p.x, p.y, way) < p.radius + radius for p in self.pillars):
            return False
        return self.clearance(*start) >= radius
