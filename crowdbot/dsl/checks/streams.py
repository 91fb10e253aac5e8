"""Checks of streams: names, whole numbers of people, and room for all where they start."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.dsl.checks.crowd import missing_speed
from crowdbot.dsl.checks.facts import Facts, Path, people
from crowdbot.dsl.checks.spawns import most_points
from crowdbot.dsl.scenario.spawning import MAX_PEOPLE
from crowdbot.dsl.scenario.stream import Arrivals, Stream
from crowdbot.dsl.spec.areas import Area, Place
from crowdbot.dsl.text.diagnostics import Diagnostic


def check_streams(facts: Facts) -> Iterator[Diagnostic]:
    """Check the fields of every stream, its names, its places, and that its people fit."""
    for name, stream in facts.crowd.streams.items():
        path: Path = ("crowd", "streams", name)
        subject = f"stream '{name}'"
        yield from _check_names(facts, stream, subject, path)
        for field, place in stream.places():
            yield from _check_place(facts, place, subject, (*path, *field))
        yield from _check_number(facts, stream, name, path)
        for field, points in stream.points():
            yield from facts.outside(f"the point {{at}} of {subject}", points, *path, *field)
        radius = stream.body.radius or facts.crowd.body.radius
        for misfit in stream.misfits(subject, radius, lambda place: area_of(facts, place)):
            mark = facts.mark(*path, *misfit.field)
            yield Diagnostic("E136", misfit.text, mark, misfit.hint)


def _check_names(facts: Facts, stream: Stream, subject: str, path: Path) -> Iterator[Diagnostic]:
    crowd = facts.crowd
    for policy in stream.policy:
        if policy not in crowd.policies:
            yield facts.unknown("policy", policy, crowd.policies, *path, "policy")
    for kind in stream.people:
        if kind not in crowd.people:
            yield facts.unknown("kind", kind, crowd.people, *path, "people")
    for field, area in stream.goal_area_names():
        if area not in crowd.goal_areas:
            yield facts.unknown("goal area", area, crowd.goal_areas, *path, *field)
    if stream.groups and sum(g.frequency for g in stream.groups) == 0:
        text = f"the frequencies of the groups of {subject} sum to 0"
        yield Diagnostic("E137", text, facts.mark(*path, "groups"))
    if stream.speed is None and crowd.speed is None:
        yield missing_speed(facts, subject, *path)


def _check_place(facts: Facts, place: Place, subject: str, path: Path) -> Iterator[Diagnostic]:
    environment = facts.scenario.environment
    if isinstance(place, str) and place in environment.portals:
        return
    if isinstance(place, str) and place not in environment.zones:
        known = [*environment.zones, *environment.portals]
        yield facts.unknown("zone", place, known, *path)
    elif isinstance(place, Area):
        yield from facts.area(place, subject, *path)


def area_of(facts: Facts, place: Place) -> Area | None:
    """Return the area of a place; None for the name of a zone that does not exist."""
    if isinstance(place, Area):
        return place
    environment = facts.scenario.environment
    box = environment.zones.get(place) or environment.portals.get(place)
    return Area.of(box) if box else None


def _check_number(facts: Facts, stream: Stream, name: str, path: Path) -> Iterator[Diagnostic]:
    """Check that a stream's people fit into the area where they start."""
    place, density, count = stream.starts_in, stream.people_per_area, stream.count
    if stream.entering is not None:
        yield from _check_arrivals(facts, stream.entering, name, (*path, "arrivals"))
    area = None if place is None else area_of(facts, place)
    if area is None:
        return
    floor = area.size[0] * area.size[1]
    if density is not None:
        yield from facts.whole(
            density, floor, f"stream '{name}'", "crowd", "streams", name, "density"
        )
        count = round(density * floor)
    radius = stream.body.radius or facts.crowd.body.radius
    radius = min(radius, 0.1) if facts.crowd.people else radius
    most = min(most_points(area.size, radius, 2.0 * radius), MAX_PEOPLE)
    if (count or 1) > most:
        size = f"{area.size[0]:g} m × {area.size[1]:g} m"
        text = f"{people(count or 1)} of stream '{name}' cannot fit into its {size}"
        hint = f"there is room for at most {most}" if most else "there is no room for a person"
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
