"""Checks of zones and of robots' paths; nothing is built."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.dsl.checks.facts import Facts
from crowdbot.dsl.checks.known_places import known_place, standing_in
from crowdbot.dsl.checks.person_goals import agents_of
from crowdbot.dsl.checks.reach import areas_connected, first_is_outside, spot
from crowdbot.dsl.scenario.person_goals import PersonGoal
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.outlines import Point
from crowdbot.dsl.spec.place import Place
from crowdbot.dsl.spec.spec import Rectangle
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError, did_you_mean, nearest

#: Tolerance for a robot that touches a wall, m.
_SLACK = 1e-6


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


def check_descriptions(facts: Facts) -> Iterator[Diagnostic]:
    """Check that a robot's description has the links and joints that its fields name."""
    for name, robot in facts.scenario.robots.items():
        known, path = robot.model.described(), ("robots", name)
        if not known:
            continue
        named = [(part, own, (*path, "model", *at)) for part, own, at in robot.model.named()]
        sensors = robot.sensors.items()
        named += [("link", s.link, (*path, "sensors", n, "link")) for n, s in sensors if s.link]
        for part, expected, at in named:
            if expected not in known[part]:
                text = f"the description of robot '{name}' has no {part} '{expected}'"
                names = sorted(known[part])
                hint = did_you_mean(nearest(expected, names)).removeprefix("; ")
                yield Diagnostic(
                    "E130", text, facts.mark(*at), hint or f"known: {', '.join(names)}"
                )


def check_tasks(facts: Facts) -> Iterator[Diagnostic]:
    """Check that each goal exists, and that no robot starts outside of the zones or in its goal."""
    zones = facts.scenario.environment.zones
    for name, robot in facts.scenario.robots.items():
        task, path = robot.task, ("robots", name, "task")
        start = task.start[:2]
        if task.zone is not None:
            yield from _check_zone(facts, name, start, task.zone, zones.get(task.zone))
        yield from facts.outside(f"the start {{at}} of robot '{name}'", [start], *path, "start")


def _check_zone(
    facts: Facts, name: str, start: Point, goal: str, zone: Rectangle | None
) -> Iterator[Diagnostic]:
    """Check that the zone of a goal exists, and that the robot does not start in it."""
    path = ("robots", name, "task")
    if zone is None:
        yield facts.unknown("zone", goal, facts.scenario.environment.zones, *path, "goal", "zone")
    elif zone.contains(*start):
        text = f"robot '{name}' starts in its goal: {_at(start)} lies in zone '{goal}'"
        hint = "it would arrive after 0 s; move the start, or choose another zone"
        yield Diagnostic("E145", text, facts.mark(*path, "start"), hint)


def check_robots(facts: Facts) -> Iterator[Diagnostic]:
    """Check that no robot starts inside an obstacle, and that a path leads to its goal.

    Only obstacles on the floor count, since a robot's height is unknown here.
    """
    place = known_place(facts.scenario.environment)
    if place is None or place.torus is not None:
        return
    standing = standing_in(place)
    for name, robot in facts.scenario.robots.items():
        yield from _check_robot(facts, standing, name, robot)


def _check_robot(facts: Facts, place: Place, name: str, robot: Robot) -> Iterator[Diagnostic]:
    start, path = robot.task.start[:2], ("robots", name, "task")
    if any(facts.outside("", [start])):
        return  # already an error
    missing = robot.model.half_width - place.clearance(*start)
    if missing > _SLACK:
        text = f"robot '{name}' starts in a wall, a block or a pillar, at {_at(start)}"
        hint = f"there is {missing:.3g} m too little room"
        yield Diagnostic("E143", text, facts.mark(*path, "start"), hint)
        return
    if robot.task.person is not None and facts.scenario.crowd is not None:
        yield from _check_way_to_person(facts, place, name, robot, robot.task.person)
    zone = facts.scenario.environment.zones.get(robot.task.zone or "")
    if zone is None:
        return  # already an error, or the goal is a person
    goal, radius = Area.of(zone), robot.model.half_width
    if not _leads(facts, place, radius, start, goal):
        ends = spot(start), goal.corners
        if facts.bounds is not None and first_is_outside(place, radius, facts.bounds, *ends):
            text = f"the start {_at(start)} of robot '{name}' lies outside the walls that enclose "
            text += f"zone '{robot.task.zone}'"
            yield Diagnostic("E132", text, facts.mark(*path, "start"))
            return
        text = f"no way leads robot '{name}' from {_at(start)} to zone '{robot.task.zone}'"
        hint = f"around {_at(goal.centre)}, for a body that is {2.0 * radius:g} m wide"
        yield Diagnostic("E143", text, facts.mark(*path, "goal", "zone"), hint)


def _check_way_to_person(
    facts: Facts, place: Place, name: str, robot: Robot, goal: PersonGoal
) -> Iterator[Diagnostic]:
    """Check that a way leads to the start of the goal's agent, or to one of its goals."""
    start, radius = robot.task.start[:2], robot.model.half_width
    agents = [agent for agent in agents_of(facts.crowd, goal) if not agent.portals]
    body = max((agent.radius or facts.crowd.body.radius for agent in agents), default=0.0)
    side = 2.0 * (goal.distance + goal.tolerance + radius + body)
    places = [at for agent in agents for at in ((agent.x, agent.y), *agent.goals)]
    around = [Area(centre=(x, y), size=(side, side)) for x, y in places]
    if around and not any(_leads(facts, place, radius, start, area) for area in around):
        text = f"no way leads robot '{name}' from {_at(start)} to {goal.person}"
        hint = f"around {_at(places[0])}, for a body that is {2.0 * radius:g} m wide"
        mark = facts.mark("robots", name, "task", "goal", "person")
        yield Diagnostic("E143", text, mark, hint)


def _leads(facts: Facts, place: Place, radius: float, start: Point, goal: Area) -> bool:
    """Return True if a path may lead a body of a radius (m) from a point into an area."""
    zones = facts.scenario.environment.zones.values()
    points = [start, *(p for zone in zones for p in zone.polygon)]
    xs, ys = zip(*points, strict=True)
    box = min(xs), max(xs), min(ys), max(ys)
    return areas_connected(place, radius, box, spot(start), goal.corners)


def _at(point: Point) -> str:
    return f"({point[0]:g}, {point[1]:g})"
