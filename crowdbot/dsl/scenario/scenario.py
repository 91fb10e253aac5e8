"""Scenario: the complete explicit environment of a robot, without a planner.

The classes here are typed with abstract component specs. `crowdbot.core.registry.registry` narrows
them to the installed components; the base classes refuse to validate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import (
    BeforeValidator,
    Field,
    PrivateAttr,
    SerializeAsAny,
    ValidationInfo,
    field_validator,
    model_validator,
)

from crowdbot.dsl.scenario.group_forces import GroupForces
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.scenario.people_kinds import PeopleKind
from crowdbot.dsl.scenario.person_goals import (
    AccompanyGoal,
    ApproachGoal,
    FollowGoal,
    LeadGoal,
    PersonGoal,
    TaskGoal,
)
from crowdbot.dsl.scenario.robot_response import HumanResponse, RobotResponseChoice
from crowdbot.dsl.scenario.routing import RoutingChoice
from crowdbot.dsl.scenario.spawning import Agents, RouteEnd, Spawn
from crowdbot.dsl.scenario.steering import SteeringSpec
from crowdbot.dsl.scenario.streams import StreamChoice
from crowdbot.dsl.spec.areas import GoalArea
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.body_regions import BodyRegion
from crowdbot.dsl.spec.component_specs import (
    CostFunctionSpec,
    CrowdPolicySpec,
    EnvironmentSpec,
    RobotSpec,
    SensorSpec,
)
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.parameters import SpeedDistribution
from crowdbot.dsl.spec.quantities import (
    Angle,
    Length,
    NonNegativeDamping,
    PositiveAcceleration,
    PositiveDensity,
    PositiveDuration,
    PositiveFrequency,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    PositiveStiffness,
)
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.text.path_names import PathName

#: An agent's behaviour at the end of its route. For streams: enter again at its origin, or walk on
#: in its direction forever.
AtGoal = Literal["portal", RouteEnd, "return", "onward"]


class CrowdSeed(Spec):
    """The seed of the crowd's random numbers; equal seeds sample equal people."""

    root: Annotated[int, Ge(0), Le(2**63 - 1)] = default(0, "Root seed.")
    key: str = default("", "Draw within the root: labels of the seed axes.")


class Flow(Spec):
    """A stream of people from one portal to another, or two opposite ones."""

    direction: Literal["in", "counter", "both"] = Field(
        description="in: from the first portal to the second; counter: the other way; both: every "
        "second person the other way."
    )
    portals: tuple[str, str] = default(("a", "b"), "Names of the two portals.", strict=False)
    density: PositiveDensity = Field(description="People per area of the start zone, 1/m^2.")
    area: str = Field(description="Zone in which people start.")


class Body(Spec):
    """Properties shared by all agents of the crowd."""

    radius: PositiveLength = default(0.33, "Radius of the disc, m.")
    avoided_radius: PositiveLength | None = default(
        None,
        "Radius of the disc that policies and steering parts keep clear of, m; by "
        "default `radius`, which is what touches.",
        omitted=True,
    )
    mass: PositiveMass = default(75.0, "Mass in the physics, kg.")
    max_speed: PositiveSpeed = default(3.0, "Largest walking speed, m/s.")
    max_acceleration: PositiveAcceleration = default(
        5.0, "Largest acceleration that people choose, m/s^2; pushes may exceed it."
    )
    height: PositiveLength = default(1.7, "Height, m.")
    figures: dict[str, Asset] = default(
        {},
        "Named meshes (glTF) of people for colour images, which people have in turn. "
        "Lidars, depth cameras and contacts do not see them.",
        omitted=True,
    )


class NamedPolicy(Spec):
    """A policy for some agents, in place of the crowd's own."""

    policy: SerializeAsAny[CrowdPolicySpec]
    costs: dict[str, SerializeAsAny[CostFunctionSpec]] = default(
        {}, "Named cost functions of a velocity-space policy."
    )


class Crowd(Spec):
    """The people, their paths and their decisions: a flow, streams, spawns, agents.

    Fields added after the first locks are outside the hash while they have their default.
    """

    flow: Flow | None = None
    streams: dict[str, StreamChoice] = default({}, "Named streams of people.", omitted=True)
    spawns: dict[str, Spawn] = default({}, "Named spawns.")
    goal_areas: dict[str, GoalArea] = default({}, "Named areas of goals.")
    agents: Agents = default((), "Explicit agents: rows, or `{csv: FILE}`.", strict=False)
    speed: SpeedDistribution | None = default(
        None, "Preferred speeds of all who have none of their own."
    )
    body: Body = default(Body(), "Common to all agents.")
    people: dict[str, PeopleKind] = default(
        {},
        "Named kinds of people that the crowd is a mixture of; without it all are alike.",
        omitted=True,
    )
    groups: GroupForces | None = default(
        GroupForces(), "What holds groups together; null: nothing.", omitted=True
    )
    policy: SerializeAsAny[CrowdPolicySpec]
    costs: dict[str, SerializeAsAny[CostFunctionSpec]] = default(
        {}, "Named cost functions of a velocity-space policy."
    )
    policies: dict[str, NamedPolicy] = default(
        {}, "Named policies for spawns and agents that follow another one."
    )
    solids: Literal["soft", "firm"] = default(
        "soft",
        "firm: no body overlaps a wall, a block or a pillar by more than 2 cm, however "
        "hard others push; soft: people are pushed out, and only their centres never come in.",
        omitted=True,
    )
    contact_dissipation: NonNegativeDamping = default(
        0.0,
        "How much stiffer contact among people and with walls is while it closes, "
        "s/m: people part at most at its inverse. 0: they bounce off like springs.",
        omitted=True,
    )
    exit_point: Literal["random", "offset"] = default(
        "random",
        "Where people come out of a portal: anywhere in it, or opposite to where they went in.",
    )
    goal_point: Literal["random", "ahead"] = default(
        "random",
        "Where in a portal people go on each trip: anywhere, so that ways cross, or "
        "straight ahead of where they come in or start.",
        omitted=True,
    )
    robot_response: RobotResponseChoice = default(
        HumanResponse(), "How people respond to the robot."
    )
    routing: RoutingChoice | None = default(
        None, "How people find their way; without it `straight` to their goals.", omitted=True
    )
    steering: SteeringSpec | None = default(
        None, "Beside any policy: time gap, personal space, lanes, walls, wander.", omitted=True
    )
    seed: CrowdSeed = default(CrowdSeed(), "Draws the crowd.")

    @property
    def names_nobody(self) -> bool:
        """Return True if there is neither a flow, nor a stream, a spawn, or an explicit agent."""
        return self.flow is None and not (self.streams or self.spawns or self.agents)


class Goal(TaskGoal):
    """The zone that the robot's centre has to reach."""

    kind: Literal["zone"] = default(
        "zone", "A place; other kinds of goals are people.", omitted=True
    )
    zone: str = Field(description="Name of the goal zone.")


def _zone_unless_given(value: Any) -> Any:
    """Return a goal whose default kind is written out."""
    return {"kind": TaskGoal.usual, **value} if isinstance(value, dict) else value


#: A zone, or a person with what to do.
GoalChoice = Annotated[
    Annotated[
        Goal | ApproachGoal | FollowGoal | AccompanyGoal | LeadGoal, Field(discriminator="kind")
    ],
    BeforeValidator(_zone_unless_given),
]


class TaskSpec(Spec):
    """The robot's task."""

    start: tuple[Length, Length, Angle] = Field(
        strict=False, description="x, y (m) and heading (rad) at t = 0, world frame."
    )
    goal: GoalChoice = Field(description="A zone to reach, or a person to be with.")
    time_limit: PositiveDuration = default(180.0, "The run ends here, s.")
    when_ended: Literal["stay", "leave"] = default(
        "stay",
        "Of one robot among several that has arrived, failed or run out of time: it "
        "stays where it is, as an obstacle, or leaves.",
        omitted=True,
    )

    @property
    def zone(self) -> str | None:
        """Return the name of the zone in which the task ends; None if a person alone decides."""
        return self.goal.zone if isinstance(self.goal, Goal | LeadGoal) else None

    @property
    def person(self) -> PersonGoal | None:
        """Return the goal if it is a person."""
        return self.goal if isinstance(self.goal, PersonGoal) else None


class Robot(Spec):
    """One robot with its sensors and its task."""

    model: SerializeAsAny[RobotSpec]
    control: Literal["kinematic", "force", "differential_drive"] = Field(
        default="differential_drive",
        validate_default=False,  # a mismatch is replaced
        description="How commands become motion. Default of a holonomic robot: force.",
    )
    sensors: dict[str, SerializeAsAny[SensorSpec]] = default({}, "Named sensors.")
    task: TaskSpec

    @field_validator("control")
    @classmethod
    def _fits_the_drive(cls, value: str, info: ValidationInfo) -> str:
        model = info.data.get("model")
        if model is not None and value not in model.controls:
            raise ValueError(f"does not fit {model.kind}; what does: {', '.join(model.controls)}")
        return value

    @model_validator(mode="after")
    def _default_that_fits(self) -> Robot:
        if "control" not in self.model_fields_set:
            object.__setattr__(self, "control", self.model.controls[0])
        return self

    @model_validator(mode="after")
    def _sensors_on_the_robot(self) -> Robot:
        """Fill what the sensors take from the robot's spec, such as the wheels of odometry."""
        fitted = {n: s.on_robot(self.model) for n, s in self.sensors.items()}
        object.__setattr__(self, "sensors", fitted)
        return self


class Contact(Spec):
    """Compliance between robot and pedestrians: Hunt-Crossley, F = k d (1 + c d')."""

    stiffness: Annotated[PositiveStiffness, BodyRegion()] = default(
        30000.0, "k, N/m, or a body region whose value it takes, such as lower_leg."
    )
    dissipation: Annotated[NonNegativeDamping, Le(1)] = default(
        0.3, "c, s/m. With more than 1, steps of 1/128 s throw light robots away."
    )


class Rates(Spec):
    """Rates of events; powers of two, so that Drake's events coincide exactly."""

    crowd: PositiveFrequency = default(16.0, "Decisions of the crowd, Hz.")
    planner: PositiveFrequency = default(16.0, "Steps of the planner, Hz.")
    log: PositiveFrequency = default(16.0, "Samples for metrics, Hz.")

    @field_validator("crowd", "planner", "log")
    @classmethod
    def _dyadic(cls, value: float) -> float:
        if value not in (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0):
            raise ValueError("must be a power of two from 1 to 128 Hz")
        return value


@dataclass(frozen=True, slots=True, eq=False)
class Locked:
    """The lock of a scenario.

    Attributes:
        files: files of the suite's lock.
        origin: function that returns the scenario as in the suite, without ``--set`` and later
            changes.
    """

    files: LockFiles
    origin: Callable[[], Scenario]


class Scenario(Spec):
    """One fully explicit trial. ``id``, ``title`` and ``references`` are outside the hash."""

    id: PathName = Field(
        description="Stable name, unique in its suite.", pattern=r"^[A-Za-z0-9_.+/-]+$"
    )
    title: str = default("", "For people.")
    environment: SerializeAsAny[EnvironmentSpec]
    crowd: Crowd | None = None
    robots: dict[str, Robot] = default({}, "Named robots.")
    contact: Contact = default(Contact(), "Robot against pedestrian.")
    rates: Rates = default(Rates(), "How often things happen.")
    references: Mapping[str, Scenario] = default(
        {}, "Calibration runs, by name.", exclude=True, repr=False
    )
    #: Draws a scenario as HTML, for notebooks; registered by the Python API.
    draw_html: ClassVar[Callable[[Scenario], str] | None] = None

    _locked: Locked | None = PrivateAttr(default=None)  # the lock with its agents
    _hidden: str = PrivateAttr(default="")  # commitment to a seed that is not revealed yet

    def __eq__(self, other: object) -> bool:
        """Return True if the content is equal; the lock is ignored."""
        return isinstance(other, Scenario) and self.__dict__ == other.__dict__

    @property
    def locked(self) -> Locked | None:
        """Return the lock of its agents, if any."""
        return self._locked

    @property
    def hidden(self) -> str:
        """Return the commitment to the seed of its people, until that is revealed; else ""."""
        return self._hidden

    def hide(self, commitment: str) -> None:
        """Mark the seed of its people as hidden."""
        self._hidden = commitment

    def lock_to(self, locked: Locked) -> None:
        """Set the lock of its agents, also for the references."""
        for scenario in (self, *self.references.values()):
            scenario._locked = locked

    def _repr_html_(self) -> str | None:
        """Return a drawing for notebooks; None if no renderer is registered."""
        draw = type(self).draw_html
        return None if draw is None else draw(self)


#: Fields of a scenario that do not affect the simulation.
OUTSIDE_HASH = ("id", "title", "references")

__all__ = [
    "OUTSIDE_HASH",
    "AtGoal",
    "Body",
    "Contact",
    "Crowd",
    "CrowdSeed",
    "Flow",
    "Goal",
    "GoalChoice",
    "NamedPolicy",
    "Rates",
    "Robot",
    "Scenario",
    "SpeedDistribution",
    "TaskSpec",
]
