"""How far the robot advances on people who have little room."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.dsl import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import Compliance, EvasionReach, JumpSpeed

declare = partial(declare_metric, category="proximity")


class IntrusionSpec(MetricSpec):
    """Way on which the robot advances on people with little room, per person met."""

    kind: Literal["intrusion"] = "intrusion"
    compliance: Compliance
    evasion_reach: EvasionReach
    jump_speed: JumpSpeed


INTRUSION = declare(
    IntrusionSpec,
    symbol="L_in",
    unit="m",
    better="lower",
    minimum=0.0,
    variants={"corrected": {}, "total": {"better": "none", "more_people": "up"}},
)

COMPONENTS = (INTRUSION,)
