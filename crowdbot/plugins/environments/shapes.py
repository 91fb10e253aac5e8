"""Walls, blocks and pillars in documents, each with its own bottom and top."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated

from annotated_types import Len
from pydantic import Field, field_validator, model_validator

from crowdbot.plugin import (
    Face,
    Heights,
    Length,
    Pillar,
    PositiveLength,
    Solid,
    Spec,
    default,
    outlines,
)

Point = Annotated[tuple[Length, Length], Field(strict=False)]
Corners = Annotated[tuple[Point, ...], Len(3, 4096), Field(strict=False)]

#: Outlines with less area count as a line, m^2.
_LEAST_AREA = 1e-9


class UprightSpec(Spec):
    """An obstacle between two heights."""

    base: Length = default(
        0.0,
        "Its lower edge above the floor, m: 0 for what stands, more for what hangs.",
        omitted=True,
    )
    height: PositiveLength | None = default(
        None, "Its upper edge above the floor, m; without it `wall_height`.", omitted=True
    )

    def heights(self, usual: float) -> Heights:
        """Return bottom and top, m.

        Args:
            usual: default top, m.
        """
        return self.base, usual if self.height is None else self.height

    @model_validator(mode="after")
    def _base_below_top(self) -> UprightSpec:
        if self.base < 0.0:
            raise ValueError("base must not be below the floor, 0 m")
        if self.height is not None and not self.base < self.height:
            raise ValueError(f"base {self.base:g} m must be below height {self.height:g} m")
        return self


class WallSpec(UprightSpec):
    """A straight wall, solid on both sides of the line between its ends."""

    start: Point = Field(description="One end, x and y, m.")
    end: Point = Field(description="The other end, x and y, m.")
    thickness: PositiveLength = default(0.1, "Thickness, m.")

    @model_validator(mode="after")
    def _long(self) -> WallSpec:
        if self.start == self.end:
            raise ValueError("start and end of a wall must differ")
        return self

    def solid(self, usual: float) -> Solid:
        """Return the wall as a solid; ``usual`` as in `heights`."""
        return Solid(
            outline=strip(self.start, self.end, self.thickness), heights=self.heights(usual)
        )


class BlockSpec(UprightSpec):
    """A solid block, convex or not, optionally with holes."""

    corners: Corners = Field(
        strict=False,
        description="Corners of the outline, in either sense, convex or not, m.",
    )
    holes: tuple[Corners, ...] = default(
        (), "Outlines of what is free within it, such as courtyards, m.", strict=False, omitted=True
    )

    @field_validator("corners")
    @classmethod
    def _simple(cls, corners: tuple[Point, ...]) -> tuple[Point, ...]:
        """Return the corners, counter-clockwise."""
        return simple_outline(corners, "corners")

    @field_validator("holes")
    @classmethod
    def _simple_holes(cls, holes: tuple[tuple[Point, ...], ...]) -> tuple[tuple[Point, ...], ...]:
        return tuple(simple_outline(hole, f"holes.{k}") for k, hole in enumerate(holes))

    @model_validator(mode="after")
    def _holes_inside(self) -> BlockSpec:
        check_holes(self.corners, self.holes)
        return self

    def solid(self, usual: float) -> Solid:
        """Return the block as a solid; ``usual`` as in `heights`."""
        return Solid(outline=self.corners, holes=self.holes, heights=self.heights(usual))


class PillarSpec(UprightSpec):
    """A round pillar."""

    x: Length = Field(description="Centre, m.")
    y: Length = Field(description="Centre, m.")
    radius: PositiveLength = Field(description="Radius, m.")

    def pillar(self, usual: float) -> Pillar:
        """Return the pillar with its heights; ``usual`` as in `heights`."""
        return Pillar(x=self.x, y=self.y, radius=self.radius, heights=self.heights(usual))


def check_heights(named: Mapping[str, UprightSpec], usual: float) -> None:
    """Refuse obstacles that would begin above their top.

    Raises:
        ValueError: an obstacle without its own top begins above the default one.
    """
    for name, one in named.items():
        bottom, top = one.heights(usual)
        if not bottom < top:
            raise ValueError(f"'{name}' has base {bottom:g} m and, by wall_height, top {top:g} m")


def strip(start: Point, end: Point, thickness: float) -> tuple[Point, ...]:
    """Return the corners of a straight wall, counter-clockwise."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    scale = 0.5 * thickness / math.hypot(dx, dy)
    ux, uy = -dy * scale, dx * scale
    return (
        (start[0] - ux, start[1] - uy),
        (end[0] - ux, end[1] - uy),
        (end[0] + ux, end[1] + uy),
        (start[0] + ux, start[1] + uy),
    )


def closed(outline: tuple[Point, ...], heights: Heights) -> Face:
    """Return the faces of an outline that is free inside, given counter-clockwise."""
    return Face(points=(*outline, outline[0]), heights=heights)


def simple_outline(corners: tuple[Point, ...], name: str) -> tuple[Point, ...]:
    """Return a simple outline, counter-clockwise.

    Raises:
        ValueError: it crosses or touches itself (the message says where), or has no area.
    """
    for k, point in enumerate(corners):
        if point == corners[k - 1]:
            raise ValueError(f"{name}: corner {k} at {_at(point)} is there twice in a row")
    flat = all(
        abs(outlines.turn(corners[k - 2], corners[k - 1], corner)) < _LEAST_AREA
        for k, corner in enumerate(corners)
    )
    found = None if flat else outlines.first_crossing(corners)
    if found is not None:
        (a, b), (c, d) = (list(outlines.sides(corners))[k] for k in found)
        raise ValueError(
            f"{name}: the side from {_at(a)} to {_at(b)} meets the one from {_at(c)} to {_at(d)}; "
            "an outline must not cross or touch itself"
        )
    if abs(outlines.signed_area(corners)) < _LEAST_AREA:
        raise ValueError(f"{name} must have an area")
    return outlines.counter_clockwise(corners)


def check_holes(outline: tuple[Point, ...], holes: tuple[tuple[Point, ...], ...]) -> None:
    """Refuse holes that are not inside the outline or that touch each other.

    Raises:
        ValueError: one is not.
    """
    for k, hole in enumerate(holes):
        others = [outline, *holes[:k]]
        if any(
            outlines.touch(a, b)
            for other in others
            for a in outlines.sides(hole)
            for b in outlines.sides(other)
        ):
            raise ValueError(f"holes.{k} touches the outline or another hole")
        if not outlines.contains(outline, *hole[0]):
            raise ValueError(f"holes.{k} lies outside of the outline")
        if any(outlines.contains(o, *hole[0]) or outlines.contains(hole, *o[0]) for o in holes[:k]):
            raise ValueError(f"holes.{k} and another hole contain each other")


def _at(point: Point) -> str:
    return f"({point[0]:g}, {point[1]:g})"
