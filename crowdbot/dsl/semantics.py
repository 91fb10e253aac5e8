"""Checks between fields that no single field can make, after a scenario is validated."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from crowdbot.dsl.base import Rectangle
from crowdbot.dsl.diagnostics import Diagnostic
from crowdbot.dsl.nodes import Node
from crowdbot.dsl.scenario import Crowd, Scenario, Task
from crowdbot.dsl.validation import locate, mark_of, missing_field
from crowdbot.errors import did_you_mean, nearest

_WHOLE = 1e-6


def check(scenario: Scenario, tree: Node) -> list[Diagnostic]:
    """All contradictions of a scenario, each with its place in the tree it came from."""
    found = list(_check_kinds(scenario, tree))
    if scenario.crowd is not None:
        found += _check_flow(scenario, scenario.crowd, tree)
        found += _check_policy(scenario.crowd, tree)
    for name, robot in scenario.robots.items():
        found += _check_task(scenario, name, robot.task, tree)
    return found


def _check_kinds(scenario: Scenario, tree: Node) -> Iterator[Diagnostic]:
    """A kind is always written: left out, it would mean something as long as one is installed."""
    paths: list[tuple[str, ...]] = [("environment",)]
    if scenario.crowd is not None:
        paths += [("crowd", "policy"), *(("crowd", "costs", n) for n in scenario.crowd.costs)]
    for name, robot in scenario.robots.items():
        paths += [("robots", name, "model")]
        paths += [("robots", name, "sensors", sensor) for sensor in robot.sensors]
    for path in paths:
        place = locate(tree, path)
        if not place.rest and place.node.child("kind") is None:
            yield missing_field(tree, place, "kind")


def _check_flow(scenario: Scenario, crowd: Crowd, tree: Node) -> Iterator[Diagnostic]:
    flow, zones, portals = crowd.flow, scenario.environment.zones, scenario.environment.portals
    if flow.area in zones:
        yield from _check_count(flow.density, zones[flow.area], flow.area, tree)
    else:
        yield _unknown("zone", flow.area, zones, tree, "crowd", "flow", "area")
    for i, portal in enumerate(flow.portals):
        if portal not in portals:
            yield _unknown("portal", portal, portals, tree, "crowd", "flow", "portals", i)
    if flow.portals[0] == flow.portals[1]:
        mark = mark_of(tree, "crowd", "flow", "portals")
        yield Diagnostic("E130", "a flow needs two different portals", mark)


def _check_count(density: float, zone: Rectangle, name: str, tree: Node) -> Iterator[Diagnostic]:
    count = density * zone.area
    if abs(count - round(count)) <= _WHOLE and round(count) >= 1:
        return
    fits = [n for n in (math.floor(count), math.ceil(count)) if n >= 1]
    hint = " or ".join(f"{n / zone.area:.10g} 1/m^2 ({_people(n)})" for n in fits)
    text = (
        f"{density:g} 1/m^2 on the {zone.area:g} m^2 of zone '{name}' is {count:.6g} people, "
        "not a whole number"
    )
    yield Diagnostic("E131", text, mark_of(tree, "crowd", "flow", "density"), f"nearest: {hint}")


def _people(count: int) -> str:
    return "1 person" if count == 1 else f"{count} people"


def _check_policy(crowd: Crowd, tree: Node) -> Iterator[Diagnostic]:
    if crowd.policy.kind == "velocity_space" and not crowd.costs:
        text = "policy velocity_space minimises cost functions, and crowd.costs has none"
        yield Diagnostic("E133", text, mark_of(tree, "crowd", "costs"))


def _check_task(scenario: Scenario, name: str, task: Task, tree: Node) -> Iterator[Diagnostic]:
    zones = scenario.environment.zones
    if task.goal.zone not in zones:
        yield _unknown("zone", task.goal.zone, zones, tree, "robots", name, "task", "goal", "zone")
    x, y = task.start[:2]
    if zones and not _bounds(zones.values()).contains(x, y):
        text = f"the start ({x:g}, {y:g}) of robot '{name}' lies outside the environment's zones"
        yield Diagnostic("E132", text, mark_of(tree, "robots", name, "task", "start"))


def _bounds(zones: Iterable[Rectangle]) -> Rectangle:
    listed = list(zones)
    xs = [x for zone in listed for x in zone.x]
    ys = [y for zone in listed for y in zone.y]
    return Rectangle(x=(min(xs), max(xs)), y=(min(ys), max(ys)))


def _unknown(
    what: str, name: str, known: Iterable[str], tree: Node, *path: str | int
) -> Diagnostic:
    names = sorted(known)
    hint = did_you_mean(nearest(name, names)).removeprefix("; ")
    hint = hint or (f"known: {', '.join(names)}" if names else f"the environment has no {what}s")
    text = f"the environment has no {what} '{name}'"
    return Diagnostic("E130", text, mark_of(tree, *path), hint)
