"""Floor: a rectangle with free walls, blocks and pillars, fenced, open, or a torus."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from annotated_types import Len
from pydantic import Field, field_validator, model_validator

from crowdbot.dsl import Component, EnvironmentSpec, Length, PositiveLength, Rectangle, Spec

Point = Annotated[tuple[Length, Length], Field(strict=False)]


class WallSpec(Spec):
    """A straight wall, solid on both sides of the line between its ends."""

    start: Point = Field(description="One end, x and y, m.")
    end: Point = Field(description="The other end, x and y, m.")
    thickness: PositiveLength = Field(default=0.1, description="Thickness, m.")

    @model_validator(mode="after")
    def _long(self) -> WallSpec:
        if self.start == self.end:
            raise ValueError("start and end of a wall must differ")
        return self


class BlockSpec(Spec):
    """A solid convex block."""

    corners: Annotated[tuple[Point, ...], Len(3, 64)] = Field(
        strict=False, description="Corners of the convex outline, in either sense, m."
    )

    @field_validator("corners")
    @classmethod
    def _convex(cls, corners: tuple[Point, ...]) -> tuple[Point, ...]:
        """The corners, counter-clockwise."""
        turns = [_turn(*(corners[(i + k) % len(corners)] for k in range(3)))
                 for i in range(len(corners))]  # fmt: skip
        if not (all(t > 0.0 for t in turns) or all(t < 0.0 for t in turns)) or _winds(corners):
            raise ValueError(
                "corners must form a convex outline, each a turn to the same side; "
                "make several blocks of a concave one"
            )
        return corners if turns[0] > 0.0 else corners[::-1]


class PillarSpec(Spec):
    """A round pillar."""

    x: Length = Field(description="Centre, m.")
    y: Length = Field(description="Centre, m.")
    radius: PositiveLength = Field(description="Radius, m.")


class FloorSpec(EnvironmentSpec):
    """Any floor: walls, blocks and pillars on a rectangle of the world frame."""

    kind: Literal["floor"] = "floor"
    area: Rectangle = Field(description="The floor.")
    border: Literal["walls", "open", "torus"] = Field(
        default="walls",
        description="At the sides: walls; nothing; or people come in again on the other side.",
    )
    walls: dict[str, WallSpec] = Field(default={}, description="Named straight walls.")
    blocks: dict[str, BlockSpec] = Field(default={}, description="Named solid blocks.")
    pillars: dict[str, PillarSpec] = Field(default={}, description="Named round pillars.")
    wall_height: PositiveLength = Field(
        default=2.5, description="Height of all walls, blocks and pillars, m."
    )

    @property
    def periodic_floor(self) -> Rectangle | None:
        """The whole floor of a torus."""
        return self.area if self.border == "torus" else None

    @model_validator(mode="after")
    def _inside(self) -> FloorSpec:
        for name, point in _points(self):
            if not self.area.contains(*point):
                raise ValueError(f"{name} leaves the area of the floor")
        for name, zone in self.zones.items():
            if not (self.area.contains(zone.x[0], zone.y[0]) and self.area.contains(
                zone.x[1], zone.y[1]
            )):  # fmt: skip
                raise ValueError(f"zone '{name}' leaves the area of the floor")
        return self


def _points(floor: FloorSpec) -> list[tuple[str, Point]]:
    found = [(f"wall '{n}'", p) for n, w in floor.walls.items() for p in (w.start, w.end)]
    found += [(f"block '{n}'", p) for n, b in floor.blocks.items() for p in b.corners]
    return found + [(f"pillar '{n}'", (p.x, p.y)) for n, p in floor.pillars.items()]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Above 0 for a turn to the left at b."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _winds(corners: tuple[Point, ...]) -> bool:
    """Whether an outline that always turns to the same side goes round more than once."""
    first = corners[0]
    fan = [_turn(first, b, c) for b, c in pairwise(corners[1:])]
    return not (all(t > 0.0 for t in fan) or all(t < 0.0 for t in fan))


FLOOR = Component(
    spec=FloorSpec,
    build="crowdbot.plugins.environments.floor_build:build",
    summary="rectangle with free walls, blocks and pillars; fenced, open or a torus",
    examples=(
        {
            "area": {"x": [0.0, 20.0], "y": [0.0, 10.0]},
            "walls": {"screen": {"start": [8.0, 3.0], "end": [8.0, 7.0]}},
            "blocks": {"kiosk": {"corners": [[12.0, 4.0], [14.0, 4.0], [13.0, 6.0]]}},
            "pillars": {"north": {"x": 5.0, "y": 8.0, "radius": 0.4}},
        },
        {"area": {"x": [0.0, 30.0], "y": [-5.0, 5.0]}, "border": "torus"},
    ),
)
