"""Draws the start of each person in each kind of stream: place, time and route.

A route is drawn with the random streams of `StreamDraw`; a kind is registered by its spec.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import singledispatch

import numpy as np

from crowdbot.core.population.draws import draw_one, heading_to
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import ATTEMPTS
from crowdbot.core.population.stream_draw import StreamDraw
from crowdbot.core.population.stream_routes import (
    Route,
    border_to_border,
    lane_of,
    route_through,
    straight_on,
    stroll,
)
from crowdbot.core.types.arrays import Point
from crowdbot.dsl.scenario.crowd import AtGoal
from crowdbot.dsl.scenario.streams import (
    DirectionsStream,
    QueueStream,
    StreamChoice,
    TalkingStream,
    ThroughStream,
    WanderingStream,
)
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.outlines import along
from crowdbot.errors import InputError

_AT_GOAL: dict[str, AtGoal] = {
    "return": "return", "leave": "remove", "stop": "stop", "again": "loop",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Start:
    """Place, time and route of a person who starts.

    Attributes:
        time: s.
        heading: rad; None: along the route.
        queues: True of a person who stands in a line behind the one before.
    """

    at: Point
    route: Route
    time: float = 0.0
    heading: float | None = None
    queues: bool = False


@singledispatch
def starts(
    stream: StreamChoice, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    """Draw the starts of a stream's people, by their number in the stream.

    Args:
        occupancy: the discs of those who are there already; people who start at once are added.

    Raises:
        InputError: not all of them fit where they start.
    """
    raise NotImplementedError(type(stream).__name__)


@starts.register
def _through(
    stream: ThroughStream, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    lanes, units = stream.lanes, range(len(draw.groups))
    used = lanes.use if lanes is not None else (0,)
    lane = [used[u % len(used)] for u in units]
    for number in dict.fromkeys(lane):
        route = _route_through(draw, stream, number)
        if route.origin is not None:
            draw.check_entrance(route.origin, occupancy)
        mine = [u for u in units if lane[u] == number]
        if not draw.times:
            start = lane_of(draw.area(stream.starts_in), lanes, number)
            for i, at in draw.placed(start, mine, occupancy):
                yield i, Start(at, route)
            continue
        origin = lane_of(draw.area(stream.origin), lanes, number)
        for unit in mine:
            for i, at in draw.entering(origin, unit, occupancy):
                yield i, Start(at, route, draw.times[unit])


def _route_through(draw: StreamDraw, stream: ThroughStream, lane: int) -> Route:
    ends = [draw.area(place) for place in (stream.origin, stream.destination)]
    origin, last = (lane_of(area, stream.lanes, lane) for area in ends)
    via = [draw.area(place) for place in stream.via]
    choice = origin if stream.end == "return" or stream.arrivals else None
    return route_through([*via, last], _end(stream.end), origin=choice)


@starts.register
def _directions(
    stream: DirectionsStream, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    area, floor = draw.area(stream.area), draw.environment.periodic_floor
    angles = stream.directions
    places = dict(draw.placed(area, range(len(draw.groups)), occupancy))
    for unit, members in enumerate(draw.groups):
        rng = draw.rng("direction", unit)
        common = angles[int(rng.integers(len(angles)))] if angles else rng.uniform(-np.pi, np.pi)
        for i in members:
            if floor is not None:
                sides = floor.x[1] - floor.x[0], floor.y[1] - floor.y[0]
                route = straight_on(places[i], float(common), min(sides))
            else:  # members of a group turn alike, each from where it is
                turns = draw.rng("turns", unit)
                route = border_to_border(area, places[i], draw.radius[i], angles, turns)
            yield i, Start(places[i], route)


@starts.register
def _queue(
    stream: QueueStream, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    spots, last = list(along(stream.line, stream.gap)), draw.area(stream.destination)
    for i in range(draw.people):
        before = spots[i::-1] if not draw.times else spots[::-1]
        service = draw.duration(stream.service, "service", i)
        stops = [(at, service if at == spots[0] else 0.0) for at in before]
        route = route_through([last], _end(stream.at_destination), before=stops)
        time = draw.times[i] if draw.times else 0.0
        ahead = spots[max(spots.index(before[0]) - 1, 0)]
        facing = heading_to(*before[0], ahead) if before[0] != spots[0] else None
        if not time:
            occupancy.add(*before[0], float(draw.radius[i]))
        yield i, Start(before[0], route, time, facing, queues=True)


@starts.register
def _talking(
    stream: TalkingStream, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    area, end = draw.area(stream.area), _end(stream.at_destination)
    onward = [] if stream.destination is None else [draw.area(stream.destination)]
    for unit, members in enumerate(draw.groups):
        pause = draw.duration(stream.duration, "duration", unit) if onward else 0.0
        centre, places = _circle(draw, area, members, unit, stream.gap, occupancy)
        for i, at in zip(members, places, strict=True):
            route = route_through(onward, end if onward else "stop", before=[(at, pause)])
            yield i, Start(at, route, heading=heading_to(*at, centre))


def _circle(
    draw: StreamDraw, area: Area, members: range, unit: int, gap: float, occupancy: Occupancy
) -> tuple[Point, list[Point]]:
    """Return the centre of a circle on free floor, and the places around it."""
    rng, size = draw.rng("place", unit), len(members)
    gap = max(gap, 2.0 * float(draw.radius[members].max()))
    reach = 0.5 * gap / math.sin(math.pi / size) if size > 1 else 0.0
    margin = reach + float(draw.radius[members].max())
    room = [max(0.0, 0.5 * side - margin) for side in area.size]
    for _ in range(ATTEMPTS):
        centre = area.point(*(float(w * (2.0 * rng.random() - 1.0)) for w in room))
        turn = 2.0 * math.pi * rng.random()
        angles = [turn + 2.0 * math.pi * k / size for k in range(size)]
        places = [
            (centre[0] + reach * math.cos(a), centre[1] + reach * math.sin(a)) for a in angles
        ]
        radii = [float(draw.radius[i]) for i in members]
        if all(occupancy.is_free(*p, r) for p, r in zip(places, radii, strict=True)):
            for place, radius in zip(places, radii, strict=True):
                occupancy.add(*place, radius)
            return centre, places
    raise InputError(
        f"only {unit} of {len(draw.groups)} groups of stream '{draw.name}' fit into its area"
    )


@starts.register
def _wandering(
    stream: WanderingStream, draw: StreamDraw, occupancy: Occupancy
) -> Iterator[tuple[int, Start]]:
    area, units = draw.area(stream.area), range(len(draw.groups))
    if draw.times:
        draw.check_entrance(area, occupancy)
        entering = (draw.entering(area, unit, occupancy) for unit in units)
        places = dict(pair for places in entering for pair in places)
    else:
        places = dict(draw.placed(area, units, occupancy))
    for unit, members in enumerate(draw.groups):
        rng = draw.rng("visits", unit)
        names = stroll(draw.crowd.goal_areas, stream.areas, stream.visits, rng)
        goals = [draw.area(draw.crowd.goal_areas[name].area) for name in names]
        route = route_through(goals, _end(stream.at_end), origin=area if draw.times else None)
        route = replace(route, pauses=tuple(draw_one(rng, stream.pause) for _ in goals))
        for i in members:
            yield i, Start(places[i], route, draw.times[unit] if draw.times else 0.0)


def _end(word: str) -> AtGoal:
    return _AT_GOAL[word]
