"""Oracle: plans with the ground truth, among people who respond like those of the crowd."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    NonNegativeLength,
    PlannerRole,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction import CrowdPredictionSpec
from crowdbot.plugins.planners.people_mpc.people_mpc import Weight, hurry_field


class OracleSpec(CrowdPredictionSpec):
    """Plans as `people_mpc`, knowing people's positions, sizes and when they notice the robot.

    People are predicted by the crowd engine as if the robot was not there. In each plan those who
    notice it then give way. With ``foresight`` the crowd itself walks on instead.
    """

    role: ClassVar[PlannerRole] = "ceiling"
    privileged: ClassVar[bool] = True

    kind: Literal["oracle"] = "oracle"  # type: ignore[assignment]
    tracks: Literal["truth"] = Field(default="truth", description="People: the truth.")
    localisation: Literal["truth"] = Field(
        default="truth", description="The robot's pose: the truth."
    )
    speeds: Annotated[int, Ge(2), Le(16)] = Field(default=6, description="First speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(32)] = Field(default=15, description="First yaw rates.")
    comfort: PositiveLength = Field(
        default=0.3, description="Clearance above which more is no better, m."
    )
    foresight: bool = Field(
        default=False,
        exclude_if=lambda value: not value,  # hashes are as without it
        description="Let the crowd of the run walk on to see where people will be, and choose by "
        "the shortest time to the goal among them.",
    )
    look_again: PositiveDuration = Field(
        default=0.5,
        exclude_if=lambda value: value == 0.5,
        description="Time after which people are foreseen again, s.",
    )
    far_horizon: PositiveDuration = Field(
        default=8.0,
        le=20.0,
        exclude_if=lambda value: value == 8.0,
        description="How far people are foreseen, s.",
    )
    far_margin: NonNegativeLength = Field(
        default=0.05,
        exclude_if=lambda value: value == 0.05,
        description="Clearance that is kept in the shortest time to the goal, m.",
    )
    through: Weight = Field(
        default=0.1,
        exclude_if=lambda value: value == 0.1,
        description="What a second in place of a person who sees the robot costs there, s.",
    )
    into: Weight = Field(
        default=10.0,
        exclude_if=lambda value: value == 10.0,
        description="The same for a person who sees it late or never, s.",
    )
    rehearse: NonNegativeDuration = Field(
        default=0.0,
        exclude_if=lambda value: value == 0.0,
        description="A plan is first tried beside the crowd of the run for this time, and another "
        "one driven if it touches someone, s; 0: never.",
    )
    hurry: Weight = hurry_field(1.0)
    hurry_within: PositiveDuration = Field(
        default=10.0,
        exclude_if=lambda value: value == 10.0,
        description="Only this first part of a plan counts for `hurry`, s.",
    )
    hurry_room: NonNegativeLength = Field(
        default=0.0,
        exclude_if=lambda value: value == 0.0,
        description="A person passed closer than this counts as reached, m.",
    )


ORACLE = Component(
    spec=OracleSpec,
    summary="plans with the truth among people who give way in each plan, privileged",
)
