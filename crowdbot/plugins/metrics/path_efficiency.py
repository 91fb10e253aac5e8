"""Metrics that compare the robot's time, path and smoothness alone and in the crowd."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    JerkWeight,
    JerkZeroTol,
    JumpSpeed,
    SamplingTol,
    ZeroTol,
)

declare = partial(
    declare_metric, category="path efficiency", spec_version=2, unit="1", better="higher"
)


class RelativeTimeToGoalSpec(MetricSpec):
    """Time to goal alone, over time to goal in the crowd."""

    kind: Literal["relative_time_to_goal"] = "relative_time_to_goal"
    zero_tol: ZeroTol


RELATIVE_TIME_TO_GOAL = declare(
    RelativeTimeToGoalSpec,
    symbol="T_rtg",
    minimum=0.0,
    variants={
        "literal": {"self_value": 1.0},
        "corrected": {"self_value": 1.0},
        "common": {},
    },
)


class RelativePathLengthSpec(MetricSpec):
    """Length of the path alone, over length of the path in the crowd."""

    kind: Literal["relative_path_length"] = "relative_path_length"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


RELATIVE_PATH_LENGTH = declare(
    RelativePathLengthSpec,
    symbol="L_rp",
    minimum=0.0,
    self_value=1.0,
    variants=("literal", "corrected"),
)


class RelativeJerkSpec(MetricSpec):
    """Jerk of the motion alone, over jerk of the motion in the crowd."""

    kind: Literal["relative_jerk"] = "relative_jerk"
    jerk_weight: JerkWeight
    jerk_zero_tol: JerkZeroTol
    sampling_tol: SamplingTol
    jump_speed: JumpSpeed


RELATIVE_JERK = declare(
    RelativeJerkSpec,
    symbol="J_rp",
    self_value=1.0,
    variants={
        "literal": {"changes_with": {"reflect": "the signed yaw rate changes its sign"}},
        "corrected": {"minimum": 0.0},
        "linear": {"minimum": 0.0},
        "angular": {"minimum": 0.0},
        "norm": {"minimum": 0.0},
        "legacy": {"minimum": 0.0, "changes_with": {"rotate": "|x| + |y| depends on the axes"}},
    },
)
