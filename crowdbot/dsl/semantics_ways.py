"""Checks of where people stand and whether a way leads to their goals; nothing is built."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from crowdbot.dsl.areas import Area, places_in
from crowdbot.dsl.areas import Place as PlaceName
from crowdbot.dsl.component_specs import EnvironmentSpec
from crowdbot.dsl.diagnostics import Diagnostic
from crowdbot.dsl.place import Place
from crowdbot.dsl.reach import Reach, reach_of
from crowdbot.dsl.routing import MeshRouting
from crowdbot.dsl.semantics_facts import Facts
from crowdbot.dsl.spawning import Agent, Spawn
from crowdbot.dsl.stream_kinds import StreamChoice, ThroughStream, WanderingStream
from crowdbot.errors import InputError

#: A body may touch a wall by rounding, m.
_SLACK = 1e-6


def check_ways(facts: Facts) -> Iterator[Diagnostic]:
    """The place can be read; nobody starts in a wall; who finds ways finds one."""
    environment = facts.scenario.environment
    try:
        place = environment.place()
    except InputError as error:
        yield Diagnostic("E144", str(error), facts.mark("environment", "file"))
        return
    if place is None or facts.scenario.crowd is None:
        return
    finds_way = isinstance(facts.crowd.routing, MeshRouting)
    if finds_way and place.torus is not None:
        text = "routing 'mesh' does not lead across the borders of a torus"
        hint = "use routing 'straight', or another border"
        yield Diagnostic("E142", text, facts.mark("crowd", "routing"), hint)
        return
    ways = _Ways(facts, place.bodies(facts.crowd.body.height), environment)
    yield from ways.check_starts()
    yield from ways.check_streams()
    if finds_way:
        yield from ways.check_agents()
        yield from ways.check_spawns()


@dataclass(frozen=True)
class _Ways:
    facts: Facts
    place: Place
    environment: EnvironmentSpec

    def check_starts(self) -> Iterator[Diagnostic]:
        """Explicit agents do not stand in walls."""
        for i, agent in enumerate(self.facts.crowd.agents):
            gap = self.place.clearance(agent.x, agent.y) - self._radius(agent)
            if gap < -_SLACK:
                text = f"agent {agent.id} stands in a wall, a block or a pillar"
                hint = f"at ({agent.x:g}, {agent.y:g}) there is {-gap:.3g} m too little room"
                yield Diagnostic("E143", text, self.facts.mark("crowd", "agents", i, "x"), hint)

    def check_streams(self) -> Iterator[Diagnostic]:
        """There is room to come in where streams do."""
        for name, stream in self.facts.crowd.streams.items():
            radius = stream.body.radius or self.facts.crowd.body.radius
            field, place = _entrance(stream)
            area = None if place is None else self._resolve(place)
            if area is not None and not self._has_room(area, radius):
                text = f"nobody of stream '{name}' can come in around {_at(area)}"
                hint = f"walls leave no room for a body of radius {radius:g} m"
                yield Diagnostic(
                    "E143", text, self.facts.mark("crowd", "streams", name, field), hint
                )

    def _resolve(self, place: PlaceName) -> Area | None:
        """A place as an area: of its own, a zone or a portal."""
        portal = self.environment.portals.get(place) if isinstance(place, str) else None
        return self.facts.resolve(place) or (Area.of(portal) if portal else None)

    def _has_room(self, area: Area, radius: float) -> bool:
        return any(self.place.clearance(*at) >= radius - _SLACK for at in places_in(area, radius))

    def check_agents(self) -> Iterator[Diagnostic]:
        """A way leads along the whole route of each explicit agent."""
        for i, agent in enumerate(self.facts.crowd.agents):
            reach, at = self._reach(self._radius(agent)), (agent.x, agent.y)
            for k, goal in enumerate(agent.goals):
                if not reach.connects(at, goal):
                    text = (
                        f"no way leads agent {agent.id} from ({at[0]:g}, {at[1]:g}) "
                        f"to its goal ({goal[0]:g}, {goal[1]:g})"
                    )
                    mark = self.facts.mark("crowd", "agents", i, "goals", k)
                    hint = "" if reach.is_free(*goal) else "there is no room for a body"
                    yield Diagnostic("E143", text, mark, hint)
                    break
                at = goal

    def check_spawns(self) -> Iterator[Diagnostic]:
        """A way leads from somewhere in each spawn's area into each of its goal areas."""
        for name, spawn in self.facts.crowd.spawns.items():
            start = self.facts.resolve(spawn.area)
            for k, goal in enumerate(spawn.goals.areas if spawn.goals else ()):
                found = self.facts.crowd.goal_areas.get(goal)
                end = None if found is None else self.facts.resolve(found.area)
                if start is not None and end is not None and not self._leads(spawn, start, end):
                    text = (
                        f"no way leads from spawn '{name}' around {_at(start)} "
                        f"to goal area '{goal}' around {_at(end)}"
                    )
                    path = ("crowd", "spawns", name, "goals", "areas", k)
                    yield Diagnostic("E143", text, self.facts.mark(*path))

    def _leads(self, spawn: Spawn, start: Area, end: Area) -> bool:
        usual = self.facts.crowd.body.radius
        radius = spawn.radius.value - spawn.radius.spread if spawn.radius else usual
        return self._reach(radius).connects_areas(start.corners, end.corners)

    def _radius(self, agent: Agent) -> float:
        return agent.radius or self.facts.crowd.body.radius

    def _reach(self, radius: float) -> Reach:
        points = [(a.x, a.y) for a in self.facts.crowd.agents]
        points += [goal for a in self.facts.crowd.agents for goal in a.goals]
        boxes = (*self.environment.zones.values(), *self.environment.portals.values())
        points += [p for box in boxes for p in box.polygon]
        for named in (self.facts.crowd.spawns, self.facts.crowd.goal_areas):
            areas = (self.facts.resolve(one.area) for one in named.values())
            points += [p for area in areas if area is not None for p in area.corners]
        xs, ys = [p[0] for p in points] or [0.0], [p[1] for p in points] or [0.0]
        return reach_of(self.place, radius, (min(xs), max(xs), min(ys), max(ys)))


def _entrance(stream: StreamChoice) -> tuple[str, PlaceName | None]:
    """The field with the area in which people of a stream come in, if they do, and the area."""
    if isinstance(stream, ThroughStream) and (stream.arrivals or stream.end == "return"):
        return "origin", stream.origin
    if isinstance(stream, WanderingStream) and stream.arrivals:
        return "area", stream.area
    return "", None


def _at(area: Area) -> str:
    return f"({area.centre[0]:g}, {area.centre[1]:g})"
