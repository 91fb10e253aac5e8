"""Check where people stand, and that a path leads to their goals; nothing is built."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from crowdbot.dsl.checks.facts import Facts, Path
from crowdbot.dsl.checks.known_places import bodies_of, known_place, place_of
from crowdbot.dsl.checks.reach import (
    Box,
    Reach,
    areas_connected,
    first_is_outside,
    has_room,
    reach_of,
    spot,
)
from crowdbot.dsl.checks.robots import check_zones
from crowdbot.dsl.scenario.routing import MeshRouting
from crowdbot.dsl.scenario.spawning import Agent, Spawn
from crowdbot.dsl.scenario.stream import Stream
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.areas import Place as PlaceName
from crowdbot.dsl.spec.component_specs import EnvironmentSpec
from crowdbot.dsl.spec.outlines import Point
from crowdbot.dsl.spec.place import Place
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError

#: Smallest radius of any kind of people, m.
_THINNEST = 0.1

#: Tolerance for a body that touches a wall, m.
_SLACK = 1e-6


def check_place(facts: Facts) -> Iterator[Diagnostic]:
    """Check that the place can be read and that its zones lie in it."""
    try:
        place = place_of(facts.scenario.environment)
    except InputError as error:
        yield Diagnostic("E144", str(error), facts.mark("environment", "file"))
        return
    if place is not None:
        yield from check_zones(facts)


def check_paths(facts: Facts) -> Iterator[Diagnostic]:
    """Check that people start clear of walls, and that a path leads to their goals."""
    place = known_place(facts.scenario.environment)
    if place is None:
        return
    finds_path = isinstance(facts.crowd.routing, MeshRouting)
    if finds_path and place.torus is not None:
        text = "routing 'mesh' does not lead across the borders of a torus"
        hint = "use routing 'straight', or another border"
        yield Diagnostic("E142", text, facts.mark("crowd", "routing"), hint)
        return
    bodies = bodies_of(place, facts.crowd.body.height)
    paths = _PathCheck(facts, bodies, facts.scenario.environment)
    yield from paths.check_starts()
    yield from paths.check_room()
    if finds_path:
        yield from paths.check_streams()
        yield from paths.check_flows()
        yield from paths.check_agents()
        yield from paths.check_spawns()
    else:
        yield from paths.check_goals()


@dataclass(frozen=True)
class _PathCheck:
    facts: Facts
    place: Place
    environment: EnvironmentSpec

    def check_starts(self) -> Iterator[Diagnostic]:
        """Check that explicit agents do not stand in walls."""
        for i, agent in enumerate(self.facts.crowd.agents):
            gap = self.place.clearance(agent.x, agent.y) - self._radius(agent)
            if gap < -_SLACK:
                text = f"agent {agent.id} stands in a wall, a block or a pillar"
                hint = f"at ({agent.x:g}, {agent.y:g}) there is {-gap:.3g} m too little room"
                yield Diagnostic("E143", text, self.facts.mark("crowd", "agents", i, "x"), hint)

    def check_room(self) -> Iterator[Diagnostic]:
        """Check that bodies fit where streams start and enter, in queues, and in portals."""
        for name, stream in self.facts.crowd.streams.items():
            radius = self._stream_radius(stream)
            for field in stream.entrances():
                area = self._resolve(getattr(stream, field))
                if area is not None and not has_room(self.place, area, radius):
                    text = f"people of stream '{name}' cannot come in around {_at(area)}"
                    yield self._no_room(text, radius, "crowd", "streams", name, field)
            yield from self._check_spots(name, stream, radius)
        for path, pair, radius in self._users_of_portals():
            for i, portal in enumerate(pair):
                area = self._resolve(portal)
                if area is not None and not has_room(self.place, area, radius):
                    text = f"people cannot walk through portal '{portal}' around {_at(area)}"
                    yield self._no_room(text, radius, *path, "portals", i)

    def _no_room(self, text: str, radius: float, *path: str | int) -> Diagnostic:
        hint = f"walls leave no room for a body of radius {radius:g} m"
        return Diagnostic("E143", text, self.facts.mark(*path), hint)

    def _check_spots(self, name: str, stream: Stream, radius: float) -> Iterator[Diagnostic]:
        for field, points in stream.spots():
            for x, y in points:
                if self.place.clearance(x, y) < radius - _SLACK:
                    text = f"people cannot stand in the {stream.kind} '{name}' at ({x:g}, {y:g})"
                    yield self._no_room(text, radius, "crowd", "streams", name, *field)
                    break

    def _users_of_portals(self) -> Iterator[tuple[Path, tuple[str, str], float]]:
        """Yield the path of each field that names a pair of portals, the pair, and a radius, m."""
        crowd, usual = self.facts.crowd, self._usual_radius
        if crowd.flow is not None:
            yield ("crowd", "flow"), crowd.flow.portals, usual
        for i, agent in enumerate(crowd.agents):
            if agent.portals is not None:
                yield ("crowd", "agents", i), agent.portals, self._radius(agent)

    # ---------------------------------------------------------------------------- paths
    def check_streams(self) -> Iterator[Diagnostic]:
        """Check that a path leads from where each stream begins to everywhere it goes, in turn."""
        for name, stream in self.facts.crowd.streams.items():
            radius = self._stream_radius(stream)
            areas = {name: one.area for name, one in self.facts.crowd.goal_areas.items()}
            for start, goal, path in stream.legs(self._resolve, areas):
                if not self._connects(start, goal, radius):
                    text = f"no way leads stream '{name}' from {_at(start)} to {_at(goal)}"
                    mark = self.facts.mark("crowd", "streams", name, *path)
                    yield Diagnostic("E143", text, mark)
                    break

    def check_flows(self) -> Iterator[Diagnostic]:
        """Check that a path leads between the portals of a flow, and from its people to them."""
        for path, pair, radius in self._users_of_portals():
            ends = [area for area in map(self._resolve, pair) if area is not None]
            flow = self.facts.crowd.flow
            if path == ("crowd", "flow") and flow is not None:
                ends = [*ends, *filter(None, [self._resolve(flow.area)])]
            for other in ends[1:]:
                if not self._connects(ends[0], other, radius):
                    text = f"no way leads from portal '{pair[0]}' around {_at(ends[0])} "
                    text += f"to {_at(other)}"
                    yield Diagnostic("E143", text, self.facts.mark(*path, "portals"))
                    break

    def _connects(self, start: Area, goal: Area, radius: float) -> bool:
        return areas_connected(self.place, radius, self._box, start.corners, goal.corners)

    @property
    def _usual_radius(self) -> float:
        usual = self.facts.crowd.body.radius
        return min(usual, _THINNEST) if self.facts.crowd.people else usual

    def _stream_radius(self, stream: Stream) -> float:
        return stream.body.radius or self._usual_radius

    def _resolve(self, place: PlaceName) -> Area | None:
        """Return a place as an area: its own area, a zone or a portal."""
        portal = self.environment.portals.get(place) if isinstance(place, str) else None
        return self.facts.resolve(place) or (Area.of(portal) if portal else None)

    def check_agents(self) -> Iterator[Diagnostic]:
        """Check that a path leads along the whole route of each explicit agent."""
        for i, agent in enumerate(self.facts.crowd.agents):
            reach, at = self._reach(self._radius(agent)), (agent.x, agent.y)
            for k, goal in enumerate(agent.goals):
                if not reach.connects(at, goal):
                    free = reach.is_free(*at) and reach.is_free(*goal)
                    outside = self._outside(agent, i, k, at, goal) if free else None
                    if outside is not None:
                        yield outside
                        break
                    text = (
                        f"no way leads agent {agent.id} from ({at[0]:g}, {at[1]:g}) "
                        f"to its goal ({goal[0]:g}, {goal[1]:g})"
                    )
                    mark = self.facts.mark("crowd", "agents", i, "goals", k)
                    hint = "" if reach.is_free(*goal) else "there is no room for a body"
                    yield Diagnostic("E143", text, mark, hint)
                    break
                at = goal

    def _outside(self, agent: Agent, i: int, k: int, at: Point, goal: Point) -> Diagnostic | None:
        """Return the error if walls enclose one end of an agent's way and not the other end."""
        bounds, radius = self.facts.bounds, self._radius(agent)
        for end_name, end, other, *path in (
            ("place", at, goal, *(("goals", k - 1) if k else ("x",))),
            ("goal", goal, at, "goals", k),
        ):
            ends = spot(end), spot(other)
            if bounds is not None and first_is_outside(self.place, radius, bounds, *ends):
                text = (
                    f"the {end_name} ({end[0]:g}, {end[1]:g}) of agent {agent.id} lies outside the "
                )
                text += f"walls that enclose ({other[0]:g}, {other[1]:g})"
                return Diagnostic("E132", text, self.facts.mark("crowd", "agents", i, *path))
        return None

    def check_goals(self) -> Iterator[Diagnostic]:
        """Check, for people who walk straight, that no goal lies in something solid."""
        for i, agent in enumerate(self.facts.crowd.agents):
            for k, (x, y) in enumerate(agent.goals):
                if self.place.clearance(x, y) < -_SLACK:
                    text = f"a goal of agent {agent.id} lies in a wall, a block or a pillar"
                    mark = self.facts.mark("crowd", "agents", i, "goals", k)
                    yield Diagnostic("E143", text, mark, f"at ({x:g}, {y:g})")
        crowd = self.facts.crowd
        areas = {name: one.area for name, one in crowd.goal_areas.items()}
        for name, place in areas.items():
            area = self._resolve(place)
            if area is not None and not has_room(self.place, area, 0.0):
                text = f"goal area '{name}' lies in a wall, a block or a pillar"
                mark = self.facts.mark("crowd", "goal_areas", name, "area")
                yield Diagnostic("E143", text, mark, f"around {_at(area)}")
        for name, stream in crowd.streams.items():
            for _, goal, path in stream.legs(self._resolve, areas):
                if not has_room(self.place, goal, 0.0):
                    text = f"stream '{name}' leads into a wall, a block or a pillar"
                    mark = self.facts.mark("crowd", "streams", name, *path)
                    yield Diagnostic("E143", text, mark, f"around {_at(goal)}")

    def check_spawns(self) -> Iterator[Diagnostic]:
        """Check that a path leads from each spawn's area into each of its goal areas."""
        for name, spawn in self.facts.crowd.spawns.items():
            start = self.facts.resolve(spawn.area)
            for field, goal in spawn.goal_area_names():
                found = self.facts.crowd.goal_areas.get(goal)
                end = None if found is None else self.facts.resolve(found.area)
                if start is not None and end is not None and not self._leads(spawn, start, end):
                    text = (
                        f"no way leads from spawn '{name}' around {_at(start)} "
                        f"to goal area '{goal}' around {_at(end)}"
                    )
                    mark = self.facts.mark("crowd", "spawns", name, *field)
                    yield Diagnostic("E143", text, mark)

    def _leads(self, spawn: Spawn, start: Area, end: Area) -> bool:
        radius = spawn.least_radius(self.facts.crowd.body.radius)
        return self._connects(start, end, radius)

    def _radius(self, agent: Agent) -> float:
        return agent.radius or self.facts.crowd.body.radius

    def _reach(self, radius: float) -> Reach:
        return reach_of(self.place, radius, self._box)

    @cached_property
    def _box(self) -> Box:
        """Return a box around all positions and areas that the scenario names, m."""
        crowd = self.facts.crowd
        points = [(a.x, a.y) for a in crowd.agents]
        points += [goal for a in crowd.agents for goal in a.goals]
        boxes = (*self.environment.zones.values(), *self.environment.portals.values())
        points += [p for box in boxes for p in box.polygon]
        named = [one.area for group in (crowd.spawns, crowd.goal_areas) for one in group.values()]
        named += [place for one in crowd.streams.values() for _, place in one.places()]
        points += [p for place in named if isinstance(place, Area) for p in place.corners]
        points += [p for one in crowd.streams.values() for _, at in one.points() for p in at]
        xs, ys = [p[0] for p in points] or [0.0], [p[1] for p in points] or [0.0]
        return min(xs), max(xs), min(ys), max(ys)


def _at(area: Area) -> str:
    return f"({area.centre[0]:g}, {area.centre[1]:g})"
