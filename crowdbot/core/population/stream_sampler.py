"""Draws one stream: who is in it, where and when each begins, and the ways of all.

Each purpose has its own random stream, named after the stream of people. Way, start and arrival of
a group have one for each group beside that, the body of a person one for each person.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import singledispatchmethod
from typing import Any

import numpy as np

from crowdbot.core.population.arrivals import arrival_times
from crowdbot.core.population.bodies import Bodies, draw_bodies
from crowdbot.core.population.draws import Streams, draw_groups, draw_one, draw_speeds, heading_to
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import ATTEMPTS, Placer
from crowdbot.core.population.stream_routes import (
    Way,
    along,
    border_to_border,
    lane_of,
    straight_on,
    stroll,
    way_through,
)
from crowdbot.core.types.arrays import Array, Point
from crowdbot.dsl.scenario.scenario import AtGoal, Crowd, Scenario
from crowdbot.dsl.scenario.streams import (
    DirectionsStream,
    QueueStream,
    StreamChoice,
    StreamEnd,
    TalkingStream,
    ThroughStream,
    WanderingStream,
)
from crowdbot.dsl.spec.areas import Area, Place, places_in
from crowdbot.dsl.spec.parameters import DurationSample, Sample
from crowdbot.errors import InputError

_AT_GOAL: dict[str, AtGoal] = {
    "return": "return", "leave": "remove", "stop": "stop", "again": "loop",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Start:
    """Where and when one person begins, and the way from there; heading in rad, if not along it."""

    at: Point
    way: Way
    time: float = 0.0
    heading: float | None = None


class StreamSampler:
    """Samples one stream; `rows` makes its part of the agents' table."""

    def __init__(
        self, name: str, stream: StreamChoice, scenario: Scenario, crowd: Crowd, streams: Streams
    ) -> None:
        self._name, self._stream, self._crowd, self._streams = name, stream, crowd, streams
        self._environment = scenario.environment
        self._times: list[float] = []
        arrivals = getattr(stream, "arrivals", None)
        if arrivals is not None:
            self._times = arrival_times(arrivals, self._rng("arrivals"))
        sizes, count = stream.groups, None if arrivals is not None else self._count()
        self._groups = draw_groups(sizes, self._rng("groups"), count, len(self._times))
        self._people = self._groups[-1].stop if self._groups else 0
        self._bodies = self._draw_bodies()
        self._radius = self._bodies.radius

    def rows(self, occupancy: Occupancy, next_group: int) -> list[dict[str, Any]]:
        """One row a person without ``id`` and ``goal_key``.

        Args:
            occupancy: the discs of those who are there already; who starts at once is added.
            next_group: number of the first group of several people; numbers of queues follow it.

        Raises:
            InputError: not all of them fit where they start.
        """
        starts: dict[int, Start] = dict(self._starts(self._stream, occupancy))
        common, speeds, policies = self._common(), self._speeds(), self._policies()
        queue = {"queue": next_group} if isinstance(self._stream, QueueStream) else {}
        rows = []
        for unit, members in enumerate(self._groups):
            alone = len(members) == 1
            for i in members:
                start = starts[i]
                rows.append(
                    common
                    | self._bodies.row(i)
                    | {"x": start.at[0], "y": start.at[1], "start_time": start.time}
                    | {"heading": self._heading(start), "speed": float(speeds[i])}
                    | {"attention": float(self._rng("attention", i).random())}
                    | {"policy": policies[i], "group": -1 if alone else next_group + unit}
                    | start.way.columns()
                    | queue
                )
        return rows

    # ------------------------------------------------------------------- everybody
    def _rng(self, purpose: str, unit: int | None = None) -> np.random.Generator:
        return self._streams.rng(f"crowd.streams.{purpose}.{self._name}", unit)

    def _count(self) -> int:
        stream = self._stream
        if stream.count is not None:
            return stream.count
        assert isinstance(stream, ThroughStream | DirectionsStream | WanderingStream)
        place = stream.starts_in if isinstance(stream, ThroughStream) else stream.area
        sides = self._area(place).size
        return round((stream.density or 0.0) * sides[0] * sides[1])

    def _draw_bodies(self) -> Bodies:
        stream, body = self._stream, self._crowd.body
        radius = np.full(self._people, stream.body.radius or body.radius)
        mass = np.full(self._people, stream.body.mass or body.mass)
        fixed = stream.body.radius is not None, stream.body.mass is not None
        return draw_bodies(
            self._crowd.people, stream.people, (radius, mass), self._rng, fixed=fixed
        )

    def _common(self) -> dict[str, Any]:
        own, body = self._stream.body, self._crowd.body
        return {
            "max_speed": own.max_speed or body.max_speed,
            "max_acceleration": own.max_acceleration or body.max_acceleration,
            "portals": ("", ""),
        }

    def _speeds(self) -> Array:
        speed = self._stream.speed or self._crowd.speed
        assert speed is not None  # checked with the document
        rng = self._rng("speeds")
        if isinstance(speed, Sample):
            return self._bodies.walk_at(np.array([draw_one(rng, speed) for _ in self._radius]))
        return self._bodies.walk_at(draw_speeds(rng, self._people, speed))

    def _policies(self) -> list[str]:
        names = self._stream.policy
        if not names:
            return [""] * self._people
        return [names[i] for i in self._rng("policy").integers(len(names), size=self._people)]

    def _heading(self, start: Start) -> float:
        if start.heading is not None:
            return start.heading
        goals = [g for g in start.way.goals if g != start.at]
        return heading_to(*start.at, goals[0]) if goals else 0.0

    # ---------------------------------------------------------------------- places
    def _area(self, place: Place) -> Area:
        if isinstance(place, Area):
            return place
        zones, portals = self._environment.zones, self._environment.portals
        return Area.of(zones[place] if place in zones else portals[place])

    def _placed(
        self, area: Area, units: Sequence[int], occupancy: Occupancy
    ) -> Iterator[tuple[int, Point]]:
        """Places of the members of some groups, larger groups first, in an area."""
        placer = Placer(area, self._radius, 0.0, occupancy)
        for done, unit in enumerate(sorted(units, key=lambda g: -len(self._groups[g]))):
            if not placer.put_group(self._groups[unit], self._rng("place", unit)):
                raise InputError(
                    f"only {done} of {len(units)} who walk alone or in groups of stream "
                    f"'{self._name}' fit where they start"
                )
            for i in self._groups[unit]:
                yield i, (float(placer.places[i, 0]), float(placer.places[i, 1]))

    def _entering(self, area: Area, unit: int, occupancy: Occupancy) -> Iterator[tuple[int, Point]]:
        """Places of a group that enters later: clear of walls and of each other, of nobody else."""
        yield from self._placed(area, [unit], Occupancy([], occupancy.ground))

    def _check_entrance(self, area: Area, occupancy: Occupancy) -> None:
        """Refuse an area to come in at in which walls leave no room for the largest body."""
        radius = float(np.max(self._radius, initial=0.0))
        if not any(occupancy.ground.is_free(*at, radius) for at in places_in(area, radius)):
            raise InputError(
                f"nobody can come in at the origin of stream '{self._name}': walls leave no room "
                f"for a body of radius {radius:g} m around "
                f"({area.centre[0]:g}, {area.centre[1]:g})"
            )

    # ------------------------------------------------------------------------ ways
    @singledispatchmethod
    def _starts(self, stream: StreamChoice, occupancy: Occupancy) -> Iterator[tuple[int, Start]]:
        raise NotImplementedError(type(stream).__name__)

    @_starts.register
    def _through(self, stream: ThroughStream, occupancy: Occupancy) -> Iterator[tuple[int, Start]]:
        lanes, units = stream.lanes, range(len(self._groups))
        used = lanes.use if lanes is not None else (0,)
        lane = [used[u % len(used)] for u in units]
        for number in dict.fromkeys(lane):
            way = self._way_through(stream, number)
            if way.origin is not None:
                self._check_entrance(way.origin, occupancy)
            mine = [u for u in units if lane[u] == number]
            if not self._times:
                start = lane_of(self._area(stream.starts_in), lanes, number)
                for i, at in self._placed(start, mine, occupancy):
                    yield i, Start(at, way)
                continue
            origin = lane_of(self._area(stream.origin), lanes, number)
            for unit in mine:
                for i, at in self._entering(origin, unit, occupancy):
                    yield i, Start(at, way, self._times[unit])

    def _way_through(self, stream: ThroughStream, lane: int) -> Way:
        ends = [self._area(place) for place in (stream.origin, stream.destination)]
        origin, last = (lane_of(area, stream.lanes, lane) for area in ends)
        via = [self._area(place) for place in stream.via]
        choice = origin if stream.end == "return" or stream.arrivals else None
        return way_through([*via, last], _end(stream.end), origin=choice)

    @_starts.register
    def _directions(
        self, stream: DirectionsStream, occupancy: Occupancy
    ) -> Iterator[tuple[int, Start]]:
        area, floor = self._area(stream.area), self._environment.periodic_floor
        angles = stream.directions
        places = dict(self._placed(area, range(len(self._groups)), occupancy))
        for unit, members in enumerate(self._groups):
            rng = self._rng("direction", unit)
            common = (
                angles[int(rng.integers(len(angles)))] if angles else rng.uniform(-np.pi, np.pi)
            )
            for i in members:
                if floor is not None:
                    sides = floor.x[1] - floor.x[0], floor.y[1] - floor.y[0]
                    way = straight_on(places[i], float(common), min(sides))
                else:  # members of a group turn alike, each from where it is
                    turns = self._rng("turns", unit)
                    way = border_to_border(area, places[i], self._radius[i], angles, turns)
                yield i, Start(places[i], way)

    @_starts.register
    def _queue(self, stream: QueueStream, occupancy: Occupancy) -> Iterator[tuple[int, Start]]:
        spots, last = list(along(stream.line, stream.gap)), self._area(stream.destination)
        for i in range(self._people):
            before = spots[i::-1] if not self._times else spots[::-1]
            service = self._duration(stream.service, "service", i)
            stops = [(at, service if at == spots[0] else 0.0) for at in before]
            way = way_through([last], _end(stream.at_destination), before=stops)
            time = self._times[i] if self._times else 0.0
            ahead = spots[max(spots.index(before[0]) - 1, 0)]
            facing = heading_to(*before[0], ahead) if before[0] != spots[0] else None
            if not time:
                occupancy.add(*before[0], float(self._radius[i]))
            yield i, Start(before[0], way, time, facing)

    @_starts.register
    def _talking(self, stream: TalkingStream, occupancy: Occupancy) -> Iterator[tuple[int, Start]]:
        area, end = self._area(stream.area), _end(stream.at_destination)
        onward = [] if stream.destination is None else [self._area(stream.destination)]
        for unit, members in enumerate(self._groups):
            pause = self._duration(stream.duration, "duration", unit) if onward else 0.0
            centre, places = self._circle(area, members, unit, stream.gap, occupancy)
            for i, at in zip(members, places, strict=True):
                way = way_through(onward, end if onward else "stop", before=[(at, pause)])
                yield i, Start(at, way, heading=heading_to(*at, centre))

    def _circle(
        self, area: Area, members: range, unit: int, gap: float, occupancy: Occupancy
    ) -> tuple[Point, list[Point]]:
        """The middle of a circle on free floor, and the places around it."""
        rng, size = self._rng("place", unit), len(members)
        gap = max(gap, 2.0 * float(self._radius[members].max()))
        reach = 0.5 * gap / math.sin(math.pi / size) if size > 1 else 0.0
        margin = reach + float(self._radius[members].max())
        room = [max(0.0, 0.5 * side - margin) for side in area.size]
        for _ in range(ATTEMPTS):
            centre = area.point(*(float(w * (2.0 * rng.random() - 1.0)) for w in room))
            turn = 2.0 * math.pi * rng.random()
            angles = [turn + 2.0 * math.pi * k / size for k in range(size)]
            places = [
                (centre[0] + reach * math.cos(a), centre[1] + reach * math.sin(a)) for a in angles
            ]
            radii = [float(self._radius[i]) for i in members]
            if all(occupancy.is_free(*p, r) for p, r in zip(places, radii, strict=True)):
                for place, radius in zip(places, radii, strict=True):
                    occupancy.add(*place, radius)
                return centre, places
        raise InputError(
            f"only {unit} of {len(self._groups)} groups of stream '{self._name}' fit into its area"
        )

    @_starts.register
    def _wandering(
        self, stream: WanderingStream, occupancy: Occupancy
    ) -> Iterator[tuple[int, Start]]:
        area, units = self._area(stream.area), range(len(self._groups))
        if self._times:
            self._check_entrance(area, occupancy)
            entering = (self._entering(area, unit, occupancy) for unit in units)
            places = dict(pair for places in entering for pair in places)
        else:
            places = dict(self._placed(area, units, occupancy))
        for unit, members in enumerate(self._groups):
            rng = self._rng("visits", unit)
            names = stroll(self._crowd.goal_areas, stream.areas, stream.visits, rng)
            goals = [self._area(self._crowd.goal_areas[name].area) for name in names]
            way = way_through(goals, _end(stream.at_end), origin=area if self._times else None)
            way = replace(way, pauses=tuple(draw_one(rng, stream.pause) for _ in goals))
            for i in members:
                yield i, Start(places[i], way, self._times[unit] if self._times else 0.0)

    def _duration(self, sample: DurationSample, purpose: str, unit: int) -> float:
        return draw_one(self._rng(purpose, unit), sample)


def _end(word: StreamEnd | str) -> AtGoal:
    return _AT_GOAL[word]


__all__ = ["StreamSampler"]
