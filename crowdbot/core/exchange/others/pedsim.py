"""pedsim_ros: scene XML with obstacles, waypoints, queues, attractions and agents."""

from __future__ import annotations

import math
from collections.abc import Sequence

from crowdbot.core.exchange.clearing import FreeFloor, shape_of
from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.shapes import area_of, box
from crowdbot.core.exchange.others.usual import social_forces, standing_robot
from crowdbot.core.exchange.polygons import add_wall
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Data, Draft, free_name, id_of, name_of

SCENARIO = RowTable(
    "scenario",
    (
        Row("obstacle", "environment.walls", "5 cm thick"),
        Row("waypoint", "crowd.goal_areas", "the square in its circle"),
        Row("waypoint@b", "", "its behaviour"),
        Row("queue", "crowd.goal_areas", "a goal 1 m wide: people do not line up at it"),
        Row("attraction", "", "people are not drawn to places they have no goal in"),
        Row("source, sink", "crowd.goal_areas", "people neither enter there nor leave"),
    ),
)
AGENT = RowTable(
    "agent",
    (
        Row("@x, @y, @dx, @dy", "crowd.spawns.area", "the middle, and the width and depth"),
        Row("@n", "crowd.spawns.count"),
        Row("@type=0, 1", "crowd.spawns.speed", "adults 1.34 m/s, children 1 m/s"),
        Row("@type=2", "robots", "a TurtleBot2; its way points are its start and goal"),
        Row("@type=3", "crowd.spawns.speed", "elderly people, 0.9 m/s"),
        Row("addwaypoint, addqueue", "crowd.spawns.goals.areas"),
    ),
)
#: Speeds by type: mean and standard deviation, m/s.
_SPEEDS = {0: (1.34, 0.26), 1: (1.0, 0.2), 3: (0.9, 0.15)}
_RADIUS, _THICK = 0.35, 0.05
#: Root elements: of pedsim_ros, and of the library that it is made of.
_ROOTS = {"scenario", "welcome"}
#: A place, and half the width of a robot's goal, m.
_Way = list[tuple[str, list[float]]]
_HALF = 0.5


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each file.

    Raises:
        SpecError: E402, a value is invalid, or a waypoint is unknown.
    """
    return [_scene(file, root, context.report) for file in files for root in file.roots]


def _scene(file: OpenedScene, root: Item, report: Report) -> Draft:
    scene = Draft(id_of(file.path.stem))
    scene.notes.append(f"Imported from pedsim_ros: {file.path.name}.")
    for item in root.every("obstacle"):
        ends = [[item.need(f"@x{k}").number(), item.need(f"@y{k}").number()] for k in (1, 2)]
        if math.dist(*ends) < 1e-6:
            report.left_out(item, "it has no length")
            continue
        add_wall(scene, item, ends[0], ends[1], _THICK)
        report.interpreted(item, "environment.walls", SCENARIO.rows[0].note)
    for item in root.every("attraction"):
        report.left_out(item, SCENARIO.rows[4].note)
    areas = _areas(root, scene, report)
    for item in root.every("agent"):
        _agent(item, areas, scene, report)
    if scene.crowd.get("spawns"):
        scene.policy(social_forces(), "social_forces", root.mark)
        scene.crowd["body"] = {"radius": _RADIUS}
        _find_ways(root, scene, report)
        report.interpreted(root, "crowd.policy", "its social force model is ours of 1995")
        report.added("crowd.body.radius", f"{_RADIUS} m, as pedsim has it", root.mark)
    return scene


def _find_ways(root: Item, scene: Draft, report: Report) -> None:
    """Let people find ways round walls, if all goals can be reached."""
    if not scene.environment.get("walls"):
        return
    floor, areas = FreeFloor(scene), scene.crowd.get("goal_areas", {})
    legs = [
        (spawn["area"], areas[name]["area"])
        for spawn in scene.crowd["spawns"].values()
        for name in spawn.get("goals", {}).get("areas", ())
    ]
    if all(floor.joins(shape_of(start), shape_of(goal), _RADIUS) for start, goal in legs):
        scene.crowd["routing"] = {"kind": "mesh"}
        report.added("crowd.routing", "people find their way round walls", root.mark)
    else:
        note = "straight to their goals, as in pedsim: walls shut some of them off"
        report.added("crowd.routing", note, root.mark)


def _areas(root: Item, scene: Draft, report: Report) -> dict[str, tuple[str, list[float]]]:
    """Return id -> name of the goal area and its bounds x0, x1, y0, y1."""
    found: dict[str, tuple[str, list[float]]] = {}
    areas: Data = {}
    for item in root.every("waypoint", "queue", "source", "sink"):
        ident = item.find("@id")
        key = ident.text() if ident else f"{item.name}{len(found)}"
        x, y = item.need("@x").number(), item.need("@y").number()
        radius = item.find("@r")
        half = 0.7071 * radius.number(0.0, 1e4) if radius else 0.5
        half = max(half, 0.1)
        bounds = [x - half, x + half, y - half, y + half]
        name = free_name(name_of(key), areas)
        areas[name] = {"area": area_of(box(*bounds))}
        scene.origins["crowd", "goal_areas", name] = item.mark
        found[key] = (name, bounds)
        row = SCENARIO.rows[1] if item.name == "waypoint" else SCENARIO.rows[3]
        note = row.note if item.name in ("waypoint", "queue") else SCENARIO.rows[5].note
        report.interpreted(item, "crowd.goal_areas", note)
        for extra in ("@b", "@direction"):
            if (part := item.find(extra)) is not None:
                report.left_out(part, "its behaviour, or the direction of the line")
    if areas:
        scene.crowd["goal_areas"] = areas
    return found


def _agent(
    item: Item, areas: dict[str, tuple[str, list[float]]], scene: Draft, report: Report
) -> None:
    kind = item.find("@type")
    number = kind.whole(0, 3) if kind else 0
    x, y = item.need("@x").number(), item.need("@y").number()
    way = []
    for part in item.every("addwaypoint", "addqueue"):
        ident = part.need("@id")
        if ident.text() not in areas:
            ident.refuse(f"no waypoint '{ident.text()[:60]}'", list(areas))
        way.append(areas[ident.text()])
        report.carried(part, "crowd.spawns.goals.areas")
    if number == 2:
        _robot(item, (x, y), way, scene, report)
        return
    _spawn(item, (x, y), number, [name for name, _ in way], scene, report)


def _spawn(
    item: Item, at: tuple[float, float], number: int, way: list[str], scene: Draft, report: Report
) -> None:  # fmt: skip
    count = item.find("@n")
    people = count.whole(0, 100_000) if count else 1
    halves = []
    for name in ("@dx", "@dy"):
        part = item.find(name)
        halves.append(max(0.5 * part.number(0.0, 1e5) if part else 0.0, 1.2 * _RADIUS))
    if people == 0:
        report.left_out(item, "no people: n is 0")
        return
    needed = people * 4.0 * (2.2 * _RADIUS) ** 2
    grown = max(1.0, (needed / (4.0 * halves[0] * halves[1])) ** 0.5)
    if grown > 1.0:
        report.interpreted(item, "crowd.spawns.area", "grown, since people may not overlap here")
    dx, dy = halves[0] * grown, halves[1] * grown
    mean, std = _SPEEDS[number]
    spawn: Data = {
        "area": area_of(box(at[0] - dx, at[0] + dx, at[1] - dy, at[1] + dy)), "count": people,
        "speed": {"mean": mean, "std": std},
    }  # fmt: skip
    if way:
        spawn["goals"] = {"areas": way, "at_goal": "loop"}
    else:
        spawn["standing"] = True
    spawns = scene.crowd.setdefault("spawns", {})
    name = free_name("people", spawns)
    spawns[name] = spawn
    scene.origins["crowd", "spawns", name] = item.mark
    for part in item.every("@x", "@y", "@dx", "@dy", "@n", "@type"):
        report.carried(part, "crowd.spawns")


def _robot(item: Item, at: tuple[float, float], way: _Way, scene: Draft, report: Report) -> None:
    name = free_name("robot", scene.robots)
    x, y = _robot_goal(item, at, way, scene, report)
    zone = {"x": [x - _HALF, x + _HALF], "y": [y - _HALF, y + _HALF]}
    scene.part("zones", f"{name}_goal", zone, item.mark)
    scene.robots[name] = standing_robot(f"{name}_goal", (*at, 0.0))
    scene.origins["robots", name] = item.mark
    report.interpreted(item, "robots", AGENT.rows[3].note)
    for part in item.every("@n", "@dx", "@dy"):
        fine = part.number() == (1 if part.name == "@n" else 0)
        if fine:
            report.carried(part, "robots")
        else:
            report.left_out(part, "one robot stands at its x and y")


def _robot_goal(
    item: Item, at: tuple[float, float], way: _Way, scene: Draft, report: Report
) -> tuple[float, float]:
    """Return the last way point that can be reached, m; without one a place near the start."""
    floor = FreeFloor(scene)
    middles = [(0.5 * (b[0] + b[1]), 0.5 * (b[2] + b[3])) for _, b in reversed(way)]
    apart = [(name, goal) for (name, _), goal in zip(reversed(way), middles, strict=True)
             if max(abs(goal[0] - at[0]), abs(goal[1] - at[1])) > 2.0 * _HALF]  # fmt: skip
    for name, goal in apart:
        if _leads(floor, at, goal):
            if name != way[-1][0]:
                note = f"the way point '{name}': the robot starts in later ones, or walls shut them"
                report.interpreted(item, "robots.task.goal", f"{note} off")
            return goal
    if apart:
        return apart[0][1]
    near = next((p for p in _around(at) if _leads(floor, at, p)), _around(at)[0])
    note = f"{math.dist(at, near):g} m away: the robot has no way point that it does not start in"
    report.added("robots.task.goal", note, item.mark)
    return near


def _around(at: tuple[float, float]) -> list[tuple[float, float]]:
    """Return places ahead, behind and beside, far ones first, m."""
    ways = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
    return [(at[0] + far * x, at[1] + far * y) for far in (5.0, 3.0, 2.0) for x, y in ways]


def _leads(floor: FreeFloor, start: tuple[float, float], goal: tuple[float, float]) -> bool:
    """Return True if the floor has a way from a place to another."""
    from shapely import Point  # type: ignore[import-untyped,unused-ignore]

    ends = Point(start).buffer(_HALF), Point(goal).buffer(_HALF)
    return not floor.bounded or floor.joins(*ends, _HALF)


PEDSIM = SceneFormat(
    "pedsim",
    "pedsim_ros scenes",
    lambda file: file.kind == "xml" and bool(_ROOTS & file.tags),
    read,
    (SCENARIO, AGENT),
    "attractions, lines of waiting people, behaviours of waypoints",
)
