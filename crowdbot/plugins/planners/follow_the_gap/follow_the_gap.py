"""Follow the gap: steer into the widest gap, more so the nearer the nearest obstacle."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, NonNegativeLength, PositiveAngle, PositiveLength
from crowdbot.plugins.planners.shared.rungs import RungSpec


class FollowTheGapSpec(RungSpec):
    """The weight of the gap is that of Sezer and Gokasan 2012 in units of the robot's size."""

    kind: Literal["follow_the_gap"] = "follow_the_gap"
    view: PositiveAngle = Field(
        default=1.6, le=3.1, description="Gaps are looked for this far to either side, rad."
    )
    reach: PositiveLength = Field(
        default=3.0, description="Obstacles farther away play no part, m."
    )
    safety: NonNegativeLength = Field(
        default=0.1, description="Least distance between robot and obstacle, m."
    )
    gap_weight: Annotated[float, Ge(0)] = Field(
        default=1.0, description="Weight of the gap's direction at 1 m from the nearest obstacle."
    )


FOLLOW_THE_GAP = Component(
    spec=FollowTheGapSpec,
    summary="steers into the widest gap between obstacles (Sezer, Gokasan 2012)",
)
