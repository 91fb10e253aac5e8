"""Oracle: plans with the ground truth, and with the responses of the crowd's people."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    NonNegativeLength,
    PlannerRole,
    PositiveLength,
    default,
)
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction import CrowdPredictionSpec
from crowdbot.plugins.planners.people_mpc.people_mpc import Weight, hurry_field


class OracleSpec(CrowdPredictionSpec):
    """Plans as `people_mpc`, knowing people's positions, sizes and when they notice the robot.

    People are predicted by the crowd engine as if the robot was not there. In each plan those who
    notice it then give way. The best plan is tried beside the crowd of the run before it is driven;
    where that cannot be asked, the robot keeps the clearances of ``people_mpc``.
    """

    role: ClassVar[PlannerRole] = "ceiling"
    privileged: ClassVar[bool] = True

    kind: Literal["oracle"] = "oracle"  # type: ignore[assignment]
    tracks: Literal["truth"] = default("truth", "People: the truth.")
    localisation: Literal["truth"] = default("truth", "The robot's pose: the truth.")
    speeds: Annotated[int, Ge(2), Le(16)] = default(6, "First speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(32)] = default(15, "First yaw rates.")
    margin: NonNegativeLength = default(0.03, "Clearance below which a plan counts as a hit, m.")
    comfort: PositiveLength = default(0.15, "Clearance above which more is no better, m.")
    rehearse: NonNegativeDuration = default(
        2.4,
        "A plan is first tried beside the crowd of the run for this time, and another "
        "one driven if it touches someone or drives someone aside, s; 0: never.",
    )
    hurry: Weight = hurry_field(0.0)


ORACLE = Component(
    spec=OracleSpec,
    summary="plans with the truth among people who give way in each plan, privileged",
)
