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
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec


class ValueSearchSpec(RungSpec):
    """Parameters of CrowdNav's configuration files, as used in training."""

    weights: Asset = Field(
        description="File of weights: PyTorch's `.pth` of a `state_dict`, or numpy's `.npz`."
    )
    kinematics: Literal["holonomic", "unicycle"] = default(
        "holonomic", "Actions: velocities, or speeds and turns within 45°."
    )
    speed_samples: Annotated[int, Ge(1), Le(20)] = default(5, "Speeds, denser near 0.")
    rotation_samples: Annotated[int, Ge(1), Le(64)] = default(16, "Directions.")
    gamma: Annotated[float, Gt(0), Le(1)] = default(
        0.9, "Discount factor of the value, for each metre at full speed."
    )
    step_time: PositiveDuration = default(0.25, "Time between decisions, and of the look ahead, s.")
    discomfort: NonNegativeLength = default(
        0.2, "Clearance to people below which there is a penalty, m."
    )
    person_radius: NonNegativeLength = default(
        0.3, "Radius of people, as the network sees them, m."
    )
    neighbours: Annotated[int, Ge(1), Le(50)] = default(
        5, "People that the network sees, the nearest first."
    )
    goal_distance: PositiveLength = default(
        8.0, "Goals farther than this are shown to the network here, m."
    )
    wall_time: NonNegativeDuration = default(
        1.0, "Actions that would touch what stands in this time are left out, s; 0: none."
    )
