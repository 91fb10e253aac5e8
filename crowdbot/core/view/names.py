"""Names of areas on a map, placed without overlap where possible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from crowdbot.core.types.arrays import Point
from crowdbot.core.view.shapes import Text
from crowdbot.core.view.world import Map

_TALL = 1.6  # names of areas this much taller than wide are turned
#: px: width of a letter, height of a line, and gap between an area's border and its name.
_LETTER, _LINE, _INSET = 7.0, 14.0, 6.0
#: Number of lines below the first position at which a name is tried.
_MOST_LINES = 12

#: left, top, right, bottom, px.
Box = tuple[float, float, float, float]


class MapNames:
    """The names placed on a map so far."""

    def __init__(self, world: Map) -> None:
        self._world = world
        self._taken: list[Box] = []

    def put(self, name: str, corners: Iterable[Point], role: str) -> Text:
        """Place a name in the area's first free corner, starting at the upper left.

        In a narrow area it goes along the left side; if no corner is free, below.

        Args:
            corners: corners of the area, world frame, m.
        """
        paper = [self._world.at(x, y) for x, y in corners]
        xs, ys = [p[0] for p in paper], [p[1] for p in paper]
        area = (min(xs), min(ys), max(xs), max(ys))
        width = _LETTER * len(name)
        if area[2] - area[0] < width + 10.0 and area[3] - area[1] > _TALL * (area[2] - area[0]):
            y = 0.5 * (area[1] + area[3])
            for x in (0.5 * (area[0] + area[2]) + 4.0, area[0] + _LINE, area[2] - 4.0):
                box = (x - _LINE, y - 0.5 * width, x, y + 0.5 * width)
                if self._is_free(box):
                    self._taken.append(box)
                    return Text(at=(x, y), text=name, role=role, anchor="middle", turned=90.0)
        places = list(_places(area, width))
        x, y = next((at for at in places if self._is_free(_box(at, width))), places[0])
        self._taken.append(_box((x, y), width))
        return Text(at=(x, y), text=name, role=role)

    def _is_free(self, box: Box) -> bool:
        return not any(
            box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
            for other in self._taken
        )


def _box(at: Point, width: float) -> Box:
    """Return the box covered by a name that starts at a position."""
    return (at[0], at[1] - 0.75 * _LINE, at[0] + width, at[1] + 0.25 * _LINE)


def _places(area: Box, width: float) -> Iterator[Point]:
    """Yield start positions of a name: the area's corners, then line by line from the top left."""
    left, right = area[0] + _INSET, area[2] - _INSET - width
    top, bottom = area[1] + _INSET + 10.0, area[3] - _INSET
    yield left, top
    if bottom - top >= _LINE:
        yield left, bottom
    if right - left >= width:
        yield right, top
        yield right, bottom
    for line in range(1, _MOST_LINES + 1):
        yield left, top + _LINE * line
