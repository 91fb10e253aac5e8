"""Reachability: which places of the floor a body can reach, without a numerical library.

The floor is a grid whose rows are whole numbers, one bit for each cell. Cells are blocked only if
they certainly are: a reachable place is never reported as unreachable, but a gap that is too narrow
by less than a cell may count as passable. Later placing and planning is exact.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache

from crowdbot.dsl.spec.areas import Area, places_in
from crowdbot.dsl.spec.outlines import Outline, Point, sides
from crowdbot.dsl.spec.place import Place
from crowdbot.dsl.spec.spec import Rectangle

#: Side of a cell, m; larger on floors with more than `_MOST` cells along a side.
_CELL = 0.1
_MOST = 2000
#: Side of a cell in the quick check, m.
_WIDE_CELL = 0.2
_AROUND = 1.0  # m
#: Distance from a cell's centre to its corner, relative to its side.
_HALF_DIAGONAL = 0.7072


#: x0, x1, y0, y1, m.
Box = tuple[float, float, float, float]
#: Tolerance for a body that touches a wall, m.
_SLACK = 1e-6


@lru_cache(maxsize=1024)  # suites request the same places repeatedly
def has_room(place: Place, area: Area, radius: float) -> bool:
    """Return True if a body of a radius (m) fits somewhere in an area."""
    return any(place.clearance(*at) >= radius - _SLACK for at in places_in(area, radius))


@lru_cache(maxsize=1024)
def areas_connected(place: Place, radius: float, box: Box, start: Outline, goal: Outline) -> bool:
    """Return True if a path may lead a body of a radius (m) from one convex outline to another."""
    if place.is_clear(_middle(start), _middle(goal), radius):
        return True
    if wide_reach_of(place, radius, box).connects_areas(start, goal):
        return True
    return reach_of(place, radius, box).connects_areas(start, goal)


def first_is_outside(
    place: Place, radius: float, bounds: Rectangle, first: Outline, other: Outline
) -> bool:
    """Return True if a body (radius in m) can leave ``bounds`` from ``first`` but not ``other``."""
    (x0, x1), (y0, y1), beside = bounds.x, bounds.y, 1.0 + 2.0 * radius
    box = x0 - beside, x1 + beside, y0 - beside, y1 + beside
    out = spot((x1 + 0.5 * beside, y1 + 0.5 * beside))
    leaves = [areas_connected(place, radius, box, start, out) for start in (first, other)]
    return leaves == [True, False]


def spot(at: Point) -> Outline:
    """Return a small outline around a point."""
    return Area(centre=at, size=(0.01, 0.01)).corners


def _middle(outline: Outline) -> Point:
    xs, ys = zip(*outline, strict=True)
    return sum(xs) / len(xs), sum(ys) / len(ys)


@lru_cache(maxsize=64)
def reach_of(place: Place, radius: float, box: Box) -> Reach:
    """Return the reach of bodies of a radius (m) on a place and a box x0, x1, y0, y1."""
    return Reach(place, radius, box)


@lru_cache(maxsize=64)
def wide_reach_of(place: Place, radius: float, box: Box) -> Reach:
    """Return a quick, conservative check: it never finds paths that do not exist.

    Its cells are large, and partly blocked cells count as blocked.
    """
    return Reach(place, radius, box, cell=_WIDE_CELL, surely=True)


class Reach:
    """Cells where a body's centre can be, and their connected components.

    Args:
        place: the obstacles.
        radius: radius of the body, m.
        box: additional floor x0, x1, y0, y1, m.
        cell: largest side of a cell, m; default: a quarter of the radius, at most 0.1 m.
        surely: keep only cells that are completely free, instead of partly free ones.
    """

    def __init__(
        self, place: Place, radius: float, box: Box, *, cell: float = 0.0, surely: bool = False
    ) -> None:
        points = [(box[0], box[2]), (box[1], box[3])]
        points += [p for side in place.segments() for p in side]
        points += [(p.x + k * p.radius, p.y + k * p.radius) for p in place.pillars for k in (-1, 1)]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        size = max(max(xs) - min(xs), max(ys) - min(ys)) + 2.0 * _AROUND
        self._cell = max(cell or min(_CELL, 0.25 * radius), size / _MOST)
        self._x0, self._y0 = min(xs) - _AROUND, min(ys) - _AROUND
        self._columns = math.ceil((max(xs) + _AROUND - self._x0) / self._cell)
        count = math.ceil((max(ys) + _AROUND - self._y0) / self._cell)
        self._free = [(1 << self._columns) - 1] * count
        margin = _HALF_DIAGONAL * self._cell
        self._take(place, radius + margin if surely else radius - margin)
        self._floods: dict[tuple[int, int], list[int]] = {}

    def is_free(self, x: float, y: float) -> bool:
        """Return True if a body may stand at a point."""
        row, column = self._at(x, y)
        return 0 <= row < len(self._free) and bool(self._free[row] >> column & 1)

    def connects(self, start: Point, goal: Point) -> bool:
        """Return True if a path may lead from one point to another."""
        return self.is_free(*start) and self.is_free(*goal) and self._joins(start, goal)

    def connects_areas(self, start: Sequence[Point], goal: Sequence[Point]) -> bool:
        """Return True if a path may lead from one convex outline to another."""
        goals = self._cells(goal)
        seen = [0] * len(self._free)
        for row, bits in self._cells(start):
            open_ = bits & self._free[row] & ~seen[row]
            while open_:
                flood = self._flood(row, (open_ & -open_).bit_length() - 1)
                if any(flood[r] & b for r, b in goals):
                    return True
                seen = [a | b for a, b in zip(seen, flood, strict=True)]
                open_ &= ~flood[row]
        return False

    def _at(self, x: float, y: float) -> tuple[int, int]:
        column = math.floor((x - self._x0) / self._cell)
        return math.floor((y - self._y0) / self._cell), min(max(column, 0), self._columns - 1)

    def _joins(self, start: Point, goal: Point) -> bool:
        row, column = self._at(*goal)
        return bool(self._flood(*self._at(*start))[row] >> column & 1)

    def _flood(self, row: int, column: int) -> list[int]:
        """Return the connected component of a free cell, as one bit mask per row."""
        for flood in self._floods.values():
            if flood[row] >> column & 1:
                return flood
        found = [0] * len(self._free)
        found[row] = self._spread(1 << column, self._free[row])
        open_ = [row]
        while open_:
            row = open_.pop()
            for other in (row - 1, row + 1):
                if not 0 <= other < len(found):
                    continue
                fresh = found[row] & self._free[other] & ~found[other]
                if fresh:
                    found[other] |= self._spread(fresh, self._free[other])
                    open_.append(other)
        return self._floods.setdefault((row, column), found)

    def _spread(self, seeds: int, free: int) -> int:
        """Return the bits of a row's runs of free cells that contain a seed bit."""
        upwards = (free & ~(free + seeds)) | seeds
        runs, step = free, 1
        while step < self._columns:
            upwards |= runs & (upwards >> step)
            runs &= runs >> step
            step <<= 1
        return upwards

    # ------------------------------------------------------------------ what is taken
    def _take(self, place: Place, margin: float) -> None:
        for (ax, ay), (bx, by) in place.segments():
            if margin > 0.0:
                self._take_around(ax, ay, bx, by, margin)
        for pillar in place.pillars:
            reach = pillar.radius + margin
            if reach > 0.0:
                self._take_around(pillar.x, pillar.y, pillar.x, pillar.y, reach)
        for solid in place.solids:
            rings = (solid.outline, *solid.holes)
            for row, bits in self._rows_of([s for ring in rings for s in sides(ring)]):
                self._free[row] &= ~bits

    def _take_around(self, ax: float, ay: float, bx: float, by: float, margin: float) -> None:
        """Block cells whose centre is closer to a segment than a margin, m: one run per row."""
        length = math.hypot(bx - ax, by - ay)
        nx, ny = (0.0, 0.0) if length == 0.0 else (-(by - ay) / length, (bx - ax) / length)
        nx, ny = nx * margin, ny * margin
        corners = ((ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny))
        # No row crosses a side along x; of a wall along an axis two or no sides remain.
        upright = [side for side in sides(corners) if side[0][1] != side[1][1]]
        ends = ((ax, ay), (bx, by)) if length else ((ax, ay),)
        for row in self._rows_between(min(ay, by) - margin, max(ay, by) + margin):
            y = self._y0 + (row + 0.5) * self._cell
            xs = [x for side in upright for x in _crossing(side, y)]
            for cx, cy in ends:
                if abs(y - cy) <= margin:
                    half = math.sqrt(margin * margin - (y - cy) ** 2)
                    xs += [cx - half, cx + half]
            if xs:
                self._free[row] &= ~self._bits(min(xs), max(xs))

    def _cells(self, outline: Sequence[Point]) -> list[tuple[int, int]]:
        """Return (row, bits) of the cells in an outline, with the cell of its mean corner."""
        found = list(self._rows_of(list(sides(outline))))
        x, y = (sum(c) / len(outline) for c in zip(*outline, strict=True))
        row, column = self._at(x, y)
        return [*found, (row, 1 << column)] if 0 <= row < len(self._free) else found

    def _rows_of(self, listed: Sequence[tuple[Point, Point]]) -> Iterable[tuple[int, int]]:
        """Yield (row, bits) of the cells with centres within closed sides, by the even-odd rule."""
        ys = [p[1] for side in listed for p in side]
        for row in self._rows_between(min(ys), max(ys)):
            y = self._y0 + (row + 0.5) * self._cell
            xs = sorted(x for side in listed for x in _crossing(side, y))
            for left, right in zip(xs[::2], xs[1::2], strict=False):
                yield row, self._bits(left, right)

    def _rows_between(self, low: float, high: float) -> range:
        first = math.ceil((low - self._y0) / self._cell - 0.5)
        last = math.floor((high - self._y0) / self._cell - 0.5)
        return range(max(0, first), min(len(self._free) - 1, last) + 1)

    def _bits(self, left: float, right: float) -> int:
        """Return the cells of a row whose centre lies between left and right."""
        first = max(0, math.ceil((left - self._x0) / self._cell - 0.5))
        last = min(self._columns - 1, math.floor((right - self._x0) / self._cell - 0.5))
        return ((1 << (last - first + 1)) - 1) << first if last >= first else 0


def _crossing(side: tuple[Point, Point], y: float) -> list[float]:
    """Return x where a side crosses the horizontal line at ``y``, m; empty if it does not."""
    (ax, ay), (bx, by) = side
    if (ay > y) == (by > y):
        return []
    return [ax + (y - ay) * (bx - ax) / (by - ay)]
