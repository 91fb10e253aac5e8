"""Parameters of learned planners that search one step ahead with a value network."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Asset,
    NonNegativeDuration,
    NonNegativeLength,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec


class ValueSearchSpec(RungSpec):
    """Parameters of CrowdNav's configuration files, as used in training."""

    weights: Asset = Field(
        description="File of weights: PyTorch's `.pth` of a `state_dict`, or numpy's `.npz`."
    )
    kinematics: Literal["holonomic", "unicycle"] = Field(
        default="holonomic", description="Actions: velocities, or speeds and turns within 45°."
    )
    speed_samples: Annotated[int, Ge(1), Le(20)] = Field(
        default=5, description="Speeds, denser near 0."
    )
    rotation_samples: Annotated[int, Ge(1), Le(64)] = Field(default=16, description="Directions.")
    gamma: Annotated[float, Gt(0), Le(1)] = Field(
        default=0.9, description="Discount factor of the value, for each metre at full speed."
    )
    step_time: PositiveDuration = Field(
        default=0.25, description="Time between decisions, and of the look ahead, s."
    )
    discomfort: NonNegativeLength = Field(
        default=0.2, description="Clearance to people below which there is a penalty, m."
    )
    person_radius: NonNegativeLength = Field(
        default=0.3, description="Radius of people, as the network sees them, m."
    )
    neighbours: Annotated[int, Ge(1), Le(50)] = Field(
        default=5, description="People that the network sees, the nearest first."
    )
    goal_distance: PositiveLength = Field(
        default=8.0, description="Goals farther than this are shown to the network here, m."
    )
    wall_time: NonNegativeDuration = Field(
        default=1.0,
        description="Actions that would touch what stands in this time are left out, s; 0: none.",
    )
