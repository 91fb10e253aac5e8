"""How much the crowd costs the robot: time, path and smoothness."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    JerkWeight,
    JerkZeroTol,
    JumpSpeed,
    SamplingTol,
    ZeroTol,
)


class RelativeTimeToGoalSpec(MetricSpec):
    """Time to goal alone, over time to goal in the crowd."""

    kind: Literal["relative_time_to_goal"] = "relative_time_to_goal"
    zero_tol: ZeroTol = 1e-9


class RelativePathLengthSpec(MetricSpec):
    """Length of the path alone, over length of the path in the crowd."""

    kind: Literal["relative_path_length"] = "relative_path_length"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class RelativeJerkSpec(MetricSpec):
    """Jerk of the motion alone, over jerk of the motion in the crowd."""

    kind: Literal["relative_jerk"] = "relative_jerk"
    jerk_weight: JerkWeight = 1.0
    jerk_zero_tol: JerkZeroTol = 1e-6
    sampling_tol: SamplingTol = 0.01
    jump_speed: JumpSpeed = 10.0


RELATIVE_TIME_TO_GOAL = MetricComponent(
    spec=RelativeTimeToGoalSpec,
    build="crowdbot.plugins.metrics.path_efficiency_build:RelativeTimeToGoal",
    summary="T_rtg: time to goal alone, over time to goal in the crowd",
    label=ScoreLabel(
        metric="relative_time_to_goal",
        symbol="T_rtg",
        category="path efficiency",
        unit="1",
        better="higher",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0, itself=1.0),
        "corrected": Laws(least=0.0, itself=1.0),
    },
)
RELATIVE_PATH_LENGTH = MetricComponent(
    spec=RelativePathLengthSpec,
    build="crowdbot.plugins.metrics.path_efficiency_build:RelativePathLength",
    summary="L_rp: length of the path alone, over length of the path in the crowd",
    label=ScoreLabel(
        metric="relative_path_length",
        symbol="L_rp",
        category="path efficiency",
        unit="1",
        better="higher",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0, itself=1.0),
        "corrected": Laws(least=0.0, itself=1.0),
    },
)
RELATIVE_JERK = MetricComponent(
    spec=RelativeJerkSpec,
    build="crowdbot.plugins.metrics.path_efficiency_build:RelativeJerk",
    summary="J_rp: jerk of the motion alone, over jerk of the motion in the crowd",
    label=ScoreLabel(
        metric="relative_jerk",
        symbol="J_rp",
        category="path efficiency",
        unit="1",
        better="higher",
        variants=("literal", "corrected", "linear", "angular", "norm", "legacy"),
    ),
    laws={
        "literal": Laws(itself=1.0, exceptions={"reflect": "the signed yaw rate changes its sign"}),
        "corrected": Laws(least=0.0, itself=1.0),
        "linear": Laws(least=0.0, itself=1.0),
        "angular": Laws(least=0.0, itself=1.0),
        "norm": Laws(least=0.0, itself=1.0),
        "legacy": Laws(
            least=0.0, itself=1.0, exceptions={"rotate": "|x| + |y| depends on the axes"}
        ),
    },
)

COMPONENTS = (
    RELATIVE_TIME_TO_GOAL,
    RELATIVE_PATH_LENGTH,
    RELATIVE_JERK,
)
