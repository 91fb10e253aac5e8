"""Goal seek: drive straight to the goal, blind."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    PlannerRole,
    PlannerSpec,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
)


class GoalSeekSpec(PlannerSpec):
    """Heads straight for the goal's centre without sensing: the floor for collisions."""

    role: ClassVar[PlannerRole] = "floor"
    needs: ClassVar[tuple[str, ...]] = ()

    kind: Literal["goal_seek"] = "goal_seek"
    speed: Annotated[float, Gt(0), Le(1)] = Field(
        default=1.0, description="Cruising speed as a fraction of the robot's largest."
    )
    heading_gain: PositiveFrequency = Field(
        default=2.0, description="Yaw rate per heading error, 1/s."
    )
    turn_in_place: PositiveAngle = Field(
        default=0.785, description="Heading error above which the robot turns on the spot, rad."
    )
    tolerance: PositiveLength = Field(
        default=0.05, description="Distance to the goal centre at which it stops, m."
    )


GOAL_SEEK = Component(spec=GoalSeekSpec, summary="straight to the goal, blind")
