"""Corridor: two side walls, two end walls that stop only the robot, and portals beyond the ends."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from crowdbot.plugin import (
    Component,
    EnvironmentSpec,
    Face,
    Pillar,
    Place,
    PositiveLength,
    Rectangle,
    default,
)
from crowdbot.plugins.environments.pillar_sets import PillarFieldSpec, PillarGridSpec, all_pillars
from crowdbot.plugins.environments.shapes import PillarSpec, check_heights


class CorridorSpec(EnvironmentSpec):
    """A corridor along x; the origin is on the centre line of the start wall."""

    kind: Literal["corridor"] = "corridor"
    length: PositiveLength = default(50.0, "Length along x, m.")
    width: PositiveLength = default(10.0, "Width along y, m.")
    wall_height: PositiveLength = default(2.5, "Height of the walls, m.")
    pillars: dict[str, PillarSpec] = default({}, "Named round pillars.", omitted=True)
    pillar_grid: PillarGridSpec | None = default(None, "Pillars in a grid.", omitted=True)
    pillar_field: PillarFieldSpec | None = default(None, "Pillars at random.", omitted=True)

    @model_validator(mode="after")
    def _inside(self) -> CorridorSpec:
        check_heights(self.pillars, self.wall_height)
        for name, pillar in self.pillars.items():
            if not self.area.contains(pillar.x, pillar.y):
                raise ValueError(f"pillar '{name}' leaves the corridor")
        self.columns()
        return self

    @property
    def area(self) -> Rectangle:
        """Return the floor between the walls."""
        return Rectangle(x=(0.0, self.length), y=(-0.5 * self.width, 0.5 * self.width))

    def columns(self) -> tuple[Pillar, ...]:
        """Return all pillars: named, in the grid, and random."""
        sets = self.pillar_grid, self.pillar_field
        return all_pillars(self.pillars.values(), sets, self.area, self.wall_height)

    def place(self) -> Place:
        """Return the place: side walls reach as far as the portals.

        End walls stop only the robot.
        """
        half, length, heights = 0.5 * self.width, self.length, (0.0, self.wall_height)
        first = min([0.0, *(p.x[0] for p in self.portals.values())])
        last = max([length, *(p.x[1] for p in self.portals.values())])
        sides = (((first, -half), (last, -half)), ((last, half), (first, half)))
        ends = (((0.0, half), (0.0, -half)), ((length, -half), (length, half)))
        return Place(
            faces=(
                *(Face(points=side, heights=heights) for side in sides),
                *(Face(points=end, heights=heights, stops_crowd=False) for end in ends),
            ),
            pillars=self.columns(),
        )


CORRIDOR = Component(
    spec=CorridorSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="straight corridor, with pillars or without; people walk through its ends into portals",
    examples=(
        {},
        {"pillars": {"west": {"x": 20.0, "y": 1.0, "radius": 0.4}}},
        {"pillar_field": {"count": 8, "seed": 2}},
    ),
)
