"""Checks of spawns and goal areas."""

from __future__ import annotations

import math
from collections.abc import Iterator

from crowdbot.dsl.checks.crowd import missing_speed
from crowdbot.dsl.checks.facts import Facts, people
from crowdbot.dsl.scenario.spawning import MAX_PEOPLE, Goals, Spawn
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.text.diagnostics import Diagnostic


def check_spawns(facts: Facts) -> Iterator[Diagnostic]:
    """Check every spawn and every goal area, and that the names they refer to exist."""
    areas = facts.crowd.goal_areas
    for name, goal in areas.items():
        path = ("crowd", "goal_areas", name)
        yield from facts.area(goal.area, f"goal area '{name}'", *path, "area")
        for i, following in enumerate(goal.next):
            if following not in areas:
                yield facts.unknown("goal area", following, areas, *path, "next", i)
    for name, spawn in facts.crowd.spawns.items():
        yield from _check_spawn(facts, name, spawn)


def _check_spawn(facts: Facts, name: str, spawn: Spawn) -> Iterator[Diagnostic]:
    path, subject = ("crowd", "spawns", name), f"spawn '{name}'"
    yield from facts.area(spawn.area, subject, *path, "area")
    area = facts.resolve(spawn.area)
    if area is not None:
        yield from _check_room(facts, spawn, area, name)
    yield from _check_routes(facts, spawn, subject, *path)
    if spawn.groups and sum(g.frequency for g in spawn.groups) == 0:
        text = f"the frequencies of the groups of {subject} sum to 0"
        yield Diagnostic("E137", text, facts.mark(*path, "groups"))
    for policy in spawn.policy:
        if policy not in facts.crowd.policies:
            yield facts.unknown("policy", policy, facts.crowd.policies, *path, "policy")
    if spawn.speed is None and facts.crowd.speed is None:
        yield missing_speed(facts, subject, *path)


def _check_routes(facts: Facts, spawn: Spawn, subject: str, *path: str) -> Iterator[Diagnostic]:
    """Check that a spawn has exactly one valid route: goals, portals or ``standing``."""
    if spawn.portals is not None:
        yield from facts.portals(spawn.portals, subject, *path, "portals")
    if spawn.goals is not None:
        yield from _check_goals(facts, spawn, spawn.goals, *path)
    given = spawn.routes
    if len(given) != 1:
        text = f"{subject} has {' and '.join(given) or 'no goal'}"
        hint = "write one of goals, portals and 'standing: true'"
        where = (*path, given[1]) if given else path
        yield Diagnostic("E141", text, facts.mark(*where), hint)


def _check_goals(facts: Facts, spawn: Spawn, goals: Goals, *path: str) -> Iterator[Diagnostic]:
    areas = facts.crowd.goal_areas
    for field, name in spawn.goal_area_names():
        if name not in areas:
            yield facts.unknown("goal area", name, areas, *path, *field)
    if goals.order != "linked" or goals.length == 1:
        return
    waiting, seen = list(goals.areas), set(goals.areas)
    while waiting:
        name = waiting.pop(0)
        if name not in areas:
            continue
        if not areas[name].next:
            text = f"goal area '{name}' has no next one, and a linked walk may come to it"
            hint = f"it begins at {facts.mark(*path, 'goals')}"
            yield Diagnostic("E140", text, facts.mark("crowd", "goal_areas", name), hint)
        waiting += [n for n in areas[name].next if n not in seen]
        seen |= set(areas[name].next)


def _check_room(facts: Facts, spawn: Spawn, area: Area, name: str) -> Iterator[Diagnostic]:
    """Check that a spawn's people fit into its area."""
    path, floor = ("crowd", "spawns", name), area.size[0] * area.size[1]
    if spawn.density is not None:
        where = f"spawn '{name}'"
        yield from facts.whole(spawn.density, floor, where, *path, "density")
    count = round(spawn.people(floor))
    least = spawn.least_radius(facts.crowd.body.radius)
    most = min(most_points(area.size, least, max(spawn.spacing or 0.0, 2.0 * least)), MAX_PEOPLE)
    if count > most:
        size = f"{area.size[0]:g} m × {area.size[1]:g} m"
        text = f"{people(count)} of spawn '{name}' cannot fit into its {size}"
        hint = f"there is room for at most {most}" if most else "there is no room for a person"
        mark = facts.mark(*path, "count" if spawn.count else "density")
        yield Diagnostic("E136", text, mark, hint)


def most_points(size: tuple[float, float], margin: float, spacing: float) -> int:
    """Return an upper bound on the number of points in a rectangle with these spacings.

    Oler's inequality for a convex region of area A and perimeter P: at most
    2 A / (√3 d²) + P / (2 d) + 1 points are d apart (Acta Mathematica 105, 1961).

    Args:
        size: sides of the rectangle, m.
        margin: smallest distance from the sides, m.
        spacing: smallest distance between two points, m.
    """
    a, b = size[0] - 2.0 * margin, size[1] - 2.0 * margin
    if a < -1e-9 or b < -1e-9:
        return 0
    a, b = max(a, 0.0), max(b, 0.0)
    bound = 2.0 * a * b / (math.sqrt(3.0) * spacing**2) + (a + b) / spacing + 1.0
    return math.floor(bound + 1e-6)
