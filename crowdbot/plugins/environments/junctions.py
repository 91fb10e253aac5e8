"""Corridors that turn or meet: a corner and a T-junction."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    Place,
    PositiveLength,
    Quantity,
    Rectangle,
    default,
    outlines,
)
from crowdbot.plugins.environments.walkways import (
    PORTAL_DEPTH,
    WalkwaySpec,
    box,
    rounded,
    walkway,
)

_RIGHT = math.pi / 2


class CornerSpec(WalkwaySpec):
    """A corridor along x that turns left; origin where the middle lines meet."""

    kind: Literal["corner"] = "corner"
    length: PositiveLength = default(12.0, "From the start to the turn, m.")
    beyond: PositiveLength = default(12.0, "From the turn to the end, m.")
    width: PositiveLength = default(3.0, "Width, m.")
    angle: Annotated[float, Ge(math.radians(20)), Le(math.radians(150)), Quantity("angle")] = (
        default(_RIGHT, "Of the turn, 20 to 150 deg, rad.")
    )
    corner_radius: NonNegativeLength = default(0.0, "Of the inner corner, m; 0: square.")

    def place(self) -> Place:
        """Return the place; people walk through both ends."""
        start, outer, right, left, inner, back = self._outline()
        arc = rounded(left, inner, back, self.corner_radius)
        outline = (start, outer, right, left, *arc, back)
        return Place(faces=walkway(outline, (2, len(outline) - 1), self.wall_height))

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return the areas before and behind the turn; if askew, the box around the second."""
        half, (_, _, right, left, inner, _) = 0.5 * self.width, self._outline()
        found = {"start": box(-self.length, min(inner[0], -half), -half, half)}
        if self.angle == _RIGHT:
            found["end"] = box(-half, half, half, self.beyond)
            found["turn"] = box(-half, half, -half, half)
            return found
        ux, uy = math.cos(self.angle), math.sin(self.angle)
        # The corners are those of the end and, across the middle line, those before them.
        back = [(x - self._away(inner) * ux, y - self._away(inner) * uy) for x, y in (right, left)]
        xs, ys = zip(*(right, left, *back), strict=True)
        return found | {"end": box(min(xs), max(xs), min(ys), max(ys))}

    def _away(self, inner: outlines.Point) -> float:
        """Return the distance from the inner corner to the end behind the turn, m."""
        along = inner[0] * math.cos(self.angle) + inner[1] * math.sin(self.angle)
        return self.beyond - along

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return a portal behind the start, and one behind the end if the turn is square."""
        half = 0.5 * self.width
        portals = {"start": box(-self.length - PORTAL_DEPTH, -self.length, -half, half)}
        if self.angle == _RIGHT:
            portals["end"] = box(-half, half, self.beyond, self.beyond + PORTAL_DEPTH)
        return portals

    def check_shape(self) -> None:
        """Refuse parts that are shorter than the turn."""
        start, _, _, left, inner, back = self._outline()
        room = min(inner[0] - back[0], math.dist(inner, left))
        along = math.cos(self.angle) * (left[0] - inner[0]) + math.sin(self.angle) * (
            left[1] - inner[1]
        )
        if inner[0] <= start[0] or along <= 0.0:
            raise ValueError("length and beyond must be longer than the turn")
        reach = self.corner_radius * math.tan(0.5 * self.angle)
        if reach > room - 1e-9:
            raise ValueError(f"corner_radius {self.corner_radius:g} m is too large for the turn")

    def _outline(self) -> outlines.Outline:
        """Return the outline: start, outer corner, both sides of the end, inner corner, start."""
        half, cos, sin = 0.5 * self.width, math.cos(self.angle), math.sin(self.angle)
        cos = 0.0 if self.angle == _RIGHT else cos
        turn = half * (cos - 1.0) / sin
        ex, ey = self.beyond * cos, self.beyond * sin
        return (
            (-self.length, -half), (-turn, -half),
            (ex + half * sin, ey - half * cos), (ex - half * sin, ey + half * cos),
            (turn, half), (-self.length, half),
        )  # fmt: skip


class TJunctionSpec(WalkwaySpec):
    """A corridor along x, and another that meets it from below; origin where they meet."""

    kind: Literal["t_junction"] = "t_junction"
    length: PositiveLength = default(24.0, "Of the corridor along x, m.")
    width: PositiveLength = default(4.0, "Of the corridor along x, m.")
    stem_length: PositiveLength = default(12.0, "Of the other one, m.")
    stem_width: PositiveLength = default(3.0, "Of the other one, m.")

    def place(self) -> Place:
        """Return the place; people walk through the three ends."""
        half, low, stem = 0.5 * self.length, 0.5 * self.width, 0.5 * self.stem_width
        end = -low - self.stem_length
        outline = (
            (half, -low), (half, low), (-half, low), (-half, -low),
            (-stem, -low), (-stem, end), (stem, end), (stem, -low),
        )  # fmt: skip
        return Place(faces=walkway(outline, (0, 2, 5), self.wall_height))

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return the three arms and the middle."""
        half, low, stem = 0.5 * self.length, 0.5 * self.width, 0.5 * self.stem_width
        return {
            "west": box(-half, -stem, -low, low),
            "middle": box(-stem, stem, -low, low),
            "east": box(stem, half, -low, low),
            "stem": box(-stem, stem, -low - self.stem_length, -low),
        }

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return portals behind the three ends."""
        half, low, stem = 0.5 * self.length, 0.5 * self.width, 0.5 * self.stem_width
        end = -low - self.stem_length
        return {
            "west": box(-half - PORTAL_DEPTH, -half, -low, low),
            "east": box(half, half + PORTAL_DEPTH, -low, low),
            "stem": box(-stem, stem, end - PORTAL_DEPTH, end),
        }

    def check_shape(self) -> None:
        """Refuse a stem that does not meet the corridor's side."""
        if not self.stem_width < self.length:
            raise ValueError("stem_width must be smaller than length")


CORNER = Component(
    spec=CornerSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="corridor that turns left by an angle; blind or rounded corner",
    examples=({}, {"angle": math.radians(50), "corner_radius": 1.5, "width": 4.0}),
)
T_JUNCTION = Component(
    spec=TJunctionSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="corridor that another one meets from one side",
)
