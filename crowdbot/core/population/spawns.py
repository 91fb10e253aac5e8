"""Sample one spawn: groups, positions, routes and the parameters of each person.

Each purpose has its own random stream, named after the spawn; positions and goals have one more for
each group, so that an occupied position changes only one group.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from crowdbot.core.population.bodies import draw_bodies
from crowdbot.core.population.draws import (
    Streams,
    area_of,
    draw_groups,
    draw_numbers,
    heading_to,
    stream_heading,
)
from crowdbot.core.population.ground import Ground
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import ATTEMPTS, Placer
from crowdbot.core.types.arrays import Array, Point
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import Goals, Spawn
from crowdbot.dsl.spec.areas import GoalArea
from crowdbot.dsl.spec.parameters import Sample
from crowdbot.errors import InputError

#: Spacing on the circle of a group's goals, in diameters.
_APART = 1.25


def linked_walk(
    areas: Mapping[str, GoalArea], begin: tuple[str, ...], length: int, rng: np.random.Generator
) -> list[str]:
    """Return a random walk on the areas' links, which turns back only at dead ends."""
    walk = [begin[rng.integers(len(begin))]]
    while len(walk) < length:
        links = areas[walk[-1]].next
        onward = [n for n in links if len(walk) < 2 or n != walk[-2]] or list(links)
        walk.append(onward[rng.integers(len(onward))])
    return walk


class SpawnSampler:
    """Samples one spawn; `rows` returns its part of the agents' table."""

    def __init__(
        self, name: str, spawn: Spawn, scenario: Scenario, crowd: Crowd, streams: Streams
    ) -> None:
        self._name, self._spawn, self._crowd, self._streams = name, spawn, crowd, streams
        self._environment = scenario.environment
        self._area = area_of(spawn.area, scenario.environment.zones)
        self._count = round(spawn.people(self._area.size[0] * self._area.size[1]))
        self._bodies = draw_bodies(
            crowd.people,
            (),
            (
                self._parameter("radius", spawn.radius, crowd.body.radius),
                self._parameter("mass", spawn.mass, crowd.body.mass),
            ),
            self._rng,
            fixed=(spawn.radius is not None, spawn.mass is not None),
        )
        self._radius = self._bodies.radius

    def rows(self, occupancy: Occupancy, next_group: int) -> list[dict[str, Any]]:
        """Return one row per person without ``id`` and ``goal_key``, and add them to the occupancy.

        Args:
            occupancy: the discs of people placed before.
            next_group: number of the first group of several people.

        Raises:
            InputError: not all people fit into the area.
        """
        groups = draw_groups(self._spawn.groups, self._rng("groups"), self._count, None)
        places = self._places(groups, occupancy)
        table = self._parameters()
        rows: list[dict[str, Any]] = []
        for unit, members in enumerate(groups):
            routes = self._routes(unit, members, places[members[0]], occupancy.ground)
            alone = len(members) == 1
            for i, goals in zip(members, routes, strict=True):
                x, y = places[i].tolist()
                route = ((x, y),) if self._spawn.standing else goals
                rows.append(
                    {name: column[i] for name, column in table.items()}
                    | {"x": x, "y": y, "heading": self._heading(i, x, y, route)}
                    | {"group": -1 if alone else next_group, "goals": route}
                )
            next_group += not alone
        return rows

    # ------------------------------------------------------------------ parameters
    def _rng(self, purpose: str, unit: int | None = None) -> np.random.Generator:
        return self._streams.rng(f"crowd.spawns.{purpose}.{self._name}", unit)

    def _parameter(self, purpose: str, sample: Sample | None, default: float) -> Array:
        if sample is None:
            return np.full(self._count, default)
        even = 2.0 * self._rng(purpose).random(self._count) - 1.0
        return sample.value + sample.spread * even

    def _parameters(self) -> dict[str, Any]:
        """Return the columns of the table that do not depend on places."""
        spawn, body, count = self._spawn, self._crowd.body, self._count
        return {
            "radius": self._radius,
            "speed": self._bodies.walk_at(self._speeds()),
            "mass": self._bodies.mass,
            **self._bodies.seen,
            "max_speed": self._parameter("max_speed", spawn.max_speed, body.max_speed),
            "max_acceleration": self._parameter(
                "max_acceleration", spawn.max_acceleration, body.max_acceleration
            ),
            "start_time": self._parameter("start_time", spawn.start_time, 0.0),
            "attention": self._rng("attention").random(count),
            "policy": self._policies(),
            "at_goal": [spawn.at_goal] * count,
            "portals": [spawn.portals or ("", "")] * count,
        }

    def _speeds(self) -> Array:
        speed = self._spawn.speed or self._crowd.speed
        assert speed is not None  # checked on validation
        return draw_numbers(self._rng("speed"), self._count, speed)

    def _policies(self) -> list[str]:
        names = self._spawn.policy
        if not names:
            return [""] * self._count
        return [names[i] for i in self._rng("policy").integers(len(names), size=self._count)]

    def _heading(self, i: int, x: float, y: float, route: tuple[Point, ...]) -> float:
        heading = self._spawn.heading
        if heading == "random":
            return float(self._rng("heading", i).uniform(-math.pi, math.pi))
        if heading != "goal":
            return heading
        if self._spawn.portals:
            return stream_heading(self._spawn.portals, self._environment.portals)
        return heading_to(x, y, route[0])

    # ---------------------------------------------------------------------- groups

    def _places(self, groups: list[range], occupancy: Occupancy) -> Array:
        """Return everyone's start (N, 2), m; larger groups choose first."""
        placer = Placer(self._area, self._radius, self._spawn.spacing or 0.0, occupancy)
        for unit in sorted(range(len(groups)), key=lambda g: -len(groups[g])):
            if not placer.put_group(groups[unit], self._rng("place", unit)):
                raise InputError(
                    f"only {placer.placed} of {self._count} people of spawn "
                    f"'{self._name}' fit into its area"
                )
        return placer.places

    # ---------------------------------------------------------------------- routes
    def _routes(
        self, unit: int, members: range, start: Array, ground: Ground
    ) -> list[tuple[Point, ...]]:
        """Return the routes of a group's members, side by side, from the start of its first."""
        goals = self._spawn.goals
        if goals is None:
            return [()] * len(members)
        rng = self._rng("goals", unit)
        names = self._sequence(goals, rng)
        points = [(float(start[0]), float(start[1]))]
        for name in names:
            points.append(self._goal(name, points[-1], ground, rng))
        points = points[1:]
        if goals.order == "linked" and goals.at_goal == "loop":
            points, names = points + points[-2:0:-1], names + names[-2:0:-1]
        if len(members) == 1:
            return [tuple(points)]
        turn = 2.0 * math.pi * self._rng("goals.around", unit).random()
        return [
            tuple(
                self._beside(name, point, k, members, turn, ground)
                for name, point in zip(names, points, strict=True)
            )
            for k in range(len(members))
        ]

    def _beside(
        self, name: str, point: Point, k: int, members: range, turn: float, ground: Ground
    ) -> Point:
        """Return the k-th member's goal: on a circle around the group's goal, if that is free."""
        radius = float(self._radius[members].max())
        reach = radius * _APART / math.sin(math.pi / len(members))
        angle = turn + 2.0 * math.pi * k / len(members)
        area = area_of(self._crowd.goal_areas[name].area, self._environment.zones)
        room = [max(0.0, 0.5 * side - reach) for side in area.size]
        u, v = (min(max(w, -r), r) for w, r in zip(area.own(*point), room, strict=True))
        x, y = area.point(u, v)
        beside = x + reach * math.cos(angle), y + reach * math.sin(angle)
        free = ground.is_free(*beside, radius) and ground.reaches(point, beside, radius)
        return beside if free else point

    def _sequence(self, goals: Goals, rng: np.random.Generator) -> list[str]:
        names, length = goals.areas, goals.length
        if goals.order == "fixed":
            return [names[i % len(names)] for i in range(length)]
        if goals.order == "random":
            return [names[i] for i in rng.integers(len(names), size=length)]
        return linked_walk(self._crowd.goal_areas, names, length, rng)

    def _goal(self, name: str, start: Point, ground: Ground, rng: np.random.Generator) -> Point:
        """Return a point of a goal area with room for a body, reachable from another point."""
        area = area_of(self._crowd.goal_areas[name].area, self._environment.zones)
        radius = float(np.max(self._radius, initial=0.0))
        for _ in range(ATTEMPTS):
            u, v = rng.random() - 0.5, rng.random() - 0.5
            point = area.point(u * area.size[0], v * area.size[1])
            if ground.is_free(*point, radius) and ground.reaches(start, point, radius):
                return point
        raise InputError(
            f"spawn '{self._name}': goal area '{name}' around ({area.centre[0]:g}, "
            f"{area.centre[1]:g}) has no free place to which a way leads from "
            f"({start[0]:g}, {start[1]:g})"
        )
