"""People MPC: the best of some hundred plans of four seconds among predicted people."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


def hurry_field(weight: float) -> Any:
    """Return the field ``hurry``, whose value differs between planners of this family."""
    return default(
        weight,
        "Weight of the time in which the robot would reach a person who stood still "
        "within the headway.",
    )


class PeopleMpcSpec(RungSpec):
    """A plan has two stretches: a velocity, and then a direction beside that of the goal."""

    kind: Literal["people_mpc"] = "people_mpc"
    person_radius: NonNegativeLength = default(0.22, "Disc that is kept clear around people, m.")
    window: PositiveDuration = default(0.5, "First velocities are those reachable in this time, s.")
    speeds: Annotated[int, Ge(2), Le(16)] = default(5, "First speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(32)] = default(11, "First yaw rates.")
    horizon: PositiveDuration = default(4.0, "Length of a plan, s.", le=10.0)
    turn_time: PositiveDuration = default(0.8, "Length of its first stretch, s.")
    swerve: PositiveAngle = default(
        1.3,
        "Largest angle to the goal, or to the way past what stands, of a robot that "
        "drives, rad; if it faces further away it turns on the spot.",
    )
    margin: NonNegativeLength = default(0.05, "Clearance below which a plan counts as a hit, m.")
    comfort: PositiveLength = default(0.5, "Clearance above which more is no better, m.")
    margin_growth: NonNegativeSpeed = default(0.03, "Clearance to people lost to doubt, m/s.")
    progress: Weight = default(1.0, "Weight of the way made to the goal.")
    clearance: Weight = default(0.25, "Weight of the closest approach.")
    impact: Weight = default(1.0, "Weight of an early and fast hit.")
    heading: Weight = default(0.8, "Weight of the angle to the goal after the first stretch.")
    hurry: Weight = hurry_field(4.0)
    headway: PositiveDuration = default(0.5, "That time to a person who stands still, s.")
    hurry_within: PositiveDuration = default(
        0.8, "Only this first part of a plan counts for `hurry`, s."
    )
    hurry_room: NonNegativeLength = default(
        0.08, "A person passed closer than this counts as reached, m."
    )
    smoothness: Weight = default(0.05, "Weight of a change of command.")


PEOPLE_MPC = Component(
    spec=PeopleMpcSpec,
    summary="the best of some hundred plans of four seconds among tracked, predicted people",
)
