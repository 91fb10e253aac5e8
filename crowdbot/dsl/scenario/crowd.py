"""Crowd: people, how they decide, and where they come from and go."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field, SerializeAsAny

from crowdbot.dsl.scenario.group_forces import GroupForces
from crowdbot.dsl.scenario.people_kinds import PeopleKind
from crowdbot.dsl.scenario.robot_response import HumanResponse, RobotResponseChoice
from crowdbot.dsl.scenario.routing import RoutingChoice
from crowdbot.dsl.scenario.spawning import Agents, RouteEnd, Spawn
from crowdbot.dsl.scenario.steering import SteeringSpec
from crowdbot.dsl.scenario.streams import StreamChoice
from crowdbot.dsl.spec.areas import GoalArea
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.component_specs import CostFunctionSpec, CrowdPolicySpec
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.parameters import SpeedDistribution
from crowdbot.dsl.spec.quantities import (
    NonNegativeDamping,
    PositiveAcceleration,
    PositiveDensity,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
)
from crowdbot.dsl.spec.spec import Spec

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
