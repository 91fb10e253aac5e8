"""Sets of pillars: in a grid, or drawn with a seed."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Annotated

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    NonNegativeLength,
    Pillar,
    PositiveLength,
    Rectangle,
    Spec,
    default,
    outlines,
)
from crowdbot.plugins.environments.shapes import PillarSpec

Count = Annotated[int, Ge(1), Le(1000)]
#: Attempts to place one pillar before giving up.
_ATTEMPTS = 1000


class PillarGridSpec(Spec):
    """Pillars in columns and rows, evenly spread."""

    columns: Count = Field(description="How many along x.")
    rows: Count = Field(description="How many along y.")
    radius: PositiveLength = default(0.3, "Radius, m.")
    area: Rectangle | None = default(None, "Where they are; without it the whole floor.")

    def pillars(self, floor: Rectangle, top: float) -> tuple[Pillar, ...]:
        """Return the pillars, spread evenly: along each side all gaps are equal."""
        area = self.area or floor
        xs, ys = _even(area.x, self.columns), _even(area.y, self.rows)
        return tuple(
            Pillar(x=x, y=y, radius=self.radius, heights=(0.0, top)) for x in xs for y in ys
        )


class PillarFieldSpec(Spec):
    """Pillars at random places with minimum gaps; the same seed gives the same pillars."""

    count: Count = Field(description="How many.")
    seed: Annotated[int, Ge(0), Le(2**63 - 1)] = default(0, "Draws them.")
    radius: PositiveLength = default(0.3, "Smallest radius, m.")
    largest_radius: PositiveLength | None = default(
        None, "Largest radius, m; without it all have the smallest."
    )
    gap: NonNegativeLength = default(1.5, "Least gap between the surfaces of two of them, m.")
    wall_gap: NonNegativeLength = default(
        1.0, "Least gap between one of them and the area's sides, m."
    )
    area: Rectangle | None = default(None, "Where they are; without it the whole floor.")

    def pillars(self, floor: Rectangle, top: float) -> tuple[Pillar, ...]:
        """Return the pillars, placed one by one at the first free random position.

        Raises:
            ValueError: they do not fit.
        """
        return _drawn(self, self.area or floor, top)

    def draw(self, area: Rectangle, top: float) -> tuple[Pillar, ...]:
        """Draw the pillars, as `pillars` does, without using its cache."""
        pillars = list[Pillar]()
        for number in range(self.count):
            radius = self._radius(number)
            for attempt in range(_ATTEMPTS):
                at = self._place(area, radius, number, attempt)
                if at is not None and all(self._apart(at, radius, p) for p in pillars):
                    pillars.append(Pillar(x=at[0], y=at[1], radius=radius, heights=(0.0, top)))
                    break
            else:
                raise ValueError(f"pillar_field: only {number} of {self.count} pillars fit")
        return tuple(pillars)

    def _radius(self, number: int) -> float:
        largest = self.radius if self.largest_radius is None else self.largest_radius
        return self.radius + (largest - self.radius) * self._uniform("radius", number, 0)

    def _place(
        self, area: Rectangle, radius: float, number: int, attempt: int
    ) -> outlines.Point | None:
        margin = radius + self.wall_gap
        (x0, x1), (y0, y1) = area.x, area.y
        if x1 - x0 < 2.0 * margin or y1 - y0 < 2.0 * margin:
            return None
        u, v = self._uniform("x", number, attempt), self._uniform("y", number, attempt)
        return x0 + margin + u * (x1 - x0 - 2 * margin), y0 + margin + v * (y1 - y0 - 2 * margin)

    def _apart(self, at: outlines.Point, radius: float, other: Pillar) -> bool:
        return math.dist(at, (other.x, other.y)) >= radius + other.radius + self.gap

    def _uniform(self, label: str, number: int, attempt: int) -> float:
        text = f"{self.seed}/pillars/{label}/{number}/{attempt}".encode()
        return int.from_bytes(hashlib.sha256(text).digest()[:6], "big") / 2.0**48


@lru_cache(maxsize=64)  # every scenario of a suite asks for the same field
def _drawn(field: PillarFieldSpec, area: Rectangle, top: float) -> tuple[Pillar, ...]:
    return field.draw(area, top)


def _even(ends: tuple[float, float], count: int) -> list[float]:
    step = (ends[1] - ends[0]) / (count + 1)
    return [ends[0] + (k + 1) * step for k in range(count)]


def all_pillars(
    named: Iterable[PillarSpec],
    sets: Iterable[PillarGridSpec | PillarFieldSpec | None],
    floor: Rectangle,
    top: float,
) -> tuple[Pillar, ...]:
    """Return the pillars of a floor: the named ones, then those of grids and fields.

    Args:
        named: single pillars.
        sets: grids and fields; entries may be None.
        floor: where they stand.
        top: height of the walls, m, which pillars reach by default.
    """
    pillars = tuple(pillar.pillar(top) for pillar in named)
    for many in sets:
        pillars += () if many is None else many.pillars(floor, top)
    return pillars
