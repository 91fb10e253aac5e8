"""A map of robot_sf, the same for SVG, YAML and JSON, and its conversion to scenes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.others.shapes import Corners, area_of, middle, rectangle_in, size
from crowdbot.core.exchange.others.usual import social_forces, standing_robot
from crowdbot.core.exchange.polygons import add_polygon
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Data, Draft, free_name

#: People per m^2 on routes and in crowded zones, and width of a route, m: usual values there.
DENSITY, WIDTH = 0.04, 3.0
#: Most robot routes, each of which is a scenario.
_MOST_ROUTES = 50


@dataclass(slots=True)
class RobotSfRoute:
    """A route from one zone to another.

    Attributes:
        item: where it is written.
        spawn: number of the spawn zone.
        goal: number of the goal zone.
        points: way points, m.
    """

    item: Item
    spawn: int
    goal: int
    points: Corners


@dataclass(slots=True)
class Person:
    """A single pedestrian: start, then the points where it goes."""

    item: Item
    points: Corners
    speed: float | None = None


@dataclass(slots=True)
class RobotSfMap:
    """Contents of a map; zones by their number.

    Attributes:
        item: the whole.
        bounds: x0, x1, y0, y1; None to take those of everything.
    """

    item: Item
    bounds: tuple[float, float, float, float] | None = None
    obstacles: list[tuple[Item, Corners]] = field(default_factory=list)
    zones: dict[str, dict[int, tuple[Item, Corners]]] = field(default_factory=dict)
    robot_routes: list[RobotSfRoute] = field(default_factory=list)
    ped_routes: list[RobotSfRoute] = field(default_factory=list)
    people: list[Person] = field(default_factory=list)

    def zone(self, kind: str, number: int, route: RobotSfRoute) -> tuple[Item, Corners]:
        """Return a zone, or a square at the route's end where the map has none of that number."""
        known = self.zones.get(kind, {})
        if number in known:
            return known[number]
        x, y = route.points[0 if "spawn" in kind else -1]
        return route.item, [[x - 1, y - 1], [x + 1, y - 1], [x + 1, y + 1], [x - 1, y + 1]]


def scenes_of(sf_map: RobotSfMap, name: str, note: str, report: Report) -> list[Draft]:
    """Return one scene for each route of the robot, or one without a robot.

    Raises:
        SpecError: E402, a route names a zone that is not there.
    """
    if not sf_map.robot_routes:
        sf_map.robot_routes = _straight_routes(sf_map, report)
    _unused(sf_map, report)
    routes = sf_map.robot_routes[:_MOST_ROUTES]
    for route in sf_map.robot_routes[_MOST_ROUTES:]:
        report.left_out(route.item, f"more than {_MOST_ROUTES} routes")
    scenes = []
    chosen: list[RobotSfRoute | None] = [*routes]
    for way in chosen or [None]:
        ending = f"-{way.spawn}-{way.goal}" if way is not None and len(routes) > 1 else ""
        scene = Draft(f"{name}{ending}")
        scene.notes.append(note)
        _floor(sf_map, scene, report)
        if way is not None:
            _robot(sf_map, way, scene, report)
        _people(sf_map, scene, report)
        scenes.append(scene)
    return scenes


def _straight_routes(sf_map: RobotSfMap, report: Report) -> list[RobotSfRoute]:
    """Return a route from each spawn zone of the robot to each of its goal zones."""
    spawns, goals = (sf_map.zones.get(f"robot_{n}_zone", {}) for n in ("spawn", "goal"))
    made = []
    for start, (item, corners) in spawns.items():
        for end, (_, others) in goals.items():
            points = [middle(rectangle_in(c)[0]) for c in (corners, others)]
            made.append(RobotSfRoute(item, start, end, points))
    if made:
        note = "from each spawn zone to each goal zone: the map has no robot_route"
        report.added("robots.task", note, sf_map.item.mark)
    return made


def _unused(sf_map: RobotSfMap, report: Report) -> None:
    """Record zones that no route begins or ends in."""
    for owner, routes in (("robot", sf_map.robot_routes), ("ped", sf_map.ped_routes)):
        for kind in ("spawn", "goal"):
            named = {route.spawn if kind == "spawn" else route.goal for route in routes}
            for number, (item, _) in sf_map.zones.get(f"{owner}_{kind}_zone", {}).items():
                if number not in named:
                    report.left_out(item, f"no route of {_NAMES[owner]} has {kind}_id {number}")


_NAMES = {"robot": "the robot", "ped": "people"}


def _floor(sf_map: RobotSfMap, scene: Draft, report: Report) -> None:
    if sf_map.bounds is not None:
        x0, x1, y0, y1 = sf_map.bounds
        scene.environment = {"kind": "floor", "border": "walls",
                             "area": {"x": [x0, x1], "y": [y0, y1]}}  # fmt: skip
    scene.origins["environment",] = sf_map.item.mark
    for item, corners in sf_map.obstacles:
        inside = _within(corners, sf_map.bounds)
        add_polygon(scene, report, item, inside)
        report.carried(item, "environment.blocks")


def _within(corners: Corners, bounds: tuple[float, float, float, float] | None) -> Corners:
    """Return an outline with its corners clamped to the bounds of the map."""
    if bounds is None:
        return corners
    x0, x1, y0, y1 = bounds
    return [[min(max(x, x0), x1), min(max(y, y0), y1)] for x, y in corners]


def _robot(sf_map: RobotSfMap, route: RobotSfRoute, scene: Draft, report: Report) -> None:
    _, spawn = sf_map.zone("robot_spawn_zone", route.spawn, route)
    item, goal = sf_map.zone("robot_goal_zone", route.goal, route)
    start_area, _ = rectangle_in(spawn)
    goal_area, how = rectangle_in(goal)
    x, y = middle(start_area)
    ahead = next((p for p in route.points if math.dist(p, (x, y)) > 0.1), middle(goal_area))
    scene.part("zones", "robot_goal", goal_area, item.mark)
    heading = math.atan2(ahead[1] - y, ahead[0] - x)
    scene.robots["robot"] = standing_robot("robot_goal", (x, y, heading))
    scene.origins["robots", "robot"] = route.item.mark
    report.interpreted(route.item, "robots.task", "from zone to zone; planners find the way")
    if how:
        report.interpreted(item, "zones.robot_goal", how)
    report.added("robots.robot.model", "a TurtleBot2", route.item.mark)


def _people(sf_map: RobotSfMap, scene: Draft, report: Report) -> None:
    streams: Data = {}
    for route in sf_map.ped_routes:
        _, spawn = sf_map.zone("ped_spawn_zone", route.spawn, route)
        _, goal = sf_map.zone("ped_goal_zone", route.goal, route)
        origin, destination = rectangle_in(spawn)[0], rectangle_in(goal)[0]
        length = _length(route.points)
        count = max(1, min(round(DENSITY * WIDTH * length), round(0.8 * size(origin))))
        name = free_name(f"route_{route.spawn}_{route.goal}", streams)
        streams[name] = {"kind": "through", "origin": area_of(origin), "count": count,
                         "destination": area_of(destination),
                         "at_destination": "return"}  # fmt: skip
        scene.origins["crowd", "streams", name] = route.item.mark
        note = f"{DENSITY} people/m^2 on a way {WIDTH:g} m wide; they find their own way"
        report.interpreted(route.item, "crowd.streams", note)
    _crowded(sf_map, scene, streams, report)
    if streams:
        scene.crowd["streams"] = streams
        scene.crowd["speed"] = {"mean": 1.3, "std": 0.2}
    if streams or sf_map.people:
        policy = scene.policy(social_forces(), "social_forces", sf_map.item.mark)
        scene.crowd["routing"] = {"kind": "mesh"}
        report.added("crowd.policy", "its social force model is ours of 1995", sf_map.item.mark)
        for person in sf_map.people:
            _single(person, policy, scene, report)


def _length(points: Corners) -> float:
    return sum(math.dist(a, b) for a, b in pairwise(points))


def _crowded(sf_map: RobotSfMap, scene: Draft, streams: Data, report: Report) -> None:
    for number, (item, corners) in sf_map.zones.get("ped_crowded_zone", {}).items():
        area, _ = rectangle_in(corners)
        name = free_name(f"crowded_{number}", streams)
        scene.crowd.setdefault("goal_areas", {})[name] = {"area": area_of(area)}
        streams[name] = {"kind": "wandering", "area": area_of(area), "areas": [name],
                         "count": max(1, round(DENSITY * size(area)))}  # fmt: skip
        scene.origins["crowd", "streams", name] = item.mark
        note = f"people who stroll within, {DENSITY} people/m^2"
        report.interpreted(item, "crowd.streams", note)


def _single(person: Person, policy: str, scene: Draft, report: Report) -> None:
    (x, y), *goals = person.points
    row: Data = {"x": x, "y": y, "goals": goals or [[x, y]], "policy": policy,
                 "speed": person.speed or 1.3}  # fmt: skip
    scene.agent(row, person.item.mark)
    report.carried(person.item, "crowd.agents")
