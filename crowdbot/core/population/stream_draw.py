"""StreamDraw: random numbers of one stream of people, and draws shared by all kinds of streams.

Each purpose has its own random stream, named after the stream of people. Route, start and arrival
of a group have an additional one for each group, the body of a person one for each person.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from crowdbot.core.population.arrivals import arrival_times
from crowdbot.core.population.bodies import Bodies, draw_bodies
from crowdbot.core.population.draws import Streams, draw_groups, draw_one
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import Placer
from crowdbot.core.types.arrays import Point
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.streams import StreamChoice
from crowdbot.dsl.spec.areas import Area, Place, places_in
from crowdbot.dsl.spec.parameters import DurationSample
from crowdbot.errors import InputError


class StreamDraw:
    """Groups, arrivals and bodies of one stream, and free places for its people.

    Attributes:
        name: of the stream.
        crowd, environment: those of the scenario.
        times: when each group enters, s; empty where all are there from the start.
        groups: numbers of the members of each group.
        people: how many there are.
        bodies, radius: theirs, m.
    """

    def __init__(
        self, name: str, stream: StreamChoice, scenario: Scenario, crowd: Crowd, streams: Streams
    ) -> None:
        self.name, self.crowd, self.environment = name, crowd, scenario.environment
        self._stream, self._streams = stream, streams
        self.times: list[float] = []
        arrivals = stream.entering
        if arrivals is not None:
            self.times = arrival_times(arrivals, self.rng("arrivals"))
        sizes, count = stream.groups, None if arrivals is not None else self._count()
        self.groups = draw_groups(sizes, self.rng("groups"), count, len(self.times))
        self.people = self.groups[-1].stop if self.groups else 0
        self.bodies = self._draw_bodies()
        self.radius = self.bodies.radius

    def rng(self, purpose: str, unit: int | None = None) -> np.random.Generator:
        """Return one of this stream's random streams, or that of one of its groups or people."""
        return self._streams.rng(f"crowd.streams.{purpose}.{self.name}", unit)

    def _count(self) -> int:
        stream = self._stream
        if stream.count is not None:
            return stream.count
        assert stream.starts_in is not None  # a density is that of an area
        sides = self.area(stream.starts_in).size
        return round((stream.people_per_area or 0.0) * sides[0] * sides[1])

    def _draw_bodies(self) -> Bodies:
        stream, body = self._stream, self.crowd.body
        radius = np.full(self.people, stream.body.radius or body.radius)
        mass = np.full(self.people, stream.body.mass or body.mass)
        fixed = stream.body.radius is not None, stream.body.mass is not None
        return draw_bodies(self.crowd.people, stream.people, (radius, mass), self.rng, fixed=fixed)

    def area(self, place: Place) -> Area:
        """Return the area of a place: its own, a zone's or a portal's."""
        if isinstance(place, Area):
            return place
        zones, portals = self.environment.zones, self.environment.portals
        return Area.of(zones[place] if place in zones else portals[place])

    def placed(
        self, area: Area, units: Sequence[int], occupancy: Occupancy
    ) -> Iterator[tuple[int, Point]]:
        """Return positions in an area for the members of some groups, larger groups first."""
        placer = Placer(area, self.radius, 0.0, occupancy)
        for done, unit in enumerate(sorted(units, key=lambda g: -len(self.groups[g]))):
            if not placer.put_group(self.groups[unit], self.rng("place", unit)):
                raise InputError(
                    f"only {done} of {len(units)} who walk alone or in groups of stream "
                    f"'{self.name}' fit where they start"
                )
            for i in self.groups[unit]:
                yield i, (float(placer.places[i, 0]), float(placer.places[i, 1]))

    def entering(self, area: Area, unit: int, occupancy: Occupancy) -> Iterator[tuple[int, Point]]:
        """Return positions for a group that enters later: clear only of walls and each other."""
        yield from self.placed(area, [unit], Occupancy([], occupancy.ground))

    def check_entrance(self, area: Area, occupancy: Occupancy) -> None:
        """Raise an error if walls leave no room for the largest body in an entrance area."""
        radius = float(np.max(self.radius, initial=0.0))
        if not any(occupancy.ground.is_free(*at, radius) for at in places_in(area, radius)):
            raise InputError(
                f"people cannot come in at the origin of stream '{self.name}': walls leave no room "
                f"for a body of radius {radius:g} m around "
                f"({area.centre[0]:g}, {area.centre[1]:g})"
            )

    def duration(self, sample: DurationSample, purpose: str, unit: int) -> float:
        """Draw a duration of a group or person, s."""
        return draw_one(self.rng(purpose, unit), sample)
