"""Follow the gap: steer into the widest gap, more so the nearer the nearest obstacle."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, NonNegativeLength, PositiveAngle, PositiveLength, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class FollowTheGapSpec(RungSpec):
    """Follow the gap; `gap_weight` is that of Sezer and Gokasan (2012), per robot size."""

    kind: Literal["follow_the_gap"] = "follow_the_gap"
    view: PositiveAngle = default(1.6, "Gaps are looked for this far to either side, rad.", le=3.1)
    reach: PositiveLength = default(3.0, "Obstacles farther away play no part, m.")
    safety: NonNegativeLength = default(0.1, "Least distance between robot and obstacle, m.")
    gap_weight: Annotated[float, Ge(0)] = default(
        1.0, "Weight of the gap's direction at 1 m from the nearest obstacle."
    )


FOLLOW_THE_GAP = Component(
    spec=FollowTheGapSpec,
    summary="steers into the widest gap between obstacles (Sezer, Gokasan 2012)",
)
