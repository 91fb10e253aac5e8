"""Metric of overtaking in the same direction."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    HeadingMinSpeed,
    JumpSpeed,
    OvertakeAngle,
    OvertakeEps,
    OvertakeLateral,
)


class OvertakingCountSpec(MetricSpec):
    """People whom the robot overtakes."""

    kind: Literal["overtaking_count"] = "overtaking_count"
    heading_min_speed: HeadingMinSpeed
    overtake_lateral: OvertakeLateral
    overtake_angle: OvertakeAngle
    overtake_eps: OvertakeEps
    jump_speed: JumpSpeed


OVERTAKING_COUNT = declare_metric(
    OvertakingCountSpec,
    symbol="O",
    unit="1",
    better="reference",
    category="similarity",
    minimum=0.0,
    integer=True,
    more_people="up",
    variants=("literal", "corrected"),
)
