"""Streams: named flows of people, each with its own density or arrivals, ways, speeds and bodies.

Everything is drawn once by `crowdbot.core.population.realise`; these are its specs.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import Field, model_validator

from crowdbot.dsl.scenario.spawning import Count, GroupSize, Names, Point
from crowdbot.dsl.spec.areas import Place
from crowdbot.dsl.spec.outlines import along
from crowdbot.dsl.spec.parameters import DurationSample, SpeedChoice
from crowdbot.dsl.spec.quantities import (
    Angle,
    NonNegativeDuration,
    PositiveAcceleration,
    PositiveDensity,
    PositiveDuration,
    PositiveFrequency,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
)
from crowdbot.dsl.spec.spec import Spec

#: What people of a stream do at its end.
StreamEnd = Literal["return", "leave", "stop"]


class Arrivals(Spec):
    """When people enter: at random (`rate`), in a steady beat (`every`), or at given `times`.

    Groups arrive together: what arrives is a group, or one who is alone.
    """

    rate: PositiveFrequency | None = Field(
        default=None, description="Poisson arrivals: mean number in a second, 1/s."
    )
    every: PositiveDuration | None = Field(
        default=None, description="Steady arrivals: time between two, s."
    )
    times: tuple[NonNegativeDuration, ...] = Field(
        default=(), strict=False, description="Scheduled arrivals, s; in any order."
    )
    begin: NonNegativeDuration = Field(
        default=0.0, description="With `rate` and `every`: nobody arrives before this time, s."
    )
    until: PositiveDuration | None = Field(
        default=None, description="With `rate` and `every`: nobody arrives from then on, s."
    )

    @model_validator(mode="after")
    def _one_pattern(self) -> Arrivals:
        given = [n for n in ("rate", "every", "times") if getattr(self, n)]
        if len(given) != 1:
            raise ValueError("write one of 'rate', 'every' and 'times'")
        if self.times and (self.until is not None or self.begin):
            raise ValueError("'begin' and 'until' belong to 'rate' and 'every'")
        if not self.times and (self.until is None or self.until <= self.begin):
            raise ValueError(f"'{given[0]}' needs an 'until' after 'begin'")
        return self


class StreamBody(Spec):
    """What the people of a stream have in common; what is left out is as in `crowd.body`."""

    radius: PositiveLength | None = Field(default=None, description="Radius of the disc, m.")
    mass: PositiveMass | None = Field(default=None, description="Mass in the physics, kg.")
    max_speed: PositiveSpeed | None = Field(default=None, description="Largest speed, m/s.")
    max_acceleration: PositiveAcceleration | None = Field(
        default=None,
        description="Largest acceleration that people choose, m/s^2; pushes may exceed it.",
    )


class Stream(Spec):
    """A stream of people, of the pattern that its `kind` names."""

    #: No kind is usual: each stream names its own.
    usual: ClassVar[str] = ""
    kind: str = Field(description="Pattern of the stream.")
    count: Count | None = Field(default=None, description="How many people there are.")
    speed: SpeedChoice | None = Field(
        default=None, description="Preferred speed, m/s; without it the crowd's."
    )
    body: StreamBody = Field(default=StreamBody(), description="What differs from `crowd.body`.")
    people: Names = Field(
        default=(),
        strict=False,
        description="Names in `crowd.people` that this stream is made of; without it all of them.",
    )
    policy: Names = Field(
        default=(),
        strict=False,
        description="Names in `crowd.policies`, one of which each draws; without it the crowd's.",
    )
    groups: tuple[GroupSize, ...] = Field(
        default=(), strict=False, description="Sizes of groups; without it everybody is alone."
    )


class Lanes(Spec):
    """Lanes of equal width beside each other, across an area's own y."""

    of: Annotated[int, Ge(1), Le(64)] = Field(description="How many lanes there are.")
    use: Annotated[tuple[Annotated[int, Ge(0)], ...], MinLen(1)] = Field(
        strict=False, description="Those that this stream walks in; 0 is at the smallest y."
    )

    @model_validator(mode="after")
    def _that_exist(self) -> Lanes:
        if max(self.use) >= self.of:
            raise ValueError(f"lane {max(self.use)} is not one of 0 to {self.of - 1}")
        return self


class _Populated(Stream):
    """A stream of people who are there from the start, or who arrive."""

    density: PositiveDensity | None = Field(
        default=None, description="People per area of where they start, 1/m^2."
    )
    arrivals: Arrivals | None = Field(default=None, description="When people enter.")

    @model_validator(mode="after")
    def _one_number(self) -> _Populated:
        if [self.count, self.density, self.arrivals].count(None) != 2:
            raise ValueError("write one of 'count', 'density' and 'arrivals'")
        return self


class ThroughStream(_Populated):
    """People who walk from one area to another: a flow in any direction, or out of a room.

    Two of them are a counterflow or a crossing at any angle.
    """

    kind: Literal["through"] = Field(default="through", description="Pattern of the stream.")
    origin: Place = Field(
        description="Where they come from: name of a zone or portal, or an area written here."
    )
    destination: Place = Field(description="Where they go: named or given likewise.")
    via: tuple[Place, ...] = Field(
        default=(), strict=False, description="What they pass on the way, in turn, such as doors."
    )
    start: Place | None = Field(
        default=None,
        description="Where those of `count` or `density` are at the start; without it the origin.",
    )
    lanes: Lanes | None = Field(
        default=None, description="Keep to lanes of origin, start and destination."
    )
    at_destination: StreamEnd | None = Field(
        default=None,
        description="return: come in again at the origin, so that their number stays the same; "
        "leave the world; stop there. By default people with arrivals leave, others return.",
    )

    @property
    def end(self) -> StreamEnd:
        """What they do at the destination."""
        return self.at_destination or ("leave" if self.arrivals else "return")

    @property
    def starts_in(self) -> Place:
        """Where they are at the start."""
        return self.start if self.start is not None and not self.arrivals else self.origin

    @model_validator(mode="after")
    def _start_of_those_present(self) -> ThroughStream:
        if self.arrivals and self.start is not None:
            raise ValueError("people who arrive start at the origin; leave 'start' out")
        return self


class DirectionsStream(Stream):
    """Two-dimensional flow: each person walks in a direction that is drawn.

    On a torus for ever; elsewhere to the border of the area, where each turns to a new direction.
    """

    kind: Literal["directions"] = Field(default="directions", description="Pattern of the stream.")
    area: Place = Field(description="Where they walk: name of a zone, or an area written here.")
    density: PositiveDensity | None = Field(
        default=None, description="People per area, 1/m^2; this or `count`."
    )
    directions: tuple[Angle, ...] = Field(
        default=(),
        strict=False,
        description="Directions to draw from, rad; without them any.",
    )

    @model_validator(mode="after")
    def _one_number(self) -> DirectionsStream:
        if (self.count is None) == (self.density is None):
            raise ValueError("write one of 'count' and 'density'")
        return self


class QueueStream(Stream):
    """People in a line, who move up, are served at its head one after the other, and go."""

    kind: Literal["queue"] = Field(default="queue", description="Pattern of the stream.")
    line: Annotated[tuple[Point, ...], MinLen(2)] = Field(
        strict=False, description="Where the line runs, from the counter backwards, m."
    )
    gap: PositiveLength = Field(
        default=0.9, description="Between the centres of two in the line, m."
    )
    service: DurationSample = Field(
        default=DurationSample(value=10.0, spread=5.0), description="How long each is served, s."
    )
    arrivals: Arrivals | None = Field(
        default=None, description="When people join its end; without it all stand there."
    )
    destination: Place = Field(description="Where they go when served; a zone, portal or area.")
    at_destination: Literal["leave", "stop"] = Field(
        default="leave", description="leave the world, or stop there."
    )

    @model_validator(mode="after")
    def _one_number(self) -> QueueStream:
        if (self.count is None) == (self.arrivals is None):
            raise ValueError("write one of 'count' and 'arrivals'")
        if self.groups:
            raise ValueError("a queue has no groups")
        return self

    def places(self) -> tuple[Point, ...]:
        """Where people stand at first, from the counter backwards, m; all there is room for."""
        return tuple(islice(along(self.line, self.gap), self.count))


class TalkingStream(Stream):
    """Groups who stand in circles and talk; with a destination they go there afterwards."""

    kind: Literal["talking"] = Field(default="talking", description="Pattern of the stream.")
    count: Count = Field(description="How many people there are.")
    area: Place = Field(description="Where they stand: name of a zone, or an area written here.")
    groups: Annotated[tuple[GroupSize, ...], MinLen(1)] = Field(
        strict=False, description="Sizes of the circles."
    )
    gap: PositiveLength = Field(
        default=0.9, description="Between the centres of neighbours in a circle, m."
    )
    duration: DurationSample = Field(
        default=DurationSample(value=0.0),
        description="With a destination: how long a group talks, s.",
    )
    destination: Place | None = Field(
        default=None, description="Where they go afterwards; without it they stay."
    )
    at_destination: Literal["leave", "stop"] = Field(
        default="leave", description="leave the world, or stop there."
    )


class WanderingStream(_Populated):
    """People who stroll from goal area to goal area, by chance, and linger there."""

    kind: Literal["wandering"] = Field(default="wandering", description="Pattern of the stream.")
    area: Place = Field(description="Where they start: name of a zone, or an area written here.")
    areas: Annotated[tuple[str, ...], MinLen(1)] = Field(
        strict=False, description="Names of goal areas; where they have `next`, that follows."
    )
    visits: Annotated[int, Gt(0), Le(1000)] = Field(
        default=12, description="Areas that each visits, then again from the first."
    )
    pause: DurationSample = Field(
        default=DurationSample(value=0.0), description="How long each lingers in an area, s."
    )
    at_end: Literal["again", "leave", "stop"] = Field(
        default="again", description="After the visits: begin again, leave the world, or stop."
    )


#: A stream of one of the patterns.
StreamChoice = Annotated[
    ThroughStream | DirectionsStream | QueueStream | TalkingStream | WanderingStream,
    Field(discriminator="kind"),
]


def places_of(stream: Stream) -> Iterator[tuple[tuple[str | int, ...], Place]]:
    """The places that a stream names, by field."""
    for field in ("origin", "start", "area", "destination"):
        place = getattr(stream, field, None)
        if place is not None:
            yield (field,), place
    if isinstance(stream, ThroughStream):
        for i, place in enumerate(stream.via):
            yield ("via", i), place


__all__ = [
    "Arrivals",
    "DirectionsStream",
    "Lanes",
    "QueueStream",
    "Stream",
    "StreamBody",
    "StreamChoice",
    "StreamEnd",
    "TalkingStream",
    "ThroughStream",
    "WanderingStream",
    "places_of",
]
