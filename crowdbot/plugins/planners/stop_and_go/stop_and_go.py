"""Stop and go: drive towards the goal.

Wait if a person is in the way and there is no room beside.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    NonNegativeLength,
    PlannerRole,
    PlannerSpec,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
    default,
)


class StopAndGoSpec(PlannerSpec):
    """Uses a stop box in front of the robot, as wide as the robot plus a margin on either side."""

    role: ClassVar[PlannerRole] = "floor"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["stop_and_go"] = "stop_and_go"
    robot_radius: PositiveLength | None = default(
        None, "Radius of the robot, m; unset: the robot's own outline."
    )
    person_radius: NonNegativeLength = default(
        0.25, "Disc that is kept clear around legs; 0: legs alone, m."
    )
    speed: Annotated[float, Gt(0), Le(1)] = default(
        1.0, "Cruising speed as a fraction of the robot's largest."
    )
    heading_gain: PositiveFrequency = default(2.0, "Yaw rate per heading error, 1/s.")
    turn_in_place: PositiveAngle = default(
        0.785, "Heading error above which the robot turns on the spot, rad."
    )
    side_margin: NonNegativeLength = default(0.1, "Free space beside the robot, m.")
    front_margin: NonNegativeLength = default(
        0.1, "Free space that remains before the robot when it stands, m."
    )
    reaction_time: NonNegativeDuration = default(
        0.3, "Driven at full speed before braking sets in, s."
    )
    look_back: NonNegativeDuration = default(
        0.3, "Age of the scan that shows who walks; 0 takes all as still, s."
    )
    most_aside: Annotated[float, Ge(0), Le(1.2)] = default(
        0.785, "How far to either side it looks for room (0 goes straight), rad."
    )
    look_ahead: NonNegativeDuration = default(
        3.0,
        "Drives where no one will be met for this long, if everyone continues as they "
        "do; 0: only towards where it may drive fastest now, s.",
    )
    aside_reach: NonNegativeLength = default(
        1.0, "Nearer to the goal than this it goes straight, m."
    )


STOP_AND_GO = Component(
    spec=StopAndGoSpec,
    summary="to the goal where there is room, stands while something is in the way",
)
