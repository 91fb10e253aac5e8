"""Rotatable areas of the floor, for starts and goals."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import Angle, Length, PositiveLength
from crowdbot.dsl.spec.spec import Rectangle, Spec
from crowdbot.dsl.spec.unions import AnyOf

#: Spacing of positions that are tried, m, and their largest number along each side.
_APART, _MOST_PLACES = 0.2, 100


class Area(Spec):
    """A rectangle of the floor, optionally rotated, world frame."""

    centre: tuple[Length, Length] = Field(strict=False, description="x and y of its middle, m.")
    size: tuple[PositiveLength, PositiveLength] = Field(
        strict=False, description="Length along its own x and y, m."
    )
    rotation: Angle = default(0.0, "Turned about its middle by this angle, rad.")

    @classmethod
    def of(cls, box: Rectangle) -> Area:
        """Return a zone as an area."""
        (x0, x1), (y0, y1) = box.x, box.y
        return cls(centre=(0.5 * (x0 + x1), 0.5 * (y0 + y1)), size=(x1 - x0, y1 - y0))

    def point(self, u: float, v: float) -> tuple[float, float]:
        """Return world coordinates of a point in the area's frame, from its centre; m."""
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        return self.centre[0] + cos * u - sin * v, self.centre[1] + sin * u + cos * v

    def own(self, x: float, y: float) -> tuple[float, float]:
        """Return the coordinates of a world point in the area's frame, from its centre; m."""
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        dx, dy = x - self.centre[0], y - self.centre[1]
        return cos * dx + sin * dy, cos * dy - sin * dx

    def distance(self, x: float, y: float) -> float:
        """Return the distance from a world point to the area, m; 0 inside."""
        u, v = self.own(x, y)
        out = (max(abs(w) - 0.5 * s, 0.0) for w, s in zip((u, v), self.size, strict=True))
        return math.hypot(*out)

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """Return the corners, counter-clockwise, m."""
        return _corners(*self.centre, *self.size, self.rotation)


@lru_cache(maxsize=1024)  # a suite names the same few areas in each of its scenarios
def _corners(
    x: float, y: float, length: float, width: float, rotation: float
) -> tuple[tuple[float, float], ...]:
    a, b, cos, sin = 0.5 * length, 0.5 * width, math.cos(rotation), math.sin(rotation)
    around = ((-a, -b), (a, -b), (a, b), (-a, b))
    return tuple((x + cos * u - sin * v, y + sin * u + cos * v) for u, v in around)


def places_in(area: Area, radius: float) -> Iterator[tuple[float, float]]:
    """Yield a grid of positions (m) over an area, ``radius`` from its sides where possible.

    The spacing is at most 20 cm along sides of up to 20 m, and larger along longer ones.
    """
    half = [max(0.0, 0.5 * side - radius) for side in area.size]
    counts = [min(_MOST_PLACES, math.ceil(2.0 * h / _APART)) for h in half]
    for i in range(counts[0] + 1):
        for j in range(counts[1] + 1):
            steps = zip((i, j), counts, half, strict=True)
            u, v = (h * (2.0 * k / n - 1.0) if n else 0.0 for k, n, h in steps)
            yield area.point(u, v)


def _place_tag(value: Any) -> str:
    return "<area>" if isinstance(value, dict | Area) else "<zone>"


#: The name of a zone, or a rectangle, optionally rotated.
Place = Annotated[
    Annotated[str, Tag("<zone>")] | Annotated[Area, Tag("<area>")],
    Discriminator(_place_tag),
    AnyOf(),
]


class GoalArea(Spec):
    """An area in which goals are drawn uniformly."""

    area: Place = Field(description="Name of a zone, or an area written here.")
    next: tuple[str, ...] = default(
        (), "Goal areas that may follow in a `linked` walk.", strict=False
    )
