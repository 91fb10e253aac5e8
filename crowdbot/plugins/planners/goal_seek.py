"""Goal seek: drive straight to the goal, blind."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Gt, Le

from crowdbot.plugin import (
    Component,
    PlannerRole,
    PlannerSpec,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
    default,
)


class GoalSeekSpec(PlannerSpec):
    """Heads straight for the goal's centre without sensing: the floor for collisions."""

    role: ClassVar[PlannerRole] = "floor"
    needs: ClassVar[tuple[str, ...]] = ()

    kind: Literal["goal_seek"] = "goal_seek"
    speed: Annotated[float, Gt(0), Le(1)] = default(
        1.0, "Cruising speed as a fraction of the robot's largest."
    )
    heading_gain: PositiveFrequency = default(2.0, "Yaw rate per heading error, 1/s.")
    turn_in_place: PositiveAngle = default(
        0.785, "Heading error above which the robot turns on the spot, rad."
    )
    tolerance: PositiveLength = default(0.05, "Distance to the goal centre at which it stops, m.")


GOAL_SEEK = Component(spec=GoalSeekSpec, summary="straight to the goal, blind")
