"""Oracle: plans with the ground truth, among people who respond like those of the crowd."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    PlannerRole,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction import CrowdPredictionSpec
from crowdbot.plugins.planners.people_mpc.people_mpc import Weight, hurry_field


class OracleSpec(CrowdPredictionSpec):
    """Plans as `people_mpc`, knowing people's positions, sizes and when they notice the robot.

    The crowd itself walks on as if the robot was not there: the shortest time to the goal among its
    people counts, and in each plan those who notice the robot give way.
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
    look_again: PositiveDuration = Field(
        default=0.5, description="Time after which people are foreseen again, s."
    )
    far_horizon: PositiveDuration = Field(
        default=8.0,
        le=20.0,
        description="How far people are foreseen, s. Beyond a plan's end, the shortest time to the "
        "goal among them counts.",
    )
    far_margin: NonNegativeLength = Field(
        default=0.05, description="Clearance that is kept in that time, m."
    )
    through: Weight = Field(
        default=0.1, description="What a second in place of a person who sees the robot costs, s."
    )
    into: Weight = Field(
        default=10.0, description="The same for a person who sees it late or never, s."
    )
    hurry: Weight = hurry_field(4.0)


ORACLE = Component(
    spec=OracleSpec,
    summary="plans with the truth among people who give way in each plan, privileged",
)
