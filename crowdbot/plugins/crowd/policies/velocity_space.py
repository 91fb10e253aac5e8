"""Velocity-space policy: each person takes the velocity with the lowest cost.

Source: van Toll et al., "Generalized Microscopic Crowd Simulation using Costs in Velocity
Space", I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    CrowdPolicySpec,
    NonNegativeDuration,
    NonNegativeSteeringStiffness,
    PositiveAngle,
)


class VelocitySpaceSpec(CrowdPolicySpec):
    """Costs in velocity space, by default sampled in a fan around the preferred velocity."""

    needs_costs: ClassVar[bool] = True
    kind: Literal["velocity_space"] = "velocity_space"
    method: Literal["sampling", "gradient", "global"] = Field(
        default="sampling", description="How costs are minimised."
    )
    relaxation_time: NonNegativeDuration = Field(
        default=0.5, description="Time in which the chosen velocity is reached, s."
    )
    samples: Literal["regular", "random"] = Field(
        default="regular", description="Candidates on a fan, or random ones for each decision."
    )
    base: Literal["zero", "current_velocity"] = Field(default="zero", description="Tip of the fan.")
    direction: Literal["unit", "current_velocity", "preferred_velocity"] = Field(
        default="preferred_velocity", description="Middle of the fan; unit is along x."
    )
    radius: Literal["preferred_speed", "maximum_speed", "maximum_acceleration"] = Field(
        default="preferred_speed",
        description="Radius of the fan; the last is what one decision can reach.",
    )
    angle: PositiveAngle = Field(default=3.141592653589793, description="Opening of the fan, rad.")
    speeds: Annotated[int, Ge(1), Le(64)] = Field(
        default=4, description="Speeds from zero to the radius of the fan."
    )
    angles: Annotated[int, Ge(1), Le(360)] = Field(default=19, description="Directions.")
    random_samples: Annotated[int, Ge(1), Le(10000)] = Field(
        default=100, description="Number of random candidates."
    )
    include_base: bool = Field(
        default=True,
        description="Whether the tip of a regular fan is a candidate, too.",
    )
    contact_stiffness: NonNegativeSteeringStiffness = Field(
        default=62.5, description="Push between overlapping people and walls, 1/s^2."
    )


VELOCITY_SPACE = Component(
    spec=VelocitySpaceSpec,
    summary="costs in velocity space, minimised by samples, gradient or closed form",
)
