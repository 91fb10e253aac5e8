"""Oracle: plans with the truth, among people who walk and give way as those of the crowd do."""

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
    """Plans as `people_mpc`; knows where people are, how wide, and who notices the robot when.

    People are predicted by the crowd engine as if the robot was not there. In each plan those who
    notice it then give way.
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
    hurry: Weight = hurry_field(1.0)
    hurry_within: PositiveDuration = Field(
        default=10.0,
        exclude_if=lambda value: value == 10.0,  # hashes are as without it
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
