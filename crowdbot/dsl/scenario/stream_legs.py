"""Where people of a stream begin, and from where to where they walk."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise

from crowdbot.dsl.scenario.streams import (
    DirectionsStream,
    QueueStream,
    StreamChoice,
    ThroughStream,
    WanderingStream,
)
from crowdbot.dsl.spec.areas import Area, Place

Path = tuple[str | int, ...]
#: An area by the field that names it.
_Named = tuple[Path, Area | None]
#: Size of the area that stands for a point, m.
_POINT = (0.01, 0.01)


def begins_in(stream: StreamChoice) -> tuple[str, ...]:
    """The fields with the areas in which people of a stream begin or come in."""
    if isinstance(stream, ThroughStream):
        comes_in = stream.start is None or stream.end == "return"
        return ("origin",) * comes_in + ("start",) * (stream.start is not None)
    return () if isinstance(stream, QueueStream) else ("area",)


def legs(
    stream: StreamChoice,
    goal_areas: Mapping[str, Place],
    resolve: Callable[[Place], Area | None],
) -> Iterator[tuple[Area, Area, Path]]:
    """From where to where people walk, and the field that names where to.

    Args:
        stream: theirs.
        goal_areas: all that the crowd has, by name.
        resolve: a place as an area; None for one that does not exist.
    """
    for chain in _chains(stream, goal_areas, resolve):
        known = [(path, area) for path, area in chain if area is not None]
        for (_, start), (path, goal) in pairwise(known):
            yield start, goal, path


def _chains(
    stream: StreamChoice,
    goal_areas: Mapping[str, Place],
    resolve: Callable[[Place], Area | None],
) -> Iterator[list[_Named]]:
    """Areas that are visited one after the other."""
    if isinstance(stream, DirectionsStream):
        return
    if isinstance(stream, WanderingStream):
        for i, name in enumerate(stream.areas):
            goal = resolve(goal_areas[name]) if name in goal_areas else None
            yield [(("area",), resolve(stream.area)), (("areas", i), goal)]
        return
    place = stream.destination
    end: list[_Named] = [] if place is None else [(("destination",), resolve(place))]
    if isinstance(stream, QueueStream):
        line = [Area(centre=at, size=_POINT) for at in stream.line]
        yield [*((("line", i), area) for i, area in reversed(list(enumerate(line)))), *end]
        return
    via = stream.via if isinstance(stream, ThroughStream) else ()
    between: list[_Named] = [(("via", i), resolve(place)) for i, place in enumerate(via)]
    for field in begins_in(stream):
        yield [((field,), resolve(getattr(stream, field))), *between, *end]
