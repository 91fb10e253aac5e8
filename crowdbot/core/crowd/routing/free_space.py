"""Free space for the centre of a person: the floor without a margin around walls and pillars."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array

#: Sides of the polygon that stands for a pillar.
_PILLAR_SIDES = 16
#: How far beyond a body's radius the margin reaches at a corner, as a multiple: flat there.
_MITRE = 1.1
#: Corners that stand out by less are left away, m.
_SIMPLER = 0.005
#: What is farther from a part than this is not on its border, m.
_BESIDE = 1e-6
#: The floor goes on so far beyond everything that is on it, m.
_AROUND = 5.0


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Parts of the floor between which there is no way.

    Attributes:
        taken: (Multi)polygon in which no centre can be.
        parts: polygons that are left, from the largest to the smallest.
    """

    taken: Any
    parts: tuple[Any, ...]

    @classmethod
    def of(cls, walls: Array, pillars: Array, radius: float, points: Array) -> FreeSpace:
        """The space that a body of a radius can reach.

        Args:
            walls: (S, 4) segments, m.
            pillars: (P, 3) x, y, radius, m.
            radius: of the body, m.
            points: (M, 2) places that the floor holds, m.
        """
        taken = taken_by(walls, pillars, radius)
        ends = np.concatenate([walls.reshape(-1, 2), pillars[:, :2], points])
        low, high = (ends.min(axis=0), ends.max(axis=0)) if len(ends) else (np.zeros(2),) * 2
        floor = shapely.box(*(low - _AROUND), *(high + _AROUND))
        parts = shapely.get_parts(shapely.difference(floor, taken)).tolist()
        return cls(taken, tuple(sorted(parts, key=lambda p: (-p.area, *p.bounds))))

    def part_of(self, points: Array) -> NDArray[np.int64]:
        """Number (M,) of the part in which each of (M, 2) points lies; -1 in none."""
        found = np.full(len(points), -1, np.int64)
        for number, part in enumerate(self.parts):
            open_ = np.flatnonzero(found < 0)
            if not len(open_):
                break
            shapely.prepare(part)
            inside = shapely.intersects_xy(part, points[open_, 0], points[open_, 1])
            found[open_[inside]] = number
        return found

    def holding(self, points: Array) -> FreeSpace:
        """The parts in which some of (M, 2) points lie, with the same that is taken."""
        numbers = sorted(set(self.part_of(points).tolist()) - {-1})
        return FreeSpace(self.taken, tuple(self.parts[n] for n in numbers))

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """True for each of (M, 2) points that is in one of the parts or on its border."""
        whole = shapely.union_all([shapely.buffer(part, _BESIDE) for part in self.parts])
        shapely.prepare(whole)
        inside: NDArray[np.bool_] = shapely.intersects_xy(whole, points[:, 0], points[:, 1])
        return inside

    def borders(self) -> list[Array]:
        """Outlines (K, 2) of what is taken as seen from the parts, not closed."""
        found, outermost = [], shapely.bounds(self.taken)
        for part in self.parts:
            low, high = np.split(np.asarray(part.bounds) - outermost, 2)
            ends_nowhere = np.all(low < 0.0) and np.all(high > 0.0)  # where the floor was cut
            rings = part.interiors if ends_nowhere else (part.exterior, *part.interiors)
            found += [np.asarray(ring.coords)[:-1] for ring in rings]
        return found

    def rings(self) -> list[Array]:
        """Outlines (K, 2) of what is taken, not closed; it is on the left of each."""
        found = []
        for polygon in shapely.get_parts(self.taken):
            whole = shapely.geometry.polygon.orient(polygon)
            found += [np.asarray(r.coords)[:-1] for r in (whole.exterior, *whole.interiors)]
        return sorted(found, key=lambda ring: (len(ring), *ring[0]))


def taken_by(walls: Array, pillars: Array, margin: float) -> Any:
    """The space within a margin of walls and pillars, as a (multi)polygon.

    Corners stand out by at most a tenth of the margin: round ones would have more corners.
    """
    lines = shapely.line_merge(shapely.multilinestrings(walls.reshape(-1, 2, 2)))
    around = shapely.buffer(
        lines, margin, join_style="mitre", mitre_limit=_MITRE, cap_style="square"
    )
    angles = (np.arange(_PILLAR_SIDES) + 0.5) * (2.0 * math.pi / _PILLAR_SIDES)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) / math.cos(math.pi / _PILLAR_SIDES)
    discs = [shapely.Polygon(p[:2] + (p[2] + margin) * circle) for p in pillars]
    together = shapely.union_all([around, *discs])
    return shapely.simplify(together, _SIMPLER, preserve_topology=True)
