"""Outlines of walkways with ends that people can pass and robots cannot."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Literal

from pydantic import Field, PrivateAttr, model_validator

from crowdbot.plugin import (
    EnvironmentSpec,
    Face,
    Length,
    PositiveLength,
    Rectangle,
    Spec,
    default,
    outlines,
)

#: Distance by which portals and the walls beside them extend beyond an end, m.
PORTAL_DEPTH = 1.0
#: Segments of a rounded corner.
_ARC = 8
Side = Literal["south", "east", "north", "west"]


class WalkwaySpec(EnvironmentSpec):
    """A place with its own zones and portals; those of the document are added."""

    wall_height: PositiveLength = default(2.5, "Height of the walls, m.")

    _checked: bool = PrivateAttr(default=False)

    @model_validator(mode="after")
    def _with_usual_places(self) -> WalkwaySpec:
        if self._checked:  # suites validate a place once per scenario
            return self
        self.check_shape()
        object.__setattr__(self, "zones", {**self.usual_zones(), **self.zones})
        object.__setattr__(self, "portals", {**self.usual_portals(), **self.portals})
        self._checked = True
        return self

    def check_shape(self) -> None:
        """Refuse inconsistent parameters.

        Raises:
            ValueError: they are inconsistent.
        """

    def usual_zones(self) -> Mapping[str, Rectangle]:
        """Return zones that every such place has."""
        return {}

    def usual_portals(self) -> Mapping[str, Rectangle]:
        """Return portals that every such place has."""
        return {}


class OpeningSpec(Spec):
    """An opening in an outer wall, and a portal: people can leave through it, robots cannot."""

    side: Side = Field(description="The wall it is in: `south` is the one at the least y.")
    at: Length = Field(description="Its middle along the wall: x, or y in `west` and `east`, m.")
    width: PositiveLength = default(2.0, "Width, m.")


def box(x0: float, x1: float, y0: float, y1: float) -> Rectangle:
    """Return a rectangle from its limits, in either order."""
    return Rectangle(x=(min(x0, x1), max(x0, x1)), y=(min(y0, y1), max(y0, y1)))


def walkway(outline: outlines.Outline, ends: Collection[int], top: float) -> tuple[Face, ...]:
    """Return the walls around a walkway.

    Args:
        outline: counter-clockwise.
        ends: indices of the sides through which people leave. These get walls for the robot only,
            and a niche for a portal behind, closed so that no path leads around outside.
        top: of the walls, m.
    """
    heights = (0.0, top)
    count = len(outline)
    first = (min(ends) + 1) % count if ends else 0
    faces, line = [], [_beyond(outline, first - 1, first) if ends else outline[0]]
    for step in range(count):
        k = (first + step) % count
        if k in ends:
            a, b = outline[k], outline[(k + 1) % count]
            faces.append(Face(points=(*line, a, _beyond(outline, k, k)), heights=heights))
            faces.append(Face(points=(a, b), heights=heights, stops_crowd=False))
            far = (_beyond(outline, k, k), _beyond(outline, k, k + 1))
            faces.append(Face(points=far, heights=heights, stops_robot=False))
            line = [far[1]]
        else:
            line.append(outline[k])
    if not ends:
        faces.append(Face(points=(*outline, outline[0]), heights=heights))
    return tuple(replace(face, points=_without_repeats(face.points)) for face in faces)


def _beyond(outline: outlines.Outline, side: int, corner: int) -> outlines.Point:
    """Return a corner of a side, moved out of the walkway by the depth of a portal."""
    count = len(outline)
    (ax, ay), (bx, by) = outline[side % count], outline[(side + 1) % count]
    scale = PORTAL_DEPTH / math.hypot(bx - ax, by - ay)
    x, y = outline[corner % count]
    return x + (by - ay) * scale, y - (bx - ax) * scale


def _without_repeats(points: tuple[outlines.Point, ...]) -> tuple[outlines.Point, ...]:
    return tuple(p for k, p in enumerate(points) if k == 0 or p != points[k - 1])


def rounded(
    before: outlines.Point, corner: outlines.Point, after: outlines.Point, radius: float
) -> tuple[outlines.Point, ...]:
    """Return a corner as an arc that touches both sides, or the corner itself if radius is 0."""
    if radius == 0.0:
        return (corner,)
    ux, uy = _unit(corner, before)
    vx, vy = _unit(corner, after)
    half = 0.5 * math.acos(max(-1.0, min(1.0, ux * vx + uy * vy)))
    reach = radius / math.tan(half)
    mx, my = ux + vx, uy + vy
    away = radius / math.sin(half) / math.hypot(mx, my)
    cx, cy = corner[0] + mx * away, corner[1] + my * away
    start = math.atan2(corner[1] + reach * uy - cy, corner[0] + reach * ux - cx)
    end = math.atan2(corner[1] + reach * vy - cy, corner[0] + reach * vx - cx)
    sweep = math.remainder(end - start, 2.0 * math.pi)
    return tuple(
        (
            cx + radius * math.cos(start + sweep * k / _ARC),
            cy + radius * math.sin(start + sweep * k / _ARC),
        )
        for k in range(_ARC + 1)
    )


def _unit(start: outlines.Point, end: outlines.Point) -> outlines.Point:
    length = math.dist(start, end)
    return (end[0] - start[0]) / length, (end[1] - start[1]) / length


def hall(
    area: Rectangle, openings: Mapping[str, OpeningSpec], top: float
) -> tuple[tuple[Face, ...], dict[str, Rectangle]]:
    """Return walls around a rectangle with openings, and a portal behind each opening.

    Raises:
        ValueError: an opening does not fit into its wall, or overlaps another one.
    """
    points: list[outlines.Point] = []
    ends: list[int] = []
    (x0, x1), (y0, y1) = area.x, area.y
    runs: dict[Side, tuple[float, float]] = {
        "south": (x0, x1), "east": (y0, y1), "north": (x1, x0), "west": (y1, y0)
    }  # fmt: skip
    across = {"south": y0, "east": x1, "north": y1, "west": x0}
    for side, (start, end) in runs.items():
        way = 1.0 if end > start else -1.0
        points.append(_on(side, start, across[side]))
        last = start
        mine = [(name, o) for name, o in openings.items() if o.side == side]
        for name, opening in sorted(mine, key=lambda item: way * item[1].at):
            low, high = (
                opening.at - 0.5 * way * opening.width,
                opening.at + 0.5 * way * opening.width,
            )
            if way * (low - last) < -1e-9 or way * (end - high) < -1e-9:
                raise ValueError(f"opening '{name}' does not fit into the {side} wall")
            if way * (low - last) > 1e-9:
                points.append(_on(side, low, across[side]))
            ends.append(len(points) - 1)
            if way * (end - high) > 1e-9:
                points.append(_on(side, high, across[side]))
            last = high
    portals = {name: _portal(area, opening) for name, opening in openings.items()}
    return walkway(tuple(points), ends, top), portals


def _on(side: Side, along: float, across: float) -> outlines.Point:
    return (along, across) if side in ("south", "north") else (across, along)


def _portal(area: Rectangle, opening: OpeningSpec) -> Rectangle:
    low, high = opening.at - 0.5 * opening.width, opening.at + 0.5 * opening.width
    (x0, x1), (y0, y1) = area.x, area.y
    return {
        "south": lambda: box(low, high, y0 - PORTAL_DEPTH, y0),
        "north": lambda: box(low, high, y1, y1 + PORTAL_DEPTH),
        "west": lambda: box(x0 - PORTAL_DEPTH, x0, low, high),
        "east": lambda: box(x1, x1 + PORTAL_DEPTH, low, high),
    }[opening.side]()
