"""The primary score: safe arrival, and time against a common reference."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="task")


class SafeEfficiencySpec(MetricSpec):
    """Timely arrival without contacts at fault, pushing people aside or touching walls."""

    kind: Literal["safe_efficiency"] = "safe_efficiency"
    fault_speed: parameters.FaultSpeed
    fault_reaction: parameters.FaultReaction
    fault_braking: parameters.FaultBraking
    fault_margin: parameters.FaultMargin
    forced_push: parameters.ForcedPush
    forced_factor: parameters.ForcedFactor
    wall_factor: parameters.WallFactor
    forced_headway: parameters.ForcedHeadway
    evasion_reach: parameters.EvasionReach
    contact_tol: parameters.ContactTol
    release_gap: parameters.ReleaseGap
    jump_speed: parameters.JumpSpeed
    zero_tol: parameters.ZeroTol


SAFE_EFFICIENCY = declare(
    SafeEfficiencySpec,
    symbol="E_s",
    spec_version=6,
    unit="1",
    better="higher",
    minimum=0.0,
    maximum=1.0,
    more_people="down",
    variants=("corrected", "by_robot"),
)
