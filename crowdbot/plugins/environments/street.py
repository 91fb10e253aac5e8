"""Street: façades with doors, pavements with kerbs, crossings and furniture."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from crowdbot.plugin import (
    Angle,
    Component,
    Length,
    Pillar,
    Place,
    PositiveLength,
    Rectangle,
    Solid,
    Spec,
    default,
)
from crowdbot.plugins.environments.shapes import strip
from crowdbot.plugins.environments.walkways import OpeningSpec, WalkwaySpec, box, hall

#: Width of a kerb stone, m.
_KERB = 0.15
#: Default length, width and height of furniture with corners; diameter and height of round items,
#: m.
_BOXES = {"bench": (1.8, 0.5, 0.45), "planter": (1.2, 0.6, 0.6), "stall": (2.5, 1.5, 2.2)}
_ROUND = {"bin": (0.5, 1.0), "bollard": (0.2, 0.9), "lamp": (0.2, 4.0), "tree": (0.4, 5.0)}


class FurnitureSpec(Spec):
    """A piece of street furniture with a default size."""

    item: Literal["bench", "bin", "bollard", "lamp", "planter", "stall", "tree"] = Field(
        description="What it is: a bench is 1.8 m × 0.5 m × 0.45 m, a planter 1.2 m × 0.6 m × "
        "0.6 m, a stall 2.5 m × 1.5 m × 2.2 m; across and high are a bin 0.5 m and 1 m, a bollard "
        "0.2 m and 0.9 m, a lamp 0.2 m and 4 m, a tree 0.4 m and 5 m."
    )
    x: Length = Field(description="Its middle, m.")
    y: Length = Field(description="Its middle, m.")
    heading: Angle = default(0.0, "Of its long side, from x, rad.")


class CrossingSpec(Spec):
    """A crossing, where kerbs are lowered so that wheels can pass."""

    at: Length = Field(description="Its middle along the street, m.")
    width: PositiveLength = default(3.0, "Along the street, m.")


class StreetSpec(WalkwaySpec):
    """A street along x with its origin in the middle.

    People leave through ends, doors and openings.

    Default sizes are proposed here, within the range of town streets.
    """

    kind: Literal["street"] = "street"
    length: PositiveLength = default(50.0, "Along x, m.")
    roadway: PositiveLength = default(6.0, "Width between the kerbs, m.")
    pavement: PositiveLength = default(3.0, "Width of each pavement, m.")
    kerbs: Literal["step", "flush"] = default(
        "step",
        "step: people step over them, and they stop "
        "wheels except at crossings; flush: they stop no one.",
    )
    kerb_height: PositiveLength = default(0.12, "Of a step, m.")
    crossings: dict[str, CrossingSpec] = default(
        {"middle": CrossingSpec(at=0.0)}, "Named crossings."
    )
    doors: dict[str, OpeningSpec] = default(
        {}, "Doors in the façades, each a portal of the same name."
    )
    openings: dict[str, OpeningSpec] = default(
        {}, "Side streets and gateways, each a portal of the same name."
    )
    furniture: dict[str, FurnitureSpec] = default({}, "Named furniture.")
    wall_height: PositiveLength = default(6.0, "Height of the façades, m.")

    @property
    def area(self) -> Rectangle:
        """Return the area from façade to façade."""
        half = 0.5 * self.roadway + self.pavement
        return box(-0.5 * self.length, 0.5 * self.length, -half, half)

    def place(self) -> Place:
        """Return façades, kerbs and furniture."""
        faces, _ = hall(self.area, self._all_openings(), self.wall_height)
        solids = [*self._kerbs(), *(s for f in self.furniture.values() for s in _boxes(f))]
        pillars = tuple(p for f in self.furniture.values() for p in _pillars(f))
        return Place(faces=faces, solids=tuple(solids), pillars=pillars)

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return both pavements and the roadway."""
        (x0, x1), (y0, y1), edge = self.area.x, self.area.y, 0.5 * self.roadway
        return {
            "south_pavement": box(x0, x1, y0, -edge - _KERB),
            "roadway": box(x0, x1, -edge, edge),
            "north_pavement": box(x0, x1, edge + _KERB, y1),
        }

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return portals behind both ends, the doors and the openings."""
        return hall(self.area, self._all_openings(), self.wall_height)[1]

    def check_shape(self) -> None:
        """Refuse pavements narrower than kerbs, furniture outside the street, and equal names."""
        if not self.pavement > _KERB:
            raise ValueError(f"pavement must be wider than a kerb of {_KERB:g} m")
        twice = sorted(set(self.doors) & set(self.openings))
        taken = sorted({"west", "east"} & {*self.doors, *self.openings})
        if twice or taken:
            raise ValueError(f"two openings are called '{(twice or taken)[0]}'")
        wrong = [
            n for n, o in {**self.doors, **self.openings}.items() if o.side in ("west", "east")
        ]
        if wrong:
            raise ValueError(f"opening '{wrong[0]}' must be in the south or north façade")
        for name, one in self.furniture.items():
            if not self.area.contains(one.x, one.y):
                raise ValueError(f"furniture '{name}' leaves the street")

    def _all_openings(self) -> dict[str, OpeningSpec]:
        whole = self.roadway + 2.0 * self.pavement
        ends = {
            "west": OpeningSpec(side="west", at=0.0, width=whole),
            "east": OpeningSpec(side="east", at=0.0, width=whole),
        }
        return {**ends, **self.openings, **self.doors}

    def _kerbs(self) -> list[Solid]:
        """Return kerb stones along both pavements, with gaps at the crossings."""
        if self.kerbs == "flush":
            return []
        gaps = sorted((c.at - 0.5 * c.width, c.at + 0.5 * c.width) for c in self.crossings.values())
        pieces, last = list[tuple[float, float]](), -0.5 * self.length
        for low, high in (*gaps, (0.5 * self.length, math.inf)):
            if low > last:
                pieces.append((last, low))
            last = max(last, high)
        middle = 0.5 * self.roadway + 0.5 * _KERB
        return [
            Solid(
                outline=strip((x0, side * middle), (x1, side * middle), _KERB),
                heights=(0.0, self.kerb_height),
                stops_crowd=False,
            )
            for side in (-1.0, 1.0)
            for x0, x1 in pieces
        ]


def _boxes(one: FurnitureSpec) -> list[Solid]:
    if one.item not in _BOXES:
        return []
    length, width, height = _BOXES[one.item]
    dx, dy = 0.5 * length * math.cos(one.heading), 0.5 * length * math.sin(one.heading)
    outline = strip((one.x - dx, one.y - dy), (one.x + dx, one.y + dy), width)
    return [Solid(outline=outline, heights=(0.0, height))]


def _pillars(one: FurnitureSpec) -> list[Pillar]:
    if one.item not in _ROUND:
        return []
    across, height = _ROUND[one.item]
    return [Pillar(x=one.x, y=one.y, radius=0.5 * across, heights=(0.0, height))]


STREET = Component(
    spec=StreetSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="street with façades, doors, pavements, kerbs, crossings and furniture",
    examples=(
        {},
        {
            "kerbs": "flush",
            "doors": {"shop": {"side": "north", "at": -8.0, "width": 1.2}},
            "openings": {"lane": {"side": "south", "at": 10.0, "width": 4.0}},
            "furniture": {
                "bench": {"item": "bench", "x": 5.0, "y": 4.5},
                "lamp": {"item": "lamp", "x": -5.0, "y": -4.0},
            },
        },
    ),
)
