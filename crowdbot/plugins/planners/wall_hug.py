"""Wall hug: drives blindly along the edge of the goal zone."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Gt, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    PlannerRole,
    PlannerSpec,
    PositiveAngle,
    PositiveFrequency,
    PositiveLength,
    default,
)


class WallHugSpec(PlannerSpec):
    """Drives along walls, where few people walk, without sensing anyone.

    Where the goal zone is as wide as the place, as in a corridor, its edge is the wall.
    """

    role: ClassVar[PlannerRole] = "floor"
    needs: ClassVar[tuple[str, ...]] = ()

    kind: Literal["wall_hug"] = "wall_hug"
    side: Literal["left", "right"] = default(
        "left", "Which border, as seen on the way from start to goal."
    )
    gap: NonNegativeLength | None = default(
        None,
        "From the border to the centre of the robot, m; unset: 0.3 m, or half of the "
        "robot's width and 0.1 m where that is more.",
    )
    speed: Annotated[float, Gt(0), Le(1)] = default(
        1.0, "Cruising speed as a fraction of the robot's largest."
    )
    look_ahead: PositiveLength = default(1.0, "It aims at the point of its line so far ahead, m.")
    heading_gain: PositiveFrequency = default(2.0, "Yaw rate per heading error, 1/s.")
    turn_in_place: PositiveAngle = default(
        0.785, "Heading error above which the robot turns on the spot, rad."
    )


WALL_HUG = Component(spec=WallHugSpec, summary="to the border of the goal zone and along it, blind")
