"""Drift: people who walk to their goal and bend away from each other."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, CrowdPolicySpec, NonNegativeSpeed, PositiveLength
from pydantic import Field


class DriftSpec(CrowdPolicySpec):
    """The preferred velocity, and away from everybody who is near. Takes no cost functions."""

    kind: Literal["acme.drift"] = "acme.drift"
    push: NonNegativeSpeed = Field(default=0.6, description="Away from who is touched, m/s.")
    fade: PositiveLength = Field(default=0.5, description="The push falls to 1/e over this, m.")


DRIFT = Component(
    spec=DriftSpec,
    build="crowdbot_acme.drift_build:build",
    summary="to the goal, and away from who is near",
)
