"""Checks of zones and of robots' paths; nothing is built."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.dsl.checks.facts import Facts
from crowdbot.dsl.checks.known_places import known_place, standing_in
from crowdbot.dsl.checks.reach import areas_connected
from crowdbot.dsl.scenario.scenario import TaskSpec
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.place import Place
from crowdbot.dsl.spec.spec import Rectangle
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError

#: Smallest radius of any robot, m: places out of its reach are out of reach for all.
_THINNEST = 0.1


def check_zones(facts: Facts) -> Iterator[Diagnostic]:
    """Check that each written zone lies on the floor, if the environment knows its box."""
    environment = facts.scenario.environment
    try:
        whole = environment.extent()
    except InputError:  # reported with the environment
        return
    if whole is None:
        return
    (x0, x1), (y0, y1) = whole.x, whole.y
    for name, zone in environment.zones.items():
        if _overlap(zone, whole):
            continue
        hint = f"it reaches from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g})"
        if _overlap(Rectangle(x=zone.y, y=zone.x), whole):
            hint += "; are x and y swapped?"
        text = f"zone '{name}' lies outside of the environment"
        yield Diagnostic("E132", text, facts.mark("environment", "zones", name), hint)


def _overlap(one: Rectangle, other: Rectangle) -> bool:
    pairs = ((one.x, other.x), (one.y, other.y))
    return all(a[0] < b[1] and b[0] < a[1] for a, b in pairs)


def check_robots(facts: Facts) -> Iterator[Diagnostic]:
    """Check that no robot starts inside an obstacle, and that a path leads to its goal.

    Only obstacles on the floor count, since a robot's height is unknown here.
    """
    place = known_place(facts.scenario.environment)
    if place is None or place.torus is not None:
        return
    standing = standing_in(place)
    for name, robot in facts.scenario.robots.items():
        yield from _check_robot(facts, standing, name, robot.task)


def _check_robot(facts: Facts, place: Place, name: str, task: TaskSpec) -> Iterator[Diagnostic]:
    x, y = task.start[:2]
    path = ("robots", name, "task")
    if any(facts.outside("", [(x, y)])):
        return  # already an error
    if place.clearance(x, y) < 0.0:
        text = f"robot '{name}' starts in a wall, a block or a pillar, at ({x:g}, {y:g})"
        yield Diagnostic("E143", text, facts.mark(*path, "start"))
        return
    zones = facts.scenario.environment.zones
    zone = zones.get(task.goal.zone)
    if zone is None:
        return
    goal, start = Area.of(zone), Area(centre=(x, y), size=(0.01, 0.01))
    points = [p for z in zones.values() for p in z.polygon]
    xs, ys = [x, *(p[0] for p in points)], [y, *(p[1] for p in points)]
    box = min(xs), max(xs), min(ys), max(ys)
    if not areas_connected(place, _THINNEST, box, start.corners, goal.corners):
        text = f"no way leads robot '{name}' from ({x:g}, {y:g}) to zone '{task.goal.zone}'"
        hint = f"around ({goal.centre[0]:g}, {goal.centre[1]:g})"
        yield Diagnostic("E143", text, facts.mark(*path, "goal", "zone"), hint)
