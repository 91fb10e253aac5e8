"""robot_sf: maps as labelled SVG, and as JSON or YAML."""

from __future__ import annotations

import re
from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.map_of_robot_sf import (
    Person,
    RobotSfMap,
    RobotSfRoute,
    scenes_of,
)
from crowdbot.core.exchange.others.shapes import Corners, pairs
from crowdbot.core.exchange.others.svg_paths import points_of
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, id_of

SVG = RowTable(
    "svg",
    (
        Row("@width, @height, @viewBox", "environment.area, border",
            "one unit is 1 m, y as it is written, from the corner of the viewBox"),
        Row("label obstacle", "environment.blocks"),
        Row("label robot_spawn_zone, robot_goal_zone", "robots.task"),
        Row("label robot_route_I_J", "robots.task", "each route is a scenario"),
        Row("label ped_spawn_zone, ped_goal_zone, ped_route_I_J", "crowd.streams",
            "0.04 people/m^2 on a way 3 m wide"),
        Row("label ped_crowded_zone, crowded_zone", "crowd.streams", "people who stroll within"),
        Row("label single_ped_ID_start, single_ped_ID_goal", "crowd.agents"),
        Row("class poi, other labels", "", "places that no one goes to"),
        Row("shapes without a label", "", "robot_sf does not read them"),
        Row("@transform", "", "robot_sf reads raw coordinates, and so does this"),
        Row("styles, layers, titles", "", "robot_sf reads labelled shapes only"),
    ),
)  # fmt: skip
MAP = RowTable(
    "map",
    (
        Row("x_margin, y_margin", "environment.area, border"),
        Row("obstacles", "environment.blocks"),
        Row("robot_spawn_zones, robot_goal_zones, goal_zones, robot_routes", "robots.task"),
        Row("ped_spawn_zones, ped_goal_zones, ped_routes", "crowd.streams",
            "0.04 people/m^2 on a way 3 m wide"),
        Row("ped_crowded_zones", "crowd.streams", "people who stroll within"),
        Row("single_pedestrians", "crowd.agents"),
    ),
)  # fmt: skip
_ZONE = re.compile(r"(robot_spawn_zone|robot_goal_zone|ped_spawn_zone|ped_goal_zone|"
                   r"ped_crowded_zone|crowded_zone)(?:_(\d{1,4}))?")  # fmt: skip
_ROUTE = re.compile(r"(robot|ped)_route(?:_(\d{1,4})_(\d{1,4}))?")
_SINGLE = re.compile(r"single_ped_(\w{1,60})_(start|goal)")
_DRAWN = ("rect", "path", "circle", "ellipse", "polygon", "polyline", "line")
_APART = re.compile(r"[\s,]+")
_LENGTH = re.compile(r"\s*([0-9.eE+-]+)\s*(?:px|m)?\s*")


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return the scenes of each map.

    Raises:
        SpecError: E402, a part has an invalid value.
    """
    found = []
    for file in files:
        note = f"Imported from robot_sf: {file.path.name}. x and y are those of the map."
        root = file.roots[0]
        made = _svg(root, context.report) if file.kind == "xml" else _data(root, context.report)
        found += scenes_of(made, id_of(file.path.stem), note, context.report)
    return found


def _svg(root: Item, report: Report) -> RobotSfMap:
    sf_map = RobotSfMap(root)
    corner = _bounds(root, sf_map, report)
    starts: dict[str, tuple[Item, list[float]]] = {}
    goals: dict[str, list[float]] = {}
    for item in list(root.walk()):
        label = _label(item) if item.name in _DRAWN else ""
        if label:
            _labelled(item, label, sf_map, (starts, goals), report)
    for ident, (item, start) in starts.items():
        ends = [goals.pop(ident)] if ident in goals else []
        sf_map.people.append(Person(item, [start, *ends]))
    _move(sf_map, corner)
    for item in root.walk():
        if item.used and item.name in _DRAWN:
            _style(item, report)
        elif item.name in _DRAWN:
            report.left_out(item, SVG.rows[-3].note)
    for item in root.walk():
        if not item.used:
            row = SVG.rows[-2 if item.name == "@transform" else -1]
            report.left_out(item, row.note)
    return sf_map


def _bounds(root: Item, sf_map: RobotSfMap, report: Report) -> tuple[float, float]:
    """Set the bounds of a map; return the corner that its coordinates count from, m."""
    box = root.find("@viewBox")
    numbers = [Item("@viewBox", box.mark, t).number() for t in _APART.split(box.text().strip())
               ] if box else []  # fmt: skip
    if len(numbers) not in (0, 4):
        (box or root).refuse("a viewBox has to be four numbers")
    left, top, wide, high = numbers or [0.0] * 4
    width, height = _length(root, "@width") or wide, _length(root, "@height") or high
    if width > 0.0 and height > 0.0:
        sf_map.bounds = (0.0, width, 0.0, height)
        report.carried(root, "environment.area")
        if box is not None and (wide, high) != (width, height):
            note = f"counts only for its corner: the map is {width:g} m x {height:g} m, not scaled"
            report.interpreted(box, "environment.area", note)
    return left, top


def _move(sf_map: RobotSfMap, corner: tuple[float, float]) -> None:
    """Let the coordinates of a map count from a corner (m)."""
    if corner == (0.0, 0.0):
        return
    lists = [corners for _, corners in sf_map.obstacles]
    lists += [c for zones in sf_map.zones.values() for _, c in zones.values()]
    lists += [route.points for route in [*sf_map.robot_routes, *sf_map.ped_routes]]
    lists += [person.points for person in sf_map.people]
    for points in lists:
        points[:] = [[x - corner[0], y - corner[1]] for x, y in points]


def _label(item: Item) -> str:
    """Return a shape's label; without one, its id if that is a label of the format."""
    label = item.find("@label")
    if label is not None:
        return label.text()
    ident = next((part for part in item.children if part.name == "@id"), None)
    text = "" if ident is None else str(ident.value)
    known = any(form.fullmatch(text) for form in (_ZONE, _ROUTE, _SINGLE))
    return text if known else ""


def _number(item: Item) -> int | None:
    """Return the number at the end of a zone's id."""
    ident = next((part for part in item.children if part.name == "@id"), None)
    zone = _ZONE.fullmatch(str(ident.value)) if ident is not None else None
    return int(zone[2]) if zone and zone[2] else None


def _length(root: Item, name: str) -> float:
    item = root.find(name)
    match = _LENGTH.fullmatch(item.text()) if item else None
    if match is None or item is None:
        return 0.0
    return Item(name, item.mark, match[1]).number(1e-3)


def _labelled(
    item: Item, label: str, sf_map: RobotSfMap,
    singles: tuple[dict[str, tuple[Item, list[float]]], dict[str, list[float]]], report: Report,
) -> None:  # fmt: skip
    if label in ("obstacle", "bound"):
        item.used = True
        sf_map.obstacles.append((item, points_of(item, report)))
    elif zone := _ZONE.fullmatch(label):
        item.used = True
        kind = "ped_crowded_zone" if zone[1] == "crowded_zone" else zone[1]
        known = sf_map.zones.setdefault(kind, {})
        number = int(zone[2]) if zone[2] else _number(item)
        if number is None or number in known:
            number = next(k for k in range(len(known) + 1) if k not in known)
        known[number] = (item, points_of(item, report))
        report.carried(item, "zones")
    elif route := _ROUTE.fullmatch(label):
        item.used = True
        points = points_of(item, report)
        if len(points) < 2:
            item.refuse("a route of fewer than two points")
        into = sf_map.robot_routes if route[1] == "robot" else sf_map.ped_routes
        into.append(RobotSfRoute(item, int(route[2] or 0), int(route[3] or 0), points))
    elif single := _SINGLE.fullmatch(label):
        item.used = True
        at = [item.need("@cx").number(), item.need("@cy").number()]
        if single[2] == "start":
            singles[0][single[1]] = (item, at)
        else:
            singles[1][single[1]] = at
            report.carried(item, "crowd.agents.goals")
    else:
        report.left_out(item, SVG.rows[-4].note)


def _style(item: Item, report: Report) -> None:
    report.others(item, SVG.rows[-2].note, "@transform")
    report.others(item, SVG.rows[-1].note)
    parent = item.parent
    while parent is not None and not parent.used:  # its own attributes follow at the end
        parent.used = True
        parent = parent.parent


def _data(root: Item, report: Report) -> RobotSfMap:
    sf_map = RobotSfMap(root)
    _margins(root, sf_map, report)
    for item in [*root.entries("obstacles"), *root.entries("Obstacles")]:
        report.others(item, "blocks have names of their own", "ID")
        vertices = item.find("vertices") or item.find("Vertex")
        sf_map.obstacles.append((item, pairs(vertices or item)))
    for kind in ("robot_spawn", "robot_goal", "ped_spawn", "ped_goal", "ped_crowded"):
        listed = root.entries(f"{kind}_zones")
        if kind.endswith("goal") and not listed:
            listed = root.entries("goal_zones")
        known = sf_map.zones.setdefault(f"{kind}_zone", {})
        for item in listed:
            known[len(known)] = (item, _zone(item))
            report.carried(item, "zones")
    for kind, into in (("robot", sf_map.robot_routes), ("ped", sf_map.ped_routes)):
        for item in root.entries(f"{kind}_routes"):
            points = pairs(item.need("waypoints"), 2)
            spawn, goal = item.need("spawn_id").whole(0), item.need("goal_id").whole(0)
            into.append(RobotSfRoute(item, spawn, goal, points))
    for item in root.entries("single_pedestrians"):
        sf_map.people.append(_single(item, report))
    return sf_map


def _margins(root: Item, sf_map: RobotSfMap, report: Report) -> None:
    """Set the bounds of a map in JSON or YAML."""
    margins = [root.find(name) for name in ("x_margin", "y_margin")]
    if all(margins):
        numbers = [part.number() for m in margins if m for part in m.every()]
        if len(numbers) != 4 or not (numbers[0] < numbers[1] and numbers[2] < numbers[3]):
            root.refuse("x_margin and y_margin have to be two rising numbers each")
        sf_map.bounds = (numbers[0], numbers[1], numbers[2], numbers[3])
        for m in margins:
            if m is not None:
                report.carried(m, "environment.area")


def _zone(item: Item) -> Corners:
    """Return the corners of a zone given by three, the fourth being a + c - b."""
    points = pairs(item)
    if len(points) == 3:
        (ax, ay), (bx, by), (cx, cy) = points
        points.append([ax + cx - bx, ay + cy - by])
    return points


def _single(item: Item, report: Report) -> Person:
    points = [_point(item.need("start"))]
    goal, trajectory = item.find("goal"), item.find("trajectory")
    if goal is not None and goal.children:
        points.append(_point(goal))
    if trajectory is not None and trajectory.children:
        points += [_point(part) for part in trajectory.every()]
    speed = item.find("speed_m_s") or item.find("speed")
    for part in item.children:
        if not part.used:
            report.left_out(part, "agents have no such parameter")
    given = speed.number(0.01, 20.0) if speed is not None and speed.value is not None else None
    return Person(item, points, given)


def _point(item: Item) -> list[float]:
    numbers = [part.number() for part in item.every()]
    if len(numbers) != 2:
        item.refuse(f"a point has {len(numbers)} numbers, not 2")
    return numbers


def _fits(file: OpenedScene) -> bool:
    if file.kind == "xml":
        return "svg" in file.tags
    return file.kind == "data" and bool({"robot_spawn_zones", "x_margin"} & file.tags)


ROBOT_SF = SceneFormat(
    "robot_sf",
    "robot_sf maps",
    _fits,
    read,
    (SVG, MAP),
    "points of interest, styles, the shape of routes",
)
