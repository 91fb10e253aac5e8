"""Metric of overtaking in the same direction."""

from __future__ import annotations

from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric


class OvertakingCountSpec(MetricSpec):
    """People whom the robot overtakes."""

    kind: Literal["overtaking_count"] = "overtaking_count"
    heading_min_speed: parameters.HeadingMinSpeed
    overtake_lateral: parameters.OvertakeLateral
    overtake_angle: parameters.OvertakeAngle
    overtake_eps: parameters.OvertakeEps
    jump_speed: parameters.JumpSpeed


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
