"""MPPI: the mean of two thousand noisy controls, weighted by their costs."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeSpeed,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


class MppiSpec(RungSpec):
    """Parameters of MPPI.

    Samples, noise and temperature are nav2's defaults; the weights are crowdbot's own.
    """

    kind: Literal["mppi"] = "mppi"
    samples: Annotated[int, Ge(10), Le(20_000)] = Field(default=2000, description="Rollouts.")
    steps: Annotated[int, Ge(5), Le(200)] = Field(default=56, description="Steps of a rollout.")
    step_time: PositiveDuration = Field(default=0.05, description="Length of a step, s.")
    noise_time: PositiveDuration = Field(
        default=0.4, description="Time between draws of noise, which is linear between them, s."
    )
    speed_noise: PositiveSpeed = Field(
        default=0.2, description="Standard deviation of v and vy, m/s."
    )
    yaw_rate_noise: PositiveAngularSpeed = Field(
        default=0.4, description="Standard deviation of w, rad/s."
    )
    temperature: Annotated[float, Gt(0)] = Field(
        default=0.3, description="Costs that differ by this have weights that differ by e."
    )
    control_weight: Weight = Field(
        default=0.015, description="Weight of noise away from the last plan (gamma)."
    )
    comfort: PositiveLength = Field(
        default=0.5, description="Clearance above which more is no better, m."
    )
    margin_growth: NonNegativeSpeed = Field(
        default=0.05, description="Clearance to people lost to doubt, m/s."
    )
    progress: Weight = Field(default=8.0, description="Weight of the way made to the goal.")
    heading: Weight = Field(default=1.0, description="Weight of the final heading's error.")
    clearance: Weight = Field(default=6.0, description="Weight of mean closeness.")
    collision: Weight = Field(default=20.0, description="Weight of a hit; an early one costs more.")
    backward: Weight = Field(default=5.0, description="Weight of way driven backwards.")


MPPI = Component(
    spec=MppiSpec,
    summary="model-predictive path integral control among predicted people, with nav2's defaults",
)
