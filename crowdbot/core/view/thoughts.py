"""Planners' drawings as shapes on a map, as the replay shows them."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence

from crowdbot.core.recording.drawings import drawn_lines
from crowdbot.core.recording.placed_drawings import PlacedDrawing
from crowdbot.core.types.arrays import Point
from crowdbot.core.view.shapes import Disc, Path, Shape, Text
from crowdbot.core.view.world import Map

#: s: older drawings are not shown.
_AGE = 0.5
_POINT, _END, _BARB, _TEXT, _CROSS = 2.5, 3.0, 7.0, 13.0, 0.1  # px, of a cross m


def thoughts_at(drawings: Sequence[PlacedDrawing], t: float, world: Map) -> Iterator[Shape]:
    """Yield the latest drawing of each name at a time; texts last, above the map.

    Args:
        drawings: in the order of time.
    """
    begin = bisect_left(drawings, t - _AGE, key=lambda one: one.t)
    end = bisect_right(drawings, t + 1e-9, key=lambda one: one.t)
    latest = {one.name: one for one in drawings[begin:end]}
    for one in latest.values():
        if one.texts is None:
            yield from _shapes(one, world)
    for one in latest.values():
        if one.texts is not None:
            yield from _texts(one, world)


def _shapes(one: PlacedDrawing, world: Map) -> Iterator[Shape]:
    places = [world.at(x, y) for x, y in one.columns[:2].T.tolist()]
    if len(one.columns) == 2 and one.name.startswith("points"):
        for place in places:
            yield Disc(centre=place, radius=_POINT, role="thought-dot")
        return
    lines = drawn_lines(one.columns, one.name).transpose(1, 0, 2).tolist()
    for (x0, y0), (x1, y1) in lines:
        yield world.path([(x0, y0), (x1, y1)], "thought")
    if len(one.columns) > 2:
        yield from _crosses(one, world)
    elif one.name.startswith("arrows"):
        for start, tip in lines:
            yield from _barbs(world.at(*start), world.at(*tip))
    elif places:
        yield Disc(centre=places[-1], radius=_END, role="thought-dot")


def _crosses(one: PlacedDrawing, world: Map) -> Iterator[Shape]:
    for x, y in one.columns[:2].T.tolist():
        yield world.path([(x - _CROSS, y), (x + _CROSS, y)], "thought")
        yield world.path([(x, y - _CROSS), (x, y + _CROSS)], "thought")


def _barbs(start: Point, tip: Point) -> Iterator[Shape]:
    angle = math.atan2(tip[1] - start[1], tip[0] - start[0])
    ends = [(tip[0] + _BARB * math.cos(angle + side * 2.6),
             tip[1] + _BARB * math.sin(angle + side * 2.6)) for side in (-1, 1)]  # fmt: skip
    yield Path(points=(ends[0], tip, ends[1]), role="thought")


def _texts(one: PlacedDrawing, world: Map) -> Iterator[Shape]:
    for (x, y), text in zip(one.columns[:2].T.tolist(), one.texts or (), strict=True):
        if text and world.x0 < x < world.x1 and world.y0 < y < world.y1:
            across, down = world.at(x, y)
            yield Text(at=(across, down + _TEXT / 3), text=text, role="text-thought",
                       size=_TEXT, anchor="middle")  # fmt: skip
