"""Who passes whom on the way in the same direction."""

from __future__ import annotations

import math
from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
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
    heading_min_speed: HeadingMinSpeed = 0.1
    overtake_lateral: OvertakeLateral = 3.0
    overtake_angle: OvertakeAngle = math.pi / 4
    overtake_eps: OvertakeEps = 1e-6
    jump_speed: JumpSpeed = 10.0


OVERTAKING_COUNT = MetricComponent(
    spec=OvertakingCountSpec,
    build="crowdbot.plugins.metrics.overtaking_build:OvertakingCount",
    summary="O: people whom the robot overtakes",
    label=ScoreLabel(
        metric="overtaking_count",
        symbol="O",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(whole=True, least=0.0, more_people="up"),
        "corrected": Laws(whole=True, least=0.0, more_people="up"),
    },
)

COMPONENTS = (OVERTAKING_COUNT,)
