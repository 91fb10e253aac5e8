"""Floor: a rectangle with walls, blocks and pillars; fenced, open, or a torus."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from crowdbot.plugin import Component, EnvironmentSpec, Place, PositiveLength, Rectangle, default
from crowdbot.plugins.environments.shapes import (
    BlockSpec,
    PillarSpec,
    Point,
    WallSpec,
    check_heights,
    closed,
)

__all__ = ["FLOOR", "BlockSpec", "FloorSpec", "PillarSpec", "WallSpec"]


class FloorSpec(EnvironmentSpec):
    """Any floor: walls, blocks and pillars on a rectangle of the world frame."""

    kind: Literal["floor"] = "floor"
    area: Rectangle = Field(description="The floor.")
    border: Literal["walls", "open", "torus"] = default(
        "walls", "At the sides: walls; nothing; or people come in again on the other side."
    )
    walls: dict[str, WallSpec] = default({}, "Named straight walls.")
    blocks: dict[str, BlockSpec] = default({}, "Named solid blocks.")
    pillars: dict[str, PillarSpec] = default({}, "Named round pillars.")
    wall_height: PositiveLength = default(
        2.5, "Height of walls, blocks and pillars without their own, m."
    )

    @property
    def periodic_floor(self) -> Rectangle | None:
        """Return the whole floor if it is a torus."""
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
        check_heights({**self.walls, **self.blocks, **self.pillars}, self.wall_height)
        return self

    def place(self) -> Place:
        """Return the place: border walls face inwards, obstacles face outwards."""
        usual = self.wall_height
        (x0, x1), (y0, y1) = self.area.x, self.area.y
        fence = (closed(self.area.polygon, (0.0, usual)),)
        return Place(
            faces=fence if self.border == "walls" else (),
            solids=(
                *(wall.solid(usual) for wall in self.walls.values()),
                *(block.solid(usual) for block in self.blocks.values()),
            ),
            pillars=tuple(p.pillar(usual) for p in self.pillars.values()),
            torus=(x0, x1, y0, y1) if self.border == "torus" else None,
        )


def _points(floor: FloorSpec) -> list[tuple[str, Point]]:
    found = [(f"wall '{n}'", p) for n, w in floor.walls.items() for p in (w.start, w.end)]
    found += [(f"block '{n}'", p) for n, b in floor.blocks.items() for p in b.corners]
    return found + [(f"pillar '{n}'", (p.x, p.y)) for n, p in floor.pillars.items()]


FLOOR = Component(
    spec=FloorSpec,
    build="crowdbot.plugins.environments.place_build:build",
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
