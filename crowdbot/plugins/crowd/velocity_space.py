"""Velocity-space policy: each person takes the candidate velocity of least cost.

Source: van Toll et al., "Generalized Microscopic Crowd Simulation using Costs in Velocity
Space", I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import CrowdPolicySpec
from crowdbot.dsl.quantities import NonNegativeDuration, NonNegativeSteeringStiffness, PositiveAngle


class VelocitySpaceSpec(CrowdPolicySpec):
    """Regular samples on a fan around the preferred velocity, standing still included."""

    needs_costs: ClassVar[bool] = True
    kind: Literal["velocity_space"] = "velocity_space"
    method: Literal["sampling"] = Field(default="sampling", description="How costs are minimised.")
    relaxation_time: NonNegativeDuration = Field(
        default=0.5, description="Time in which the chosen velocity is reached, s."
    )
    angle: PositiveAngle = Field(default=3.141592653589793, description="Opening of the fan, rad.")
    speeds: Annotated[int, Ge(2), Le(64)] = Field(
        default=4, description="Speeds from zero to the preferred one."
    )
    angles: Annotated[int, Ge(2), Le(360)] = Field(default=19, description="Directions.")
    contact_stiffness: NonNegativeSteeringStiffness = Field(
        default=62.5, description="Push between overlapping people and walls, 1/s^2."
    )


VELOCITY_SPACE = Component(
    spec=VelocitySpaceSpec,
    build="crowdbot.plugins.crowd.velocity_space_build:build",
    summary="costs in velocity space, minimised over regular samples",
)
