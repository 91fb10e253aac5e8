"""The primary score: safe arrival, and time against a common reference."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    EvasionReach,
    FaultBraking,
    FaultMargin,
    FaultReaction,
    FaultSpeed,
    ForcedFactor,
    ForcedHeadway,
    ForcedPush,
    JumpSpeed,
    ReleaseGap,
    WallFactor,
    ZeroTol,
)

declare = partial(declare_metric, category="task")


class SafeEfficiencySpec(MetricSpec):
    """Timely arrival without contacts at fault, pushing people aside or touching walls."""

    kind: Literal["safe_efficiency"] = "safe_efficiency"
    fault_speed: FaultSpeed
    fault_reaction: FaultReaction
    fault_braking: FaultBraking
    fault_margin: FaultMargin
    forced_push: ForcedPush
    forced_factor: ForcedFactor
    wall_factor: WallFactor
    forced_headway: ForcedHeadway
    evasion_reach: EvasionReach
    contact_tol: ContactTol
    release_gap: ReleaseGap
    jump_speed: JumpSpeed
    zero_tol: ZeroTol


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
