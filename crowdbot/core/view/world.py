"""Map from metres to pixels: the visible part of the world, its grid and its scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from crowdbot.core.types.arrays import Point
from crowdbot.core.view.shapes import Path, Shape, Text

#: px: largest map, largest metre, and margin around the map for the numbers.
_WIDTH, _HEIGHT, _METRE = 1500.0, 860.0, 110.0
LEFT, TOP = 46.0, 22.0
_MARGIN = 0.6  # m, margin around everything


@dataclass(frozen=True, slots=True)
class Map:
    """World x0, y0, x1, y1 (m) at ``scale`` px per metre; its upper left corner is at left, top."""

    x0: float
    y0: float
    x1: float
    y1: float
    scale: float
    top: float
    left: float = LEFT

    @classmethod
    def around(cls, points: Iterable[tuple[float, float]], top: float) -> Map:
        """Return the map of everything that is drawn."""
        listed = list(points) or [(0.0, 0.0)]
        xs, ys = [p[0] for p in listed], [p[1] for p in listed]
        x0, x1 = min(xs) - _MARGIN, max(xs) + _MARGIN
        y0, y1 = min(ys) - _MARGIN, max(ys) + _MARGIN
        scale = min(_WIDTH / (x1 - x0), _HEIGHT / (y1 - y0), _METRE)
        return cls(x0, y0, x1, y1, scale, top)

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Return x, y, width and height in the drawing, px."""
        width, height = (self.x1 - self.x0) * self.scale, (self.y1 - self.y0) * self.scale
        return (self.left, self.top, width, height)

    def at(self, x: float, y: float) -> Point:
        """Return the position of a world point in the drawing."""
        return (self.left + (x - self.x0) * self.scale, self.top + (self.y1 - y) * self.scale)

    def path(
        self, points: Iterable[tuple[float, float]], role: str, *, closed: bool = False
    ) -> Path:
        """Return a line or an area of the world."""
        return Path(points=tuple(self.at(x, y) for x, y in points), role=role, closed=closed)

    def grid(self) -> Iterator[Shape]:
        """Yield grid lines every metre, or at a wider spacing if needed."""
        step = max(1.0, nice(9.0 / self.scale))
        strong = max(step, nice(60.0 / self.scale))
        for role, every in (("grid", step), ("grid-strong", strong)):
            for x in _steps(self.x0, self.x1, every):
                yield self.path([(x, self.y0), (x, self.y1)], role)
            for y in _steps(self.y0, self.y1, every):
                yield self.path([(self.x0, y), (self.x1, y)], role)

    def numbers(self) -> Iterator[Shape]:
        """Yield metre labels below and to the left of the map."""
        every = max(1.0, nice(60.0 / self.scale))
        left, top, width, height = self.box
        for x in _steps(self.x0, self.x1, every):
            at = (self.at(x, 0.0)[0], top + height + 15.0)
            yield Text(at=at, text=f"{x:g}", role="text-muted", size=11, anchor="middle")
        for y in _steps(self.y0, self.y1, every):
            at = (left - 7.0, self.at(0.0, y)[1] + 4.0)
            yield Text(at=at, text=f"{y:g}", role="text-muted", size=11, anchor="end")
        corner = (left + width + 6.0, top + height + 15.0)
        yield Text(at=corner, text="m", role="text-muted", size=11)

    def ruler(self, x: float, y: float) -> Iterator[Shape]:
        """Yield a scale bar that ends at a position in the drawing, px."""
        metres = nice(90.0 / self.scale)
        start = x - metres * self.scale
        ends = [(start, y - 5.0), (start, y), (x, y), (x, y - 5.0)]
        yield Path(points=tuple(ends), role="scale", inside=False)
        at = (0.5 * (start + x), y - 6.0)
        yield Text(at=at, text=f"{metres:g} m", role="text", size=11, anchor="middle")


def nice(least: float) -> float:
    """Return the smallest of …, 0.5, 1, 2, 5, 10, … that is at least ``least``."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(p for k in (1, 2, 5, 10) if (p := k * power) >= least * (1 - 1e-9))


def _steps(low: float, high: float, every: float) -> Iterator[float]:
    for k in range(math.ceil(low / every), math.floor(high / every) + 1):
        yield k * every + 0.0
