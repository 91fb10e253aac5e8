"""Risk: how near in time the next collision is, while the robot drives."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import MetricSpec
from crowdbot.dsl.quantities import (
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveDuration,
    PositiveSpeed,
)


class RiskSpec(MetricSpec):
    """Time to the first contact with anybody, if all keep their velocities."""

    kind: Literal["risk"] = "risk"
    risk_horizon: PositiveDuration = Field(
        default=5.0, description="Contacts farther ahead carry no risk, s."
    )
    contact_tol: NonNegativeLength = Field(
        default=1e-9, description="Surfaces this close touch, m."
    )
    rel_speed_tol: NonNegativeSpeed = Field(
        default=1e-6, description="Slower relative motion counts as none, m/s."
    )
    jump_speed: PositiveSpeed = Field(
        default=10.0, description="A faster step is a teleport where none are recorded, m/s."
    )


RISK = Component(
    spec=RiskSpec,
    build="crowdbot.plugins.metrics.risk_build:build",
    summary="R: imminence of the next collision, summed over the run",
)
