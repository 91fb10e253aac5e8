"""SocialForcesAvoidance: the repulsive terms of the social forces.

Source: Helbing, Molnár, "Social force model for pedestrian dynamics", PRE 51 (1995), in the
form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import (
    Component,
    PositiveDuration,
    PositiveLength,
    default,
)
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class SocialForcesAvoidanceSpec(WeightedCostSpec):
    """Pushes away from people and walls, less from people behind."""

    kind: Literal["social_forces_avoidance"] = "social_forces_avoidance"
    v0: Annotated[float, Ge(0)] = default(2.1, "Strength of people, m^2/s^2.")
    sigma: PositiveLength = default(0.3, "Reach of people, m.")
    u0: Annotated[float, Ge(0)] = default(10.0, "Strength of walls, m^2/s^2.")
    r: PositiveLength = default(0.2, "Reach of walls, m.")
    dt: PositiveDuration = default(1.0, "Time of the stride that others are going to make, s.")
    stride: Literal["other", "relative"] = default(
        "other",
        "Whose stride makes the ellipse: the other's, as in the original, or the "
        "other's relative to one's own, which does not drive a one-way crowd.",
        omitted=True,
    )


SOCIAL_FORCES_AVOIDANCE = Component(
    spec=SocialForcesAvoidanceSpec,
    summary="repulsion by people and walls (Helbing and Molnár 1995)",
)
