"""Oracle: predicts the true people's motion under each possible command."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    PlannerRole,
    PlannerSpec,
    PositiveDuration,
    PositiveLength,
)

Weight = Annotated[float, Ge(0)]


class OracleSpec(PlannerSpec):
    """Knows the position and velocity of all people; uses its lidar for walls."""

    role: ClassVar[PlannerRole] = "ceiling"
    privileged: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["oracle"] = "oracle"
    robot_radius: PositiveLength | None = Field(
        default=None, description="Radius of the robot, m; unset: the robot's own outline."
    )
    speed: Annotated[float, Gt(0), Le(1)] = Field(
        default=1.0, description="Cruising speed as a fraction of the robot's largest."
    )
    window: PositiveDuration = Field(
        default=0.5, description="Candidates are the velocities reachable in this time, s."
    )
    speeds: Annotated[int, Ge(2), Le(32)] = Field(default=6, description="Candidate speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(64)] = Field(default=17, description="Candidate yaw rates.")
    horizon: PositiveDuration = Field(default=2.5, description="Length of a rollout, s.")
    turn_time: PositiveDuration = Field(
        default=1.0, description="Time on the arc; the rest of a rollout turns to the goal, s."
    )
    margin: NonNegativeLength = Field(
        default=0.05, description="Clearance below which a rollout counts as a hit, m."
    )
    comfort: PositiveLength = Field(
        default=0.6, description="Clearance above which more is no better, m."
    )
    progress: Weight = Field(default=1.0, description="Weight of way made to the goal.")
    heading: Weight = Field(default=0.4, description="Weight of the heading after the arc.")
    clearance: Weight = Field(default=0.2, description="Weight of the closest approach.")
    impact: Weight = Field(default=1.0, description="Weight of an early and fast predicted hit.")
    smoothness: Weight = Field(default=0.05, description="Weight of a change of command.")


ORACLE = Component(
    spec=OracleSpec,
    build="crowdbot.plugins.planners.oracle_build:build",
    summary="rolls the true people forward under each command, privileged",
)
