"""Stream: fields and interface of all kinds of streams of people.

`crowdbot.dsl.scenario.streams` has the kinds. Checks, pictures and the sampling of people use only
this interface: positions, paths and contradictions. `crowdbot.core.population.stream_starts` draws
the starts of people for each kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import ClassVar, Literal, NamedTuple

from pydantic import Field, model_validator

from crowdbot.dsl.scenario.spawning import Count, GroupSize, Names, Point
from crowdbot.dsl.spec.areas import Area, Place
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.parameters import SpeedChoice
from crowdbot.dsl.spec.quantities import (
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

#: A field of a stream, perhaps with the place in its list.
FieldPath = tuple[str | int, ...]
#: Finds the area of a place; None for a name that does not exist.
AreaOf = Callable[[Place], Area | None]
#: Behaviour of people at the end of a stream.
StreamEnd = Literal["return", "leave", "stop"]


class Arrivals(Spec):
    """Times at which people enter: random (`rate`), regular (`every`), or given (`times`).

    Groups arrive together: an arrival is a group or a single person.
    """

    rate: PositiveFrequency | None = default(
        None, "Poisson arrivals: mean number in a second, 1/s."
    )
    every: PositiveDuration | None = default(None, "Steady arrivals: time between two, s.")
    times: tuple[NonNegativeDuration, ...] = default(
        (), "Scheduled arrivals, s; in any order.", strict=False
    )
    begin: NonNegativeDuration = default(
        0.0, "With `rate` and `every`: no one arrives before this time, s."
    )
    until: PositiveDuration | None = default(
        None, "With `rate` and `every`: no one arrives from then on, s."
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
    """Properties shared by people of a stream; missing ones are as in `crowd.body`."""

    radius: PositiveLength | None = default(None, "Radius of the disc, m.")
    mass: PositiveMass | None = default(None, "Mass in the physics, kg.")
    max_speed: PositiveSpeed | None = default(None, "Largest speed, m/s.")
    max_acceleration: PositiveAcceleration | None = default(
        None, "Largest acceleration that people choose, m/s^2; pushes may exceed it."
    )


class Stream(Spec):
    """A stream of people, with the pattern named by `kind`."""

    #: No kind is usual: each stream names its own.
    usual: ClassVar[str] = ""
    kind: str = Field(description="Pattern of the stream.")
    count: Count | None = default(None, "How many people there are.")
    speed: SpeedChoice | None = default(None, "Preferred speed, m/s; without it the crowd's.")
    body: StreamBody = default(StreamBody(), "What differs from `crowd.body`.")
    people: Names = default(
        (),
        "Names in `crowd.people` that this stream is made of; without it all of them.",
        strict=False,
    )
    policy: Names = default(
        (),
        "Names in `crowd.policies`, one of which each draws; without it the crowd's.",
        strict=False,
    )
    groups: tuple[GroupSize, ...] = default(
        (), "Sizes of groups; without it everyone is alone.", strict=False
    )

    #: Fields with places where people begin, and with places where they go.
    begin_fields: ClassVar[tuple[str, ...]] = ()
    goal_fields: ClassVar[tuple[str, ...]] = ()

    # ------------------------------------------------------------------- how many
    @property
    def people_per_area(self) -> float | None:
        """Return the density, 1/m^2, if the stream is given by a density; else None."""
        return None

    @property
    def entering(self) -> Arrivals | None:
        """Return the arrival times of people; None if all are present from the start."""
        return None

    @property
    def starts_in(self) -> Place | None:
        """Return the area that people fill at the start; None if the stream has no such area."""
        return None

    # --------------------------------------------------------------------- places
    def places(self) -> Iterator[tuple[FieldPath, Place]]:
        """Return all places that the stream names, by field."""
        for field in (*self.begin_fields, *self.goal_fields):
            place = getattr(self, field)
            if place is not None:
                yield (field,), place

    def goal_area_names(self) -> Iterator[tuple[FieldPath, str]]:
        """Return all names in `crowd.goal_areas` that the stream uses, by field."""
        return iter(())

    def points(self) -> Iterator[tuple[FieldPath, tuple[Point, ...]]]:
        """Return all points that the stream names, m, by field."""
        return iter(())

    def spots(self) -> Iterator[tuple[FieldPath, tuple[Point, ...]]]:
        """Return the positions of people at the start, m, by the field that gives them."""
        return iter(())

    # ------------------------------------------------------------------------ way
    def entrances(self) -> tuple[str, ...]:
        """Return the fields with the areas in which people start or enter."""
        return self.begin_fields

    def onward(self) -> Iterator[tuple[FieldPath, Place]]:
        """Return the places that people visit after entering, in order."""
        for field in self.goal_fields:
            place = getattr(self, field)
            if place is not None:
                yield (field,), place

    def chains(
        self, area_of: AreaOf, goal_areas: Mapping[str, Place]
    ) -> Iterator[list[tuple[FieldPath, Area | None]]]:
        """Yield each route as (field, area) in the order of visits; None for a missing area.

        Args:
            goal_areas: name -> place of all goal areas of the crowd.
        """
        del goal_areas
        rest = [(field, area_of(place)) for field, place in self.onward()]
        for field in self.entrances():
            yield [((field,), area_of(getattr(self, field))), *rest]

    def legs(
        self, area_of: AreaOf, goal_areas: Mapping[str, Place]
    ) -> Iterator[tuple[Area, Area, FieldPath]]:
        """Yield start area and goal area of each leg, and the field that names the goal area."""
        for chain in self.chains(area_of, goal_areas):
            known = [(path, area) for path, area in chain if area is not None]
            for (_, start), (path, goal) in pairwise(known):
                yield start, goal, path

    # --------------------------------------------------------------------- checks
    def misfits(self, subject: str, radius: float, area_of: AreaOf) -> Iterator[Misfit]:
        """Yield contradictions between fields that are valid one by one.

        Args:
            subject: name of the stream in messages.
            radius: radius of its people, m.
        """
        del subject, radius, area_of
        return iter(())


class Misfit(NamedTuple):
    """People who do not fit in a place of a stream: field, error and hint."""

    field: FieldPath
    text: str
    hint: str = ""


class PopulatedStream(Stream):
    """A stream of people who are present from the start, or who arrive."""

    density: PositiveDensity | None = default(None, "People per area of where they start, 1/m^2.")
    arrivals: Arrivals | None = default(None, "When people enter.")

    @property
    def people_per_area(self) -> float | None:
        """Return the density, 1/m^2, if the stream is given by a density; else None."""
        return self.density

    @property
    def entering(self) -> Arrivals | None:
        """Return the arrival times of people; None if all are present from the start."""
        return self.arrivals

    @model_validator(mode="after")
    def _one_number(self) -> PopulatedStream:
        if [self.count, self.density, self.arrivals].count(None) != 2:
            raise ValueError("write one of 'count', 'density' and 'arrivals'")
        return self
