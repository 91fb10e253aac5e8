"""VFH+: a histogram of obstacles by direction, and the cheapest direction that is open."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, NonNegativeLength, PositiveLength, default
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


class VfhPlusSpec(RungSpec):
    """Weights of Ulrich and Borenstein 1998, section 5: 5, 2, 2; the first exceeds their sum."""

    kind: Literal["vfh_plus"] = "vfh_plus"
    sectors: Annotated[int, Ge(24), Le(360)] = default(
        72, "Sectors of the full turn; 72 are 5 degrees each."
    )
    window: PositiveLength = default(2.5, "Obstacles farther away play no part, m.")
    safety: NonNegativeLength = default(0.1, "Least distance between robot and obstacle, m.")
    low: Weight = default(
        0.15, "Share of the density of touching below which a closed sector opens."
    )
    high: Weight = default(0.3, "Share of that density above which an open sector closes.")
    wide: Annotated[int, Ge(2), Le(180)] = default(
        16, "An opening of more sectors is wide: it is passed beside an edge."
    )
    goal_weight: Weight = default(5.0, "Weight of the angle to the goal.")
    heading_weight: Weight = default(2.0, "Weight of the angle to the heading.")
    change_weight: Weight = default(2.0, "Weight of the angle to the last choice.")


VFH_PLUS = Component(
    spec=VfhPlusSpec,
    summary="vector field histogram with the robot's width (Ulrich, Borenstein 1998)",
)
