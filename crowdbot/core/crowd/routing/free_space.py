"""Free space for the centre of a person: the floor without a margin around walls and pillars."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array

#: Number of sides of the polygon for a pillar.
_PILLAR_SIDES = 16
#: Extent of the margin at a corner, relative to a body's radius; the corner is cut there.
_MITRE = 1.1
#: Smaller convex corners are removed, m.
_SIMPLER = 0.005
#: Larger distances from a part mean not on its border, m.
_BESIDE = 1e-6
#: Extent of the floor beyond everything on it, m.
_AROUND = 5.0


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Disconnected parts of the free floor.

    Attributes:
        taken: (multi)polygon that centres cannot enter.
        parts: remaining polygons, largest first.
    """

    taken: Any
    parts: tuple[Any, ...]

    @classmethod
    def of(cls, walls: Array, pillars: Array, radius: float, points: Array) -> FreeSpace:
        """Return the space that a body of a radius can reach.

        Args:
            walls: (S, 4) segments, m.
            pillars: (P, 3) x, y, radius, m.
            radius: radius of the body, m.
            points: (M, 2) positions on the floor, m.
        """
        taken = taken_by(walls, pillars, radius)
        ends = np.concatenate([walls.reshape(-1, 2), pillars[:, :2], points])
        low, high = (ends.min(axis=0), ends.max(axis=0)) if len(ends) else (np.zeros(2),) * 2
        floor = shapely.box(*(low - _AROUND), *(high + _AROUND))
        parts = shapely.get_parts(shapely.difference(floor, taken)).tolist()
        return cls(taken, tuple(sorted(parts, key=lambda p: (-p.area, *p.bounds))))

    def part_of(self, points: Array) -> NDArray[np.int64]:
        """Return the index (M,) of the part that contains each of (M, 2) points; -1 if none."""
        found = np.full(len(points), -1, np.int64)
        for number, part in enumerate(self.parts):
            open_ = np.flatnonzero(found < 0)
            if not len(open_):
                break
            shapely.prepare(part)
            inside = shapely.intersects_xy(part, points[open_, 0], points[open_, 1])
            found[open_[inside]] = number
        return found

    def nearest_part(self, point: tuple[float, float], reach: float) -> int:
        """Return the index of the part nearest to a point; -1 if none is within a reach, m."""
        at = shapely.Point(point)
        far = [part.distance(at) for part in self.parts]
        nearest = min(range(len(far)), key=far.__getitem__, default=-1)
        return nearest if nearest >= 0 and far[nearest] <= reach else -1

    def holding(self, points: Array) -> FreeSpace:
        """Return only the parts that contain some of (M, 2) points."""
        numbers = sorted(set(self.part_of(points).tolist()) - {-1})
        return FreeSpace(self.taken, tuple(self.parts[n] for n in numbers))

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Return (M,) True for each of (M, 2) points in one of the parts or on its border."""
        whole = shapely.union_all([shapely.buffer(part, _BESIDE) for part in self.parts])
        shapely.prepare(whole)
        inside: NDArray[np.bool_] = shapely.intersects_xy(whole, points[:, 0], points[:, 1])
        return inside

    def borders(self) -> list[Array]:
        """Return outlines (K, 2) of obstacles as seen from the parts, not closed."""
        found, outermost = [], shapely.bounds(self.taken)
        for part in self.parts:
            low, high = np.split(np.asarray(part.bounds) - outermost, 2)
            ends_nowhere = np.all(low < 0.0) and np.all(high > 0.0)  # where the floor was cut off
            rings = part.interiors if ends_nowhere else (part.exterior, *part.interiors)
            found += [np.asarray(ring.coords)[:-1] for ring in rings]
        return found

    def rings(self) -> list[Array]:
        """Return outlines (K, 2) of obstacles, not closed, with the obstacle on their left."""
        found = []
        for polygon in shapely.get_parts(self.taken):
            whole = shapely.geometry.polygon.orient(polygon)
            found += [np.asarray(r.coords)[:-1] for r in (whole.exterior, *whole.interiors)]
        return sorted(found, key=lambda ring: (len(ring), *ring[0]))


def taken_by(walls: Array, pillars: Array, margin: float) -> Any:
    """Return the space within a margin of walls and pillars, as a (multi)polygon.

    Its corners exceed the margin by at most a tenth: round ones would have more corners.
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
