"""Halls and squares: a shed with gates and low walls, and a plaza."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    Pillar,
    Place,
    PositiveLength,
    Rectangle,
    Solid,
    default,
)
from crowdbot.plugins.environments.pillar_sets import PillarFieldSpec, PillarGridSpec, all_pillars
from crowdbot.plugins.environments.shapes import (
    BlockSpec,
    PillarSpec,
    Point,
    UprightSpec,
    WallSpec,
    check_heights,
)
from crowdbot.plugins.environments.walkways import OpeningSpec, WalkwaySpec, box, hall

#: Default lower and upper edge of a gate, and top of a low wall, m.
GATE, LOW_WALL = (0.3, 1.1), 0.3


class _HallSpec(WalkwaySpec):
    """A rectangular hall around the origin; obstacles in it have names."""

    length: PositiveLength = default(30.0, "Along x, m.")
    width: PositiveLength = default(20.0, "Along y, m.")
    openings: dict[str, OpeningSpec] = default(
        {}, "Openings in the outer walls, each a portal of the same name."
    )
    blocks: dict[str, BlockSpec] = default({}, "Named solid blocks.")
    pillars: dict[str, PillarSpec] = default({}, "Named round pillars.")
    pillar_grid: PillarGridSpec | None = default(None, "Pillars in a grid.")
    pillar_field: PillarFieldSpec | None = default(None, "Pillars at random.")

    @property
    def area(self) -> Rectangle:
        """Return the floor."""
        return box(-0.5 * self.length, 0.5 * self.length, -0.5 * self.width, 0.5 * self.width)

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return one portal behind each opening."""
        return hall(self.area, self.openings, self.wall_height)[1]

    def check_shape(self) -> None:
        """Refuse obstacles that do not stand on the floor."""
        check_heights({**self.blocks, **self.pillars}, self.wall_height)
        for name, point in self._points():
            if not self.area.contains(*point):
                raise ValueError(f"{name} leaves the floor")
        self.columns()

    def columns(self) -> tuple[Pillar, ...]:
        """Return all pillars: named, in the grid, and random."""
        sets = self.pillar_grid, self.pillar_field
        return all_pillars(self.pillars.values(), sets, self.area, self.wall_height)

    def solids(self) -> tuple[Solid, ...]:
        """Return the blocks."""
        return tuple(block.solid(self.wall_height) for block in self.blocks.values())

    def place(self) -> Place:
        """Return the outer walls and the obstacles between them."""
        faces, _ = hall(self.area, self.openings, self.wall_height)
        return Place(faces=faces, solids=self.solids(), pillars=self.columns())

    def _points(self) -> list[tuple[str, Point]]:
        found = [(f"block '{n}'", p) for n, b in self.blocks.items() for p in b.corners]
        return found + [(f"pillar '{n}'", (p.x, p.y)) for n, p in self.pillars.items()]


class ShedSpec(_HallSpec):
    """A large hall with gates and low walls.

    An ultrasound at a height of 0.15 m sees low walls, and not the gates; a lidar at 0.4 m sees the
    gates, and not the low walls.
    """

    kind: Literal["shed"] = "shed"
    length: PositiveLength = default(40.0, "Along x, m.")
    width: PositiveLength = default(24.0, "Along y, m.")
    wall_height: PositiveLength = default(6.0, "Of the outer walls, m.")
    gates: dict[str, WallSpec] | None = default(
        None, "Raised barriers, by default from 0.3 m to 1.1 m; without this field two."
    )
    low_walls: dict[str, WallSpec] | None = default(
        None, "Low walls, by default 0.3 m high; without this field two."
    )

    def solids(self) -> tuple[Solid, ...]:
        """Return blocks, gates and low walls."""
        gates, walls = self._gates(), self._low_walls()
        return (
            *super().solids(),
            *(_upright(wall, *GATE) for wall in gates.values()),
            *(_upright(wall, 0.0, LOW_WALL) for wall in walls.values()),
        )

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return the halves of the hall, and strips along its west and east sides."""
        x, y = 0.5 * self.length, 0.5 * self.width
        return {
            "west": box(-x, -0.75 * x, -y, y),
            "hall": box(-0.75 * x, 0.75 * x, -y, y),
            "east": box(0.75 * x, x, -y, y),
        }

    def _gates(self) -> dict[str, WallSpec]:
        if self.gates is not None:
            return self.gates
        x, y = 0.25 * self.length, 0.5 * self.width
        return {
            "west": WallSpec(start=(-x, 0.2 * y), end=(-x, 0.8 * y)),
            "east": WallSpec(start=(x, -0.8 * y), end=(x, -0.2 * y)),
        }

    def _low_walls(self) -> dict[str, WallSpec]:
        if self.low_walls is not None:
            return self.low_walls
        x, y = 0.25 * self.length, 0.5 * self.width
        return {
            "west": WallSpec(start=(-x, -0.8 * y), end=(-x, -0.2 * y), thickness=0.2),
            "east": WallSpec(start=(x, 0.2 * y), end=(x, 0.8 * y), thickness=0.2),
        }

    def _points(self) -> list[tuple[str, Point]]:
        walls = {**self._gates(), **self._low_walls()}
        return super()._points() + [
            (f"'{name}'", point) for name, w in walls.items() for point in (w.start, w.end)
        ]


class PlazaSpec(_HallSpec):
    """An open square with a fountain, trees and streets that lead into it."""

    kind: Literal["plaza"] = "plaza"
    fountain: NonNegativeLength = default(2.5, "Radius of the fountain in the middle, m; 0: none.")
    fountain_height: PositiveLength = default(0.6, "Of its rim, m.")
    wall_height: PositiveLength = default(6.0, "Of houses and trees, m.")
    openings: dict[str, OpeningSpec] = default(
        {
            "south": OpeningSpec(side="south", at=0.0, width=4.0),
            "east": OpeningSpec(side="east", at=0.0, width=4.0),
            "north": OpeningSpec(side="north", at=0.0, width=4.0),
            "west": OpeningSpec(side="west", at=0.0, width=4.0),
        },
        "Streets, each a portal of the same name.",
    )

    def columns(self) -> tuple[Pillar, ...]:
        """Return the fountain and the trees."""
        if self.fountain == 0.0:
            return super().columns()
        heights = (0.0, self.fountain_height)
        return (Pillar(x=0.0, y=0.0, radius=self.fountain, heights=heights), *super().columns())

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return four strips around the middle."""
        x, y = 0.5 * self.length, 0.5 * self.width
        return {
            "west": box(-x, -0.6 * x, -y, y),
            "south": box(-0.6 * x, 0.6 * x, -y, -0.6 * y),
            "north": box(-0.6 * x, 0.6 * x, 0.6 * y, y),
            "east": box(0.6 * x, x, -y, y),
        }


def _upright(wall: UprightSpec, base: float, top: float) -> Solid:
    """Return a wall as a solid, with the given heights if it names none."""
    assert isinstance(wall, WallSpec)
    named = "base" in wall.model_fields_set or wall.height is not None
    bottom, upper = wall.heights(top) if named else (base, top)
    return Solid(outline=wall.solid(top).outline, heights=(bottom, upper))


SHED = Component(
    spec=ShedSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="large hall with gates and low walls that some sensors see and others do not",
    examples=(
        {},
        {
            "openings": {"door": {"side": "west", "at": 0.0, "width": 3.0}},
            "gates": {"boom": {"start": [0.0, -6.0], "end": [0.0, -2.0], "base": 0.5}},
            "low_walls": {},
            "pillar_grid": {"columns": 5, "rows": 2},
        },
    ),
)
PLAZA = Component(
    spec=PlazaSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="square with a fountain, trees and streets that lead into it",
    examples=({}, {"fountain": 0.0, "pillar_field": {"count": 12, "seed": 4, "gap": 2.0}}),
)
