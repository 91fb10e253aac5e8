"""SocialForcesAvoidance: the repulsive terms of the social forces.

Source: Helbing, Molnár, "Social force model for pedestrian dynamics", PRE 51 (1995), in the
form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, CostFunctionSpec, PositiveDuration, PositiveLength, Range


class SocialForcesAvoidanceSpec(CostFunctionSpec):
    """Pushes away from people and walls, less from people behind."""

    kind: Literal["social_forces_avoidance"] = "social_forces_avoidance"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: Range = Field(default=Range(), description="Which neighbours and walls count.")
    v0: Annotated[float, Ge(0)] = Field(default=2.1, description="Strength of people, m^2/s^2.")
    sigma: PositiveLength = Field(default=0.3, description="Reach of people, m.")
    u0: Annotated[float, Ge(0)] = Field(default=10.0, description="Strength of walls, m^2/s^2.")
    r: PositiveLength = Field(default=0.2, description="Reach of walls, m.")
    dt: PositiveDuration = Field(
        default=1.0, description="Time of the stride that others are going to make, s."
    )
    stride: Literal["other", "relative"] = Field(
        default="other",
        exclude_if=lambda value: value == "other",
        description="Whose stride makes the ellipse: the other's, as in the original, or the "
        "other's relative to one's own, which does not drive a one-way crowd.",
    )


SOCIAL_FORCES_AVOIDANCE = Component(
    spec=SocialForcesAvoidanceSpec,
    summary="repulsion by people and walls (Helbing and Molnár 1995)",
)
