"""Metrics that compare the robot's time, path and smoothness alone and in the crowd."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(
    declare_metric, category="path efficiency", spec_version=2, unit="1", better="higher"
)


class RelativeTimeToGoalSpec(MetricSpec):
    """Time to goal alone, over time to goal in the crowd."""

    kind: Literal["relative_time_to_goal"] = "relative_time_to_goal"
    zero_tol: parameters.ZeroTol


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
    zero_tol: parameters.ZeroTol
    jump_speed: parameters.JumpSpeed


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
    jerk_weight: parameters.JerkWeight
    jerk_zero_tol: parameters.JerkZeroTol
    sampling_tol: parameters.SamplingTol
    jump_speed: parameters.JumpSpeed


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
