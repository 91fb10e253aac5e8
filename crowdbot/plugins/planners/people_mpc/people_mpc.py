"""People MPC: the best of some hundred plans of four seconds among predicted people."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


def hurry_field(default: float) -> Any:
    """Return the field ``hurry``, whose value differs between planners of this family."""
    return Field(
        default=default,
        description="Weight of the time in which the robot would reach a person who stood still "
        "within the headway.",
    )


class PeopleMpcSpec(RungSpec):
    """A plan has two stretches: a velocity, and then a direction beside that of the goal."""

    kind: Literal["people_mpc"] = "people_mpc"
    person_radius: NonNegativeLength = Field(
        default=0.22, description="Disc that is kept clear around people, m."
    )
    window: PositiveDuration = Field(
        default=0.5, description="First velocities are those reachable in this time, s."
    )
    speeds: Annotated[int, Ge(2), Le(16)] = Field(default=5, description="First speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(32)] = Field(default=11, description="First yaw rates.")
    horizon: PositiveDuration = Field(default=4.0, le=10.0, description="Length of a plan, s.")
    turn_time: PositiveDuration = Field(default=0.8, description="Length of its first stretch, s.")
    swerve: PositiveAngle = Field(
        default=1.3,
        description="Largest angle to the goal, or to the way past what stands, of a robot that "
        "drives, rad; if it faces further away it turns on the spot.",
    )
    margin: NonNegativeLength = Field(
        default=0.05, description="Clearance below which a plan counts as a hit, m."
    )
    comfort: PositiveLength = Field(
        default=0.5, description="Clearance above which more is no better, m."
    )
    margin_growth: NonNegativeSpeed = Field(
        default=0.03, description="Clearance to people lost to doubt, m/s."
    )
    progress: Weight = Field(default=1.0, description="Weight of the way made to the goal.")
    clearance: Weight = Field(default=0.25, description="Weight of the closest approach.")
    impact: Weight = Field(default=1.0, description="Weight of an early and fast hit.")
    heading: Weight = Field(
        default=0.8, description="Weight of the angle to the goal after the first stretch."
    )
    hurry: Weight = hurry_field(4.0)
    headway: PositiveDuration = Field(
        default=0.5, description="That time to a person who stands still, s."
    )
    hurry_within: PositiveDuration = Field(
        default=0.8, description="Only this first part of a plan counts for `hurry`, s."
    )
    hurry_room: NonNegativeLength = Field(
        default=0.08, description="A person passed closer than this counts as reached, m."
    )
    smoothness: Weight = Field(default=0.05, description="Weight of a change of command.")


PEOPLE_MPC = Component(
    spec=PeopleMpcSpec,
    summary="the best of some hundred plans of four seconds among tracked, predicted people",
)
