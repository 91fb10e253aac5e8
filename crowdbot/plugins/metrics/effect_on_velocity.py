"""Effect on velocity: how much slower people walk because of the robot."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import MetricSpec
from crowdbot.dsl.quantities import PositiveSpeed


class EffectOnVelocitySpec(MetricSpec):
    """Mean walking speed without the robot, over mean walking speed with it."""

    kind: Literal["effect_on_velocity"] = "effect_on_velocity"
    zero_tol: Annotated[float, Ge(0)] = Field(
        default=1e-9, description="A denominator up to this counts as zero, m/s."
    )
    jump_speed: PositiveSpeed = Field(
        default=10.0, description="A faster step is a teleport where none are recorded, m/s."
    )


EFFECT_ON_VELOCITY = Component(
    spec=EffectOnVelocitySpec,
    build="crowdbot.plugins.metrics.effect_on_velocity_build:build",
    summary="E_v: mean walking speed without the robot over mean walking speed with it",
)
