"""The contents of a scenario at its start, as shapes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from crowdbot.core.geometry.rotation import rotation
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.types.arrays import Array, Point
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.view.names import MapNames
from crowdbot.core.view.shapes import SPEEDS, Disc, Path, Shape, Text
from crowdbot.core.view.ways import Ways
from crowdbot.core.view.world import Map

_ARC = 120  # corners of a full circle that is drawn as an area
#: Obstacles that are not higher are drawn as low, m.
LOW = 0.4


@dataclass(frozen=True, slots=True, kw_only=True)
class Sector:
    """A sensor's view: a sector around a position, m and rad, world frame.

    Attributes:
        axis: direction of its axis, before roll and pitch.
        tilt: roll and pitch of the sensor.
        height: height above the floor for a planar sensor, whose view ends there; else None.
    """

    name: str
    x: float
    y: float
    start: float
    end: float
    reach: float
    axis: float = 0.0
    tilt: tuple[float, float] = (0.0, 0.0)
    height: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotView:
    """A robot at its start: x, y, heading; name of its goal zone, rows of people of its task.

    ``radius`` covers the whole footprint, m; ``outline`` holds points around a robot that is not a
    disc, world frame.
    """

    name: str
    x: float
    y: float
    yaw: float
    radius: float
    goal: str
    targets: tuple[int, ...] = ()
    sensors: tuple[Sector, ...] = ()
    outline: tuple[Point, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MapContent:
    """Shapes on a map of a scenario: floor, people, robots, areas and paths.

    Attributes:
        areas: role -> name -> polygon, of spawns and goal areas.
        ways: paths of people through their goals.
    """

    parts: EnvironmentParts
    people: Realisation
    robots: tuple[RobotView, ...] = ()
    areas: Mapping[str, Mapping[str, tuple[Point, ...]]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    ways: Ways = field(default_factory=lambda: Ways(of_agents=()))


def extent(content: MapContent) -> Iterator[Point]:
    """Yield points whose bounds contain everything except the sensors' views."""
    parts, people = content.parts, content.people
    for x0, y0, x1, y1 in parts.walls.tolist():
        yield from ((x0, y0), (x1, y1))
    for x, y, r in parts.pillars.tolist():
        yield from ((x - r, y - r), (x + r, y + r))
    for polygon in parts.zones.values():
        yield from ((float(x), float(y)) for x, y in polygon)
    for box in (
        *parts.portals.values(),
        *([parts.periodic_boundary] if parts.periodic_boundary else []),
    ):
        yield from _corners(box)
    for named in content.areas.values():
        for corners in named.values():
            yield from corners
    yield from zip(people.x.tolist(), people.y.tolist(), strict=True)
    for route in people.goals:
        yield from route
    for robot in content.robots:
        yield (robot.x, robot.y)


def shapes(content: MapContent, world: Map) -> Iterator[Shape]:
    """Yield all shapes of the map, bottom layer first."""
    x, y, width, height = world.box
    corners = ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
    yield Path(points=corners, role="floor", closed=True)
    yield from world.grid()
    yield from _places(content, world)
    yield from _sensors(content.robots, world)
    yield from _mesh(content.ways, world)
    yield from _walls(content.parts, world)
    yield from _routes(content, world)
    yield from _people(content, world)
    yield from _robots(content, world)
    yield from _names(content, world)
    yield Path(points=corners, role="frame", closed=True, inside=False)
    yield from world.numbers()


def fastest(people: Realisation) -> float:
    """Return the top of the colour range, m/s: the largest preferred speed, rounded up to 0.2."""
    return math.ceil(float(people.speed.max(initial=0.0)) * 5.0 - 1e-9) / 5.0 or 1.0


def _places(content: MapContent, world: Map) -> Iterator[Shape]:
    goals = {robot.goal for robot in content.robots}
    for name, polygon in content.parts.zones.items():
        yield world.path(polygon.tolist(), "goal" if name in goals else "zone", closed=True)
    for box in content.parts.portals.values():
        yield world.path(_corners(box), "portal", closed=True)
    for role, named in content.areas.items():
        for corners in named.values():
            yield world.path(corners, role, closed=True)
    if content.parts.periodic_boundary is not None:
        yield world.path(_corners(content.parts.periodic_boundary), "torus", closed=True)


def _walls(parts: EnvironmentParts, world: Map) -> Iterator[Shape]:
    """Yield solids as areas, walls that are not a solid's side as lines, pillars as discs."""
    for outline, heights in zip(parts.solids, parts.solid_heights.tolist(), strict=True):
        yield world.path(outline.tolist(), solid_role(*heights), closed=True)
    alone = ~parts.sides()
    rows = zip(
        parts.walls[alone].tolist(), parts.stops_robot[alone], parts.stops_crowd[alone], strict=True
    )
    for (x0, y0, x1, y1), robot, crowd in rows:
        role = "wall" if robot and crowd else "wall-robot" if robot else "wall-crowd"
        yield world.path([(x0, y0), (x1, y1)], role)
    for x, y, r in parts.pillars.tolist():
        yield Disc(centre=world.at(x, y), radius=r * world.scale, role="pillar")
    for outline in parts.left_out:
        yield world.path(outline.tolist(), "left-out", closed=True)


def solid_role(bottom: float, top: float) -> str:
    """Return the role of a solid in the drawing: raised, low, or neither."""
    return "solid-raised" if bottom > 0.0 else "solid-low" if top <= LOW else "solid"


def _mesh(ways: Ways, world: Map) -> Iterator[Shape]:
    for link in ways.links:
        yield world.path(link, "mesh-link")
    for ring in ways.margins:
        yield world.path(ring, "mesh", closed=True)


def _routes(content: MapContent, world: Map) -> Iterator[Shape]:
    """Yield each agent's path through its goals; one line for agents with the same path."""
    people = content.people
    for way in content.ways.of_agents:
        if way:
            yield world.path(way, "route")
    for x, y in dict.fromkeys(point for route in people.goals for point in route):
        yield Disc(centre=world.at(x, y), radius=3.5, role="route-end")


def _people(content: MapContent, world: Map) -> Iterator[Shape]:
    """Yield group links, then people, then their arrows, so that no disc hides an arrow."""
    people, top = content.people, fastest(content.people)
    for group in np.unique(people.group[people.group >= 0]):
        members = np.flatnonzero(people.group == group)
        yield world.path([(float(people.x[i]), float(people.y[i])) for i in members], "group")
    for i in range(len(people)):
        shade = min(len(SPEEDS) - 1, int(float(people.speed[i]) / top * len(SPEEDS)))
        yield Disc(
            centre=world.at(float(people.x[i]), float(people.y[i])),
            radius=float(people.radius[i]) * world.scale,
            role=f"person-{shade}",
            about=_about(people, i),
        )
    for i in sorted({row for robot in content.robots for row in robot.targets}):
        at = world.at(float(people.x[i]), float(people.y[i]))
        yield Disc(centre=at, radius=float(people.radius[i]) * world.scale + 4.0, role="wanted")
    for i in range(len(people)):
        x, y, speed = float(people.x[i]), float(people.y[i]), float(people.speed[i])
        if speed > 0.0:
            yield from arrow(world, x, y, _heading(content, i), speed)


def arrow(world: Map, x: float, y: float, heading: float, length: float) -> Iterator[Shape]:
    """Yield an arrow of ``length`` m from a centre; its head is never longer than the arrow."""
    c, s = math.cos(heading), math.sin(heading)
    tip = (x + length * c, y + length * s)
    head = min(6.0 / world.scale, 0.4 * length)
    wings = [
        (tip[0] - head * (c + k * 0.55 * s), tip[1] - head * (s - k * 0.55 * c)) for k in (-1, 1)
    ]
    yield world.path([(x, y), tip], "arrow")
    yield world.path([wings[0], tip, wings[1]], "arrow")


def _heading(content: MapContent, i: int) -> float:
    """Return an agent's starting direction: to its exit, its first goal, or its heading."""
    people = content.people
    x, y = float(people.x[i]), float(people.y[i])
    out = content.parts.portals.get(people.portals[i][1])
    if people.at_goal[i] == "portal" and out is not None:
        to = (min(max(x, out[0]), out[1]), min(max(y, out[2]), out[3]))
    elif people.goals[i] and math.dist(people.goals[i][0], (x, y)) > 0:
        to = people.goals[i][0]
    else:
        return float(people.heading[i])
    return math.atan2(to[1] - y, to[0] - x)


def _about(people: Realisation, i: int) -> str:
    words = [f"agent {people.id[i]}", f"{people.speed[i]:.2f} m/s"]
    words += [f"group {people.group[i]}"] if people.group[i] >= 0 else []
    words += [f"from t = {people.start_time[i]:g} s"] if people.start_time[i] > 0 else []
    words += [f"policy {people.policy[i]}"] if people.policy[i] else []
    return ", ".join([*words, f"then {people.at_goal[i]}"])


def _sensors(robots: Iterable[RobotView], world: Map) -> Iterator[Shape]:
    for robot in robots:
        for sensor in robot.sensors:
            yield world.path(_sector(sensor), "sensor", closed=True)


def _sector(sensor: Sector) -> list[Point]:
    width = min(sensor.end - sensor.start, math.tau)
    count = max(2, math.ceil(_ARC * width / math.tau))
    angles = np.linspace(sensor.start, sensor.start + width, count + 1).tolist()
    if any(sensor.tilt):
        arc = _tilted_arc(sensor, np.array(angles))
    else:
        arc = [
            (sensor.x + sensor.reach * math.cos(a), sensor.y + sensor.reach * math.sin(a))
            for a in angles
        ]
    return arc if width >= math.tau else [(sensor.x, sensor.y), *arc]


def _tilted_arc(sensor: Sector, angles: Array) -> list[Point]:
    """Return the far ends of a tilted sensor's rays, seen from above."""
    own = angles - sensor.axis
    fan = np.column_stack([np.cos(own), np.sin(own), np.zeros_like(own)])
    rays = fan @ rotation(*sensor.tilt, sensor.axis).T
    reach = np.full(len(rays), sensor.reach)
    if sensor.height is not None:
        down = rays[:, 2] < 0.0
        reach[down] = np.minimum(reach[down], sensor.height / -rays[down, 2])
    ends = reach[:, np.newaxis] * rays[:, :2] + (sensor.x, sensor.y)
    return [(x, y) for x, y in ends.tolist()]


def _robots(content: MapContent, world: Map) -> Iterator[Shape]:
    for robot in content.robots:
        zone = content.parts.zones.get(robot.goal)
        if zone is not None:
            centre = zone.mean(axis=0)
            yield Disc(centre=world.at(*centre.tolist()), radius=5.0, role="robot-goal")
        at, r = world.at(robot.x, robot.y), robot.radius
        if robot.outline:
            yield world.path(robot.outline, "robot", closed=True)
        else:
            yield Disc(centre=at, radius=r * world.scale, role="robot", about=robot.name)
        nose = (robot.x + r * math.cos(robot.yaw), robot.y + r * math.sin(robot.yaw))
        yield world.path([(robot.x, robot.y), nose], "robot-nose")


def _names(content: MapContent, world: Map) -> Iterator[Shape]:
    goals = {robot.goal for robot in content.robots}
    names = MapNames(world)
    for name, polygon in content.parts.zones.items():
        role = "text-goal" if name in goals else "text-zone"
        yield names.put(f"{name} (goal)" if name in goals else name, polygon.tolist(), role)
    for name, box in content.parts.portals.items():
        yield names.put(f"portal {name}", _corners(box), "text-portal")
    for role, named in content.areas.items():
        for name, corners in named.items():
            yield names.put(name, corners, "text-route" if role == "goal-area" else "text-muted")
    for robot in content.robots:
        x, y = world.at(robot.x, robot.y)
        up = robot.radius * world.scale + 8.0
        yield Text(at=(x, y - up), text=robot.name, role="text-robot", anchor="middle")


def _corners(box: tuple[float, float, float, float]) -> tuple[Point, ...]:
    x0, x1, y0, y1 = box
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
