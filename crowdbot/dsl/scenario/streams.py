"""The kinds of streams: named flows of people, each with its own number, path, speeds and bodies.

Each kind implements `Stream`; `crowdbot.core.population.stream_starts` draws the starts of its
people.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import islice, pairwise
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import Field, model_validator

from crowdbot.dsl.scenario.spawning import Count, GroupSize, Point
from crowdbot.dsl.scenario.stream import (
    AreaOf,
    Arrivals,
    FieldPath,
    Misfit,
    PopulatedStream,
    Stream,
    StreamEnd,
)
from crowdbot.dsl.spec.areas import Area, Place
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.outlines import along
from crowdbot.dsl.spec.parameters import DurationSample
from crowdbot.dsl.spec.quantities import Angle, PositiveDensity, PositiveLength
from crowdbot.dsl.spec.spec import Spec

#: Size of the area that stands for a point, m.
_POINT = (0.01, 0.01)


class Lanes(Spec):
    """Lanes of equal width, side by side along the y axis of an area's frame."""

    of: Annotated[int, Ge(1), Le(64)] = Field(description="How many lanes there are.")
    use: Annotated[tuple[Annotated[int, Ge(0)], ...], MinLen(1)] = Field(
        strict=False, description="Those that this stream walks in; 0 is at the smallest y."
    )

    @model_validator(mode="after")
    def _that_exist(self) -> Lanes:
        if max(self.use) >= self.of:
            raise ValueError(f"lane {max(self.use)} is not one of 0 to {self.of - 1}")
        return self


class ThroughStream(PopulatedStream):
    """People who walk from one area to another: a flow in any direction, or out of a room.

    Two of them are a counterflow or a crossing at any angle.
    """

    begin_fields: ClassVar[tuple[str, ...]] = ("origin", "start")
    goal_fields: ClassVar[tuple[str, ...]] = ("destination",)
    kind: Literal["through"] = default("through", "Pattern of the stream.")
    origin: Place = Field(
        description="Where they come from: name of a zone or portal, or an area written here."
    )
    destination: Place = Field(description="Where they go: named or given likewise.")
    via: tuple[Place, ...] = default(
        (), "What they pass on the way, in turn, such as doors.", strict=False
    )
    start: Place | None = default(
        None, "Where those of `count` or `density` are at the start; without it the origin."
    )
    lanes: Lanes | None = default(None, "Keep to lanes of origin, start and destination.")
    at_destination: StreamEnd | None = default(
        None,
        "return: come in again at the origin, so that their number stays the same; "
        "leave the world; stop there. By default people with arrivals leave, others return.",
    )

    @property
    def end(self) -> StreamEnd:
        """Return what people do at the destination."""
        return self.at_destination or ("leave" if self.arrivals else "return")

    @property
    def starts_in(self) -> Place:
        """Return their area at the start."""
        return self.start if self.start is not None and not self.arrivals else self.origin

    def places(self) -> Iterator[tuple[FieldPath, Place]]:
        """Return all places that the stream names; intermediate ones come last."""
        yield from super().places()
        yield from self._between()

    def entrances(self) -> tuple[str, ...]:
        """Return `origin` and `start`, if given; only `start` if no one enters at `origin`."""
        comes_in = self.start is None or self.end == "return"
        return ("origin",) * comes_in + ("start",) * (self.start is not None)

    def onward(self) -> Iterator[tuple[FieldPath, Place]]:
        """Return the intermediate places, then the destination."""
        yield from self._between()
        yield from super().onward()

    def _between(self) -> Iterator[tuple[FieldPath, Place]]:
        return ((("via", i), place) for i, place in enumerate(self.via))

    def misfits(self, subject: str, radius: float, area_of: AreaOf) -> Iterator[Misfit]:
        """Yield an error for lanes that are narrower than people."""
        if self.lanes is None:
            return
        for place in (self.origin, self.starts_in, self.destination):
            area = area_of(place)
            width = area.size[1] / self.lanes.of if area else math.inf
            if width < 2.0 * radius:
                text = f"lanes of {width:.3g} m in {subject} for people {2 * radius:g} m wide"
                yield Misfit(("lanes",), text)
                return

    @model_validator(mode="after")
    def _start_of_those_present(self) -> ThroughStream:
        if self.arrivals and self.start is not None:
            raise ValueError("people who arrive start at the origin; leave 'start' out")
        return self


class DirectionsStream(Stream):
    """Two-dimensional flow: each person walks in a random direction.

    On a torus they walk forever; elsewhere to the border of the area, where each gets a new
    direction.
    """

    begin_fields: ClassVar[tuple[str, ...]] = ("area",)
    kind: Literal["directions"] = default("directions", "Pattern of the stream.")
    area: Place = Field(description="Where they walk: name of a zone, or an area written here.")
    density: PositiveDensity | None = default(None, "People per area, 1/m^2; this or `count`.")
    directions: tuple[Angle, ...] = default(
        (), "Directions to draw from, rad; without them any.", strict=False
    )

    @model_validator(mode="after")
    def _one_number(self) -> DirectionsStream:
        if (self.count is None) == (self.density is None):
            raise ValueError("write one of 'count' and 'density'")
        return self

    @property
    def people_per_area(self) -> float | None:
        """Return the density, 1/m^2, if the stream is given by a density; else None."""
        return self.density

    @property
    def starts_in(self) -> Place:
        """Return their area at the start."""
        return self.area


class QueueStream(Stream):
    """People in a line, who move up, are served at its head one by one, and leave."""

    goal_fields: ClassVar[tuple[str, ...]] = ("destination",)
    kind: Literal["queue"] = default("queue", "Pattern of the stream.")
    line: Annotated[tuple[Point, ...], MinLen(2)] = Field(
        strict=False, description="Where the line runs, from the counter backwards, m."
    )
    gap: PositiveLength = default(0.9, "Between the centres of two in the line, m.")
    service: DurationSample = default(
        DurationSample(value=10.0, spread=5.0), "How long each is served, s."
    )
    arrivals: Arrivals | None = default(
        None, "When people join its end; without it all stand there."
    )
    destination: Place = Field(description="Where they go when served; a zone, portal or area.")
    at_destination: Literal["leave", "stop"] = default("leave", "leave the world, or stop there.")

    @model_validator(mode="after")
    def _one_number(self) -> QueueStream:
        if (self.count is None) == (self.arrivals is None):
            raise ValueError("write one of 'count' and 'arrivals'")
        if self.groups:
            raise ValueError("people in a queue come one by one: leave out groups")
        return self

    @property
    def entering(self) -> Arrivals | None:
        """Return arrival times at the end of the line; None if all stand there from the start."""
        return self.arrivals

    def points(self) -> Iterator[tuple[FieldPath, tuple[Point, ...]]]:
        """Return the points of the line."""
        yield ("line",), self.line

    def spots(self) -> Iterator[tuple[FieldPath, tuple[Point, ...]]]:
        """Yield the positions in the line at the start, from the counter backwards, m."""
        yield ("line",), tuple(islice(along(self.line, self.gap), self.count))

    def chains(
        self, area_of: AreaOf, goal_areas: Mapping[str, Place]
    ) -> Iterator[list[tuple[FieldPath, Area | None]]]:
        """Return the path along the line to the counter, then to the destination."""
        del goal_areas
        line = [(("line", i), Area(centre=at, size=_POINT)) for i, at in enumerate(self.line)]
        yield [*reversed(line), *((field, area_of(place)) for field, place in self.onward())]

    def misfits(self, subject: str, radius: float, area_of: AreaOf) -> Iterator[Misfit]:
        """Yield an error if the line is too short for its people, or its gap too small for one."""
        del area_of
        length = sum(math.dist(a, b) for a, b in pairwise(self.line))
        room = math.floor(length / self.gap + 1e-9) + 1
        if self.count is not None and self.count > room:
            text = f"{self.count} people of {subject} cannot stand on its {length:g} m"
            hint = f"with a gap of {self.gap:g} m there is room for {room}"
            yield Misfit(("count",), text, hint)
        if self.gap < 2.0 * radius:
            text = f"{self.gap:g} m between people of {subject} who are {2 * radius:g} m wide"
            yield Misfit(("gap",), text)


class TalkingStream(Stream):
    """Groups who stand in circles and talk; with a destination they go there afterwards."""

    begin_fields: ClassVar[tuple[str, ...]] = ("area",)
    goal_fields: ClassVar[tuple[str, ...]] = ("destination",)
    kind: Literal["talking"] = default("talking", "Pattern of the stream.")
    count: Count = Field(description="How many people there are.")
    area: Place = Field(description="Where they stand: name of a zone, or an area written here.")
    groups: Annotated[tuple[GroupSize, ...], MinLen(1)] = Field(
        strict=False, description="Sizes of the circles."
    )
    gap: PositiveLength = default(0.9, "Between the centres of neighbours in a circle, m.")
    duration: DurationSample = default(
        DurationSample(value=0.0), "With a destination: how long a group talks, s."
    )
    destination: Place | None = default(None, "Where they go afterwards; without it they stay.")
    at_destination: Literal["leave", "stop"] = default("leave", "leave the world, or stop there.")

    @property
    def starts_in(self) -> Place:
        """Return the area in which they stand."""
        return self.area


class WanderingStream(PopulatedStream):
    """People who stroll between goal areas at random, and stay there for a while."""

    begin_fields: ClassVar[tuple[str, ...]] = ("area",)
    kind: Literal["wandering"] = default("wandering", "Pattern of the stream.")
    area: Place = Field(description="Where they start: name of a zone, or an area written here.")
    areas: Annotated[tuple[str, ...], MinLen(1)] = Field(
        strict=False, description="Names of goal areas; where they have `next`, that follows."
    )
    visits: Annotated[int, Gt(0), Le(1000)] = default(
        12, "Areas that each visits, then again from the first."
    )
    pause: DurationSample = default(
        DurationSample(value=0.0), "How long each lingers in an area, s."
    )
    at_end: Literal["again", "leave", "stop"] = default(
        "again", "After the visits: begin again, leave the world, or stop."
    )

    @property
    def starts_in(self) -> Place:
        """Return the area where people start."""
        return self.area

    def goal_area_names(self) -> Iterator[tuple[FieldPath, str]]:
        """Return the areas that they stroll to."""
        return ((("areas", i), name) for i, name in enumerate(self.areas))

    def chains(
        self, area_of: AreaOf, goal_areas: Mapping[str, Place]
    ) -> Iterator[list[tuple[FieldPath, Area | None]]]:
        """Return the paths from their start to each of the areas."""
        for field, name in self.goal_area_names():
            goal = area_of(goal_areas[name]) if name in goal_areas else None
            yield [(("area",), area_of(self.area)), (field, goal)]


#: A stream with one of the patterns.
StreamChoice = Annotated[
    ThroughStream | DirectionsStream | QueueStream | TalkingStream | WanderingStream,
    Field(discriminator="kind"),
]
