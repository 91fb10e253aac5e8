"""Checks of streams: names, whole numbers of people, and whether all fit where they start."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from crowdbot.dsl.checks.crowd import missing_speed
from crowdbot.dsl.checks.facts import Facts, Path, people
from crowdbot.dsl.checks.spawns import most_points
from crowdbot.dsl.scenario.spawning import MAX_PEOPLE
from crowdbot.dsl.scenario.streams import (
    Arrivals,
    DirectionsStream,
    QueueStream,
    Stream,
    TalkingStream,
    ThroughStream,
    WanderingStream,
    places_of,
)
from crowdbot.dsl.spec.areas import Area, Place
from crowdbot.dsl.text.diagnostics import Diagnostic


def check_streams(facts: Facts) -> Iterator[Diagnostic]:
    """Every stream by itself, and the names between it and the rest of the crowd."""
    for name, stream in facts.crowd.streams.items():
        path: Path = ("crowd", "streams", name)
        yield from _check_names(facts, stream, f"stream '{name}'", path)
        for field, place in places_of(stream):
            yield from _check_place(facts, place, f"stream '{name}'", (*path, *field))
        yield from _check_number(facts, stream, name, path)
        if isinstance(stream, QueueStream):
            yield from _check_line(facts, stream, name, path)
        if isinstance(stream, ThroughStream):
            yield from _check_lanes(facts, stream, name, path)


def _check_names(facts: Facts, stream: Stream, who: str, path: Path) -> Iterator[Diagnostic]:
    crowd = facts.crowd
    for policy in stream.policy:
        if policy not in crowd.policies:
            yield facts.unknown("policy", policy, crowd.policies, *path, "policy")
    for kind in stream.people:
        if kind not in crowd.people:
            yield facts.unknown("kind", kind, crowd.people, *path, "people")
    if isinstance(stream, WanderingStream):
        for i, area in enumerate(stream.areas):
            if area not in crowd.goal_areas:
                yield facts.unknown("goal area", area, crowd.goal_areas, *path, "areas", i)
    if stream.groups and sum(g.frequency for g in stream.groups) == 0:
        text = f"the frequencies of the groups of {who} sum to 0"
        yield Diagnostic("E137", text, facts.mark(*path, "groups"))
    if stream.speed is None and crowd.speed is None:
        yield missing_speed(facts, who, *path)


def _check_place(facts: Facts, place: Place, who: str, path: Path) -> Iterator[Diagnostic]:
    environment = facts.scenario.environment
    if isinstance(place, str) and place in environment.portals:
        return
    if isinstance(place, str) and place not in environment.zones:
        known = [*environment.zones, *environment.portals]
        yield facts.unknown("zone", place, known, *path)
    elif isinstance(place, Area):
        yield from facts.area(place, who, *path)


def area_of(facts: Facts, place: Place | None) -> Area | None:
    """A place as an area; None for a name that is not there."""
    if isinstance(place, Area) or place is None:
        return place
    environment = facts.scenario.environment
    box = environment.zones.get(place) or environment.portals.get(place)
    return Area.of(box) if box else None


def _check_number(facts: Facts, stream: Stream, name: str, path: Path) -> Iterator[Diagnostic]:
    """Whether so many people can be where they start."""
    if isinstance(stream, ThroughStream):
        place: Place | None = stream.starts_in
    else:
        place = getattr(stream, "area", None)
    area = area_of(facts, place)
    density, wanted = getattr(stream, "density", None), stream.count
    arrivals = getattr(stream, "arrivals", None)
    if arrivals is not None:
        yield from _check_arrivals(facts, arrivals, name, (*path, "arrivals"))
    if area is None:
        return
    floor = area.size[0] * area.size[1]
    if density is not None:
        yield from facts.whole(
            density, floor, f"stream '{name}'", "crowd", "streams", name, "density"
        )
        wanted = round(density * floor)
    radius = stream.body.radius or facts.crowd.body.radius
    if facts.crowd.people or isinstance(stream, DirectionsStream | TalkingStream):
        radius = min(radius, 0.1) if facts.crowd.people else radius
    most = min(most_points(area.size, radius, 2.0 * radius), MAX_PEOPLE)
    if (wanted or 1) > most:
        size = f"{area.size[0]:g} m × {area.size[1]:g} m"
        text = f"{people(wanted or 1)} of stream '{name}' cannot fit into its {size}"
        hint = f"there is room for at most {most}" if most else "nobody is so thin"
        field = "density" if density is not None else "count" if stream.count else "arrivals"
        yield Diagnostic("E136", text, facts.mark(*path, field), hint)


def _check_arrivals(
    facts: Facts, arrivals: Arrivals, name: str, path: Path
) -> Iterator[Diagnostic]:
    rate = arrivals.rate or (1.0 / arrivals.every if arrivals.every else 0.0)
    expected = rate * ((arrivals.until or 0.0) - arrivals.begin) + len(arrivals.times)
    if expected > MAX_PEOPLE:
        text = f"some {expected:.0f} people of stream '{name}' are more than {MAX_PEOPLE}"
        yield Diagnostic("E136", text, facts.mark(*path))


def _check_line(facts: Facts, queue: QueueStream, name: str, path: Path) -> Iterator[Diagnostic]:
    yield from facts.outside(f"the point {{at}} of stream '{name}'", queue.line, *path, "line")
    length = sum(math.dist(a, b) for a, b in pairwise(queue.line))
    room = math.floor(length / queue.gap + 1e-9) + 1
    if queue.count is not None and queue.count > room:
        text = f"{people(queue.count)} of stream '{name}' cannot stand on its {length:g} m"
        hint = f"with a gap of {queue.gap:g} m there is room for {room}"
        yield Diagnostic("E136", text, facts.mark(*path, "count"), hint)
    radius = queue.body.radius or facts.crowd.body.radius
    if queue.gap < 2.0 * radius:
        text = f"{queue.gap:g} m between people of stream '{name}' who are {2 * radius:g} m wide"
        yield Diagnostic("E136", text, facts.mark(*path, "gap"))


def _check_lanes(
    facts: Facts, stream: ThroughStream, name: str, path: Path
) -> Iterator[Diagnostic]:
    if stream.lanes is None:
        return
    radius = stream.body.radius or facts.crowd.body.radius
    for place in {stream.origin, stream.starts_in, stream.destination}:
        area = area_of(facts, place)
        width = area.size[1] / stream.lanes.of if area else math.inf
        if width < 2.0 * radius:
            text = f"lanes of {width:.3g} m in stream '{name}' for people {2 * radius:g} m wide"
            yield Diagnostic("E136", text, facts.mark(*path, "lanes"))
            return
