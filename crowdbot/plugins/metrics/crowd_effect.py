"""Metrics of the robot's effect on the time and speed of people."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import JumpSpeed, NeighbourRadius, ZeroTol

declare = partial(
    declare_metric, category="effect on crowd", minimum=0.0, unit="1", better="reference"
)


class EffectOnTimeSpec(MetricSpec):
    """Mean duration of people's trips without the robot, over the one with it."""

    kind: Literal["effect_on_time"] = "effect_on_time"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


EFFECT_ON_TIME = declare(
    EffectOnTimeSpec,
    symbol="E_t",
    spec_version=3,
    variants={
        "literal": {"better": "higher"},
        "corrected": {"self_value": 1.0},
        "restricted": {"self_value": 1.0},
        "pace": {"self_value": 1.0},
    },
)


class EffectOnVelocitySpec(MetricSpec):
    """Mean walking speed without the robot, over mean walking speed with it."""

    kind: Literal["effect_on_velocity"] = "effect_on_velocity"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


EFFECT_ON_VELOCITY = declare(
    EffectOnVelocitySpec,
    symbol="E_v",
    spec_version=2,
    variants={"literal": {"better": "lower"}, "corrected": {"self_value": 1.0}},
)


class NeighboursTimeToGoalSpec(MetricSpec):
    """Mean trip duration of people who meet the robot, over the one of all people."""

    kind: Literal["neighbours_time_to_goal"] = "neighbours_time_to_goal"
    neighbour_radius: NeighbourRadius
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


NEIGHBOURS_TIME_TO_GOAL = declare(
    NeighboursTimeToGoalSpec,
    symbol="N_ttg",
    spec_version=2,
    better="lower",
    variants=("literal", "corrected", "pace"),
)


class NeighboursVelocitySpec(MetricSpec):
    """Mean walking speed near the robot, over mean walking speed of all people."""

    kind: Literal["neighbours_velocity"] = "neighbours_velocity"
    neighbour_radius: NeighbourRadius
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


NEIGHBOURS_VELOCITY = declare(
    NeighboursVelocitySpec,
    symbol="N_v",
    spec_version=2,
    variants={"literal": {"better": "higher"}, "corrected": {}},
)


class CrowdDeviationSpec(MetricSpec):
    """Mean distance between people's positions with and without the robot."""

    kind: Literal["crowd_deviation"] = "crowd_deviation"


CROWD_DEVIATION = declare(
    CrowdDeviationSpec, symbol="CD", unit="m", better="lower", experimental=True, self_value=0.0
)
