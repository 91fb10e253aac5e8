"""Velocity-space policy: each person takes the velocity with the lowest cost.

Source: van Toll et al., "Generalized Microscopic Crowd Simulation using Costs in Velocity
Space", I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    CrowdPolicySpec,
    NonNegativeDuration,
    NonNegativeSteeringStiffness,
    PositiveAngle,
    default,
)


class VelocitySpaceSpec(CrowdPolicySpec):
    """Costs in velocity space, by default sampled in a fan around the preferred velocity."""

    needs_costs: ClassVar[bool] = True
    kind: Literal["velocity_space"] = "velocity_space"
    method: Literal["sampling", "gradient", "global"] = default(
        "sampling", "How costs are minimised."
    )
    relaxation_time: NonNegativeDuration = default(
        0.5, "Time in which the chosen velocity is reached, s."
    )
    samples: Literal["regular", "random"] = default(
        "regular", "Candidates on a fan, or random ones for each decision."
    )
    base: Literal["zero", "current_velocity"] = default("zero", "Tip of the fan.")
    direction: Literal["unit", "current_velocity", "preferred_velocity"] = default(
        "preferred_velocity", "Middle of the fan; unit is along x."
    )
    radius: Literal["preferred_speed", "maximum_speed", "maximum_acceleration"] = default(
        "preferred_speed", "Radius of the fan; the last is what one decision can reach."
    )
    angle: PositiveAngle = default(3.141592653589793, "Opening of the fan, rad.")
    speeds: Annotated[int, Ge(1), Le(64)] = default(4, "Speeds from zero to the radius of the fan.")
    angles: Annotated[int, Ge(1), Le(360)] = default(19, "Directions.")
    random_samples: Annotated[int, Ge(1), Le(10000)] = default(100, "Number of random candidates.")
    include_base: bool = default(True, "Whether the tip of a regular fan is a candidate, too.")
    contact_stiffness: NonNegativeSteeringStiffness = default(
        62.5, "Push between overlapping people and walls, 1/s^2."
    )


VELOCITY_SPACE = Component(
    spec=VelocitySpaceSpec,
    summary="costs in velocity space, minimised by samples, gradient or closed form",
)
