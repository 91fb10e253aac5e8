"""MPPI: the mean of two thousand noisy controls, weighted by their costs."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import (
    Component,
    NonNegativeSpeed,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


class MppiSpec(RungSpec):
    """Parameters of MPPI.

    Samples, noise and temperature are nav2's defaults; the weights are crowdbot's own.
    """

    kind: Literal["mppi"] = "mppi"
    samples: Annotated[int, Ge(10), Le(20_000)] = default(2000, "Rollouts.")
    steps: Annotated[int, Ge(5), Le(200)] = default(56, "Steps of a rollout.")
    step_time: PositiveDuration = default(0.05, "Length of a step, s.")
    noise_time: PositiveDuration = default(
        0.4, "Time between draws of noise, which is linear between them, s."
    )
    speed_noise: PositiveSpeed = default(0.2, "Standard deviation of v and vy, m/s.")
    yaw_rate_noise: PositiveAngularSpeed = default(0.4, "Standard deviation of w, rad/s.")
    temperature: Annotated[float, Gt(0)] = default(
        0.3, "Costs that differ by this have weights that differ by e."
    )
    control_weight: Weight = default(0.015, "Weight of noise away from the last plan (gamma).")
    comfort: PositiveLength = default(0.5, "Clearance above which more is no better, m.")
    margin_growth: NonNegativeSpeed = default(0.05, "Clearance to people lost to doubt, m/s.")
    progress: Weight = default(8.0, "Weight of the way made to the goal.")
    heading: Weight = default(1.0, "Weight of the final heading's error.")
    clearance: Weight = default(6.0, "Weight of mean closeness.")
    collision: Weight = default(20.0, "Weight of a hit; an early one costs more.")
    backward: Weight = default(5.0, "Weight of way driven backwards.")


MPPI = Component(
    spec=MppiSpec,
    summary="model-predictive path integral control among predicted people, with nav2's defaults",
)
