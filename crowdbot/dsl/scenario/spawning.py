"""People of a crowd beside its flow and streams: spawns, goal areas, explicit agents.

`crowdbot.core.population.realise` samples everything once from these specs.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from annotated_types import Ge, Le, Lt, MinLen
from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from crowdbot.dsl.scenario.people_kinds import AppearanceName
from crowdbot.dsl.spec.areas import Place
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.parameters import (
    AccelerationSample,
    DurationSample,
    LengthSample,
    MassSample,
    SpeedChoice,
    SpeedSample,
)
from crowdbot.dsl.spec.quantities import (
    Angle,
    Length,
    NonNegativeDuration,
    PositiveAcceleration,
    PositiveDensity,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
)
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.spec.unions import AnyOf

#: An agent's behaviour at the end of its route.
RouteEnd = Literal["stop", "remove", "loop"]
#: More people are a mistake, and would take hours to place.
MAX_PEOPLE = 100_000

#: Least distance of people from a robot's start, centre to centre, m.
CLEAR_OF_ROBOT = 1.0

Count = Annotated[int, Ge(1), Le(MAX_PEOPLE)]
Point = Annotated[tuple[Length, Length], Field(strict=False)]


def _heading_tag(value: Any) -> str:
    word = isinstance(value, str) and value.lstrip("+-. ")[:1].isalpha()
    return "<word>" if word else "<angle>"


#: An angle, or a rule to determine it.
Heading = Annotated[
    Annotated[Literal["goal", "random"], Tag("<word>")] | Annotated[Angle, Tag("<angle>")],
    Discriminator(_heading_tag),
    AnyOf(),
]


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


#: One name or several.
Names = Annotated[
    tuple[str, ...],
    BeforeValidator(_as_list, json_schema_input_type=str | tuple[str, ...]),
]


class GroupSize(Spec):
    """A size of group, and how frequent it is."""

    size: Annotated[int, Ge(1), Le(1000)] = Field(description="People in a group; 1: alone.")
    frequency: Annotated[float, Ge(0)] = Field(
        description="Share of the groups that have this size, on any scale."
    )


class Goals(Spec):
    """The route of people: points in goal areas, sampled once per group or single person."""

    areas: Annotated[tuple[str, ...], MinLen(1)] = Field(
        strict=False, description="Names of goal areas; of a `linked` walk, where it may begin."
    )
    order: Literal["fixed", "random", "linked"] = default(
        "fixed",
        "fixed: the areas in turn; random: any of them each time; linked: a random "
        "walk on the areas' `next` that turns straight back only where nothing else follows.",
    )
    count: Annotated[int, Ge(1), Le(1000)] | None = default(
        None, "Points of the route; without it as many as areas."
    )
    at_goal: RouteEnd = default(
        "stop",
        "At the end: stand still, leave the world, or begin again; a `linked` loop "
        "first walks back the way it came.",
    )

    @property
    def length(self) -> int:
        """Return the number of points of a route; the way back of a loop is not counted."""
        return len(self.areas) if self.count is None else self.count


class Spawn(Spec):
    """People who start in one area; missing fields are as in the crowd."""

    area: Place = Field(description="Name of a zone, or an area written here; bodies lie inside.")
    count: Count | None = default(None, "How many; this or `density`.")
    density: PositiveDensity | None = default(None, "People per area, 1/m^2; this or `count`.")
    spacing: PositiveLength | None = default(
        None,
        "Least distance between the centres of two of them, m; without it, and never "
        "less than, both radii.",
    )
    heading: Heading = default(
        "goal", "At the start: an angle, to the first `goal`, or `random`; rad."
    )
    groups: tuple[GroupSize, ...] = default(
        (), "Sizes of groups; without it everyone is alone.", strict=False
    )
    goals: Goals | None = default(None, "A route; this, `portals` or `standing: true`.")
    portals: tuple[str, str] | None = default(
        None, "A stream: from the first portal to the second.", strict=False
    )
    standing: bool = default(False, "Whether they stay where they are.")
    speed: SpeedChoice | None = default(None, "Preferred speed, m/s.")
    radius: LengthSample | None = default(None, "Radius of the disc, m.")
    mass: MassSample | None = default(None, "Mass in the physics, kg.")
    max_speed: SpeedSample | None = default(None, "Largest walking speed, m/s.")
    max_acceleration: AccelerationSample | None = default(
        None, "Largest acceleration that people choose, m/s^2; pushes may exceed it."
    )
    start_time: DurationSample = default(
        DurationSample(value=0.0), "When each enters the world, s."
    )
    policy: Names = default(
        (),
        "Names in `crowd.policies`, one of which each draws; without it the crowd's.",
        strict=False,
    )

    @model_validator(mode="after")
    def _one_of_each(self) -> Spawn:
        if (self.count is None) == (self.density is None):
            raise ValueError("write one of 'count' and 'density'")
        return self

    def people(self, floor: float) -> float:
        """Return the number of people in an area of ``floor`` m^2; may not be whole."""
        return float(self.count) if self.count else (self.density or 0.0) * floor

    def least_radius(self, usual: float) -> float:
        """Return the smallest radius that a person of this spawn can have, m."""
        return self.radius.value - self.radius.spread if self.radius else usual

    @property
    def routes(self) -> tuple[str, ...]:
        """Return the given fields that define routes; a valid spawn has exactly one."""
        fields = {"goals": self.goals, "portals": self.portals, "standing": self.standing}
        return tuple(name for name, value in fields.items() if value)

    @property
    def at_goal(self) -> Literal["stop", "remove", "loop", "portal"]:
        """Return what people do at the end of their route."""
        if self.portals:
            return "portal"
        return "stop" if self.goals is None else self.goals.at_goal

    def goal_area_names(self) -> Iterator[tuple[tuple[str | int, ...], str]]:
        """Yield the field and the name of each goal area that the spawn uses."""
        areas = self.goals.areas if self.goals else ()
        return ((("goals", "areas", i), name) for i, name in enumerate(areas))


class Agent(Spec):
    """One explicit agent; missing fields are as in the crowd."""

    id: Annotated[int, Ge(0), Le(2**31 - 1)] = Field(
        description="Number of this agent; no other has it."
    )
    x: Length = Field(description="Start, m.")
    y: Length = Field(description="Start, m.")
    heading: Angle | None = default(None, "At the start, rad; without it to the first goal.")
    speed: PositiveSpeed | None = default(
        None, "Preferred speed, m/s; without it drawn from the crowd's."
    )
    radius: PositiveLength | None = default(None, "Radius of the disc, m.")
    mass: PositiveMass | None = default(None, "Mass in the physics, kg.")
    max_speed: PositiveSpeed | None = default(None, "Largest speed, m/s.")
    max_acceleration: PositiveAcceleration | None = default(
        None, "Largest acceleration by own will, m/s^2."
    )
    start_time: NonNegativeDuration = default(0.0, "When it enters the world, s.")
    group: Annotated[int, Ge(-1), Le(2**31 - 1)] = default(
        -1, "Equal numbers belong together; -1: alone."
    )
    policy: str = default("", "Name in `crowd.policies`; without it the crowd's own.")
    attention: Annotated[float, Ge(0), Lt(1)] | None = default(
        None,
        "How attentive it is compared with others: the least attentive ignore robots, "
        "the next notice them late, see `robot_response`; without it drawn.",
    )
    goals: tuple[Point, ...] = default(
        (), "Points of its route, m; these or `portals`.", strict=False
    )
    at_goal: RouteEnd | None = default(None, "At the end of the route; without it `stop`.")
    portals: tuple[str, str] | None = default(
        None, "A stream: from the first portal to the second.", strict=False
    )
    pauses: tuple[NonNegativeDuration, ...] = default(
        (), "How long it stays at each goal, s; without it nowhere.", strict=False, omitted=True
    )
    look: AppearanceName | None = default(
        None,
        "What sensors see; its usual radius, mass and height where none is given.",
        omitted=True,
    )
    height: PositiveLength | None = default(None, "Height, m.", omitted=True)

    @model_validator(mode="after")
    def _a_pause_for_each_goal(self) -> Agent:
        if len(self.pauses) not in (0, len(self.goals)):
            raise ValueError(f"write a pause for each of the {len(self.goals)} goals")
        return self

    @model_validator(mode="after")
    def _portals_have_no_end(self) -> Agent:
        if self.portals and self.at_goal:
            raise ValueError(
                "people who walk through portals leave at their goal: leave out 'at_goal'"
            )
        return self


class AgentsFile(Spec):
    """Explicit agents in a table whose columns are the fields of an agent."""

    csv: str = Field(description="Path, relative to the file that contains it.")


def _rows(value: Any) -> Any:
    if isinstance(value, dict) and "csv" in value:
        raise ValueError("a CSV is read where a file names it, as 'crowd.agents: {csv: FILE}'")
    return value


#: Rows; documents may name a CSV instead, which `crowdbot.dsl.suite.include` replaces by rows.
Agents = Annotated[
    tuple[Agent, ...],
    BeforeValidator(_rows, json_schema_input_type=tuple[Agent, ...] | AgentsFile),
]
