"""What the robot does to the time and speed of the people."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    JumpSpeed,
    NeighbourRadius,
    ZeroTol,
)


class EffectOnTimeSpec(MetricSpec):
    """Mean duration of people's trips without the robot, over the one with it."""

    kind: Literal["effect_on_time"] = "effect_on_time"
    zero_tol: ZeroTol = 1e-9


class EffectOnVelocitySpec(MetricSpec):
    """Mean walking speed without the robot, over mean walking speed with it."""

    kind: Literal["effect_on_velocity"] = "effect_on_velocity"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class NeighboursTimeToGoalSpec(MetricSpec):
    """Mean trip duration of people who meet the robot, over the one of all people."""

    kind: Literal["neighbours_time_to_goal"] = "neighbours_time_to_goal"
    neighbour_radius: NeighbourRadius = 3.0
    zero_tol: ZeroTol = 1e-9


class NeighboursVelocitySpec(MetricSpec):
    """Mean walking speed near the robot, over mean walking speed of all people."""

    kind: Literal["neighbours_velocity"] = "neighbours_velocity"
    neighbour_radius: NeighbourRadius = 3.0
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class CrowdDeviationSpec(MetricSpec):
    """Mean distance between people's positions with and without the robot."""

    kind: Literal["crowd_deviation"] = "crowd_deviation"


EFFECT_ON_TIME = MetricComponent(
    spec=EffectOnTimeSpec,
    build="crowdbot.plugins.metrics.crowd_effect_build:EffectOnTime",
    summary="E_t: mean duration of people's trips without the robot, over the one with it",
    label=ScoreLabel(
        metric="effect_on_time",
        symbol="E_t",
        category="effect on crowd",
        unit="1",
        better="higher",
        variants=("literal", "corrected", "restricted"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0, itself=1.0),
        "restricted": Laws(least=0.0, itself=1.0),
    },
)
EFFECT_ON_VELOCITY = MetricComponent(
    spec=EffectOnVelocitySpec,
    build="crowdbot.plugins.metrics.crowd_effect_build:EffectOnVelocity",
    summary="E_v: mean walking speed without the robot, over mean walking speed with it",
    label=ScoreLabel(
        metric="effect_on_velocity",
        symbol="E_v",
        category="effect on crowd",
        unit="1",
        better="lower",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0, itself=1.0),
    },
)
NEIGHBOURS_TIME_TO_GOAL = MetricComponent(
    spec=NeighboursTimeToGoalSpec,
    build="crowdbot.plugins.metrics.crowd_effect_build:NeighboursTimeToGoal",
    summary="N_ttg: mean trip duration of people who meet the robot, over the one of all people",
    label=ScoreLabel(
        metric="neighbours_time_to_goal",
        symbol="N_ttg",
        category="effect on crowd",
        unit="1",
        better="lower",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)
NEIGHBOURS_VELOCITY = MetricComponent(
    spec=NeighboursVelocitySpec,
    build="crowdbot.plugins.metrics.crowd_effect_build:NeighboursVelocity",
    summary="N_v: mean walking speed near the robot, over mean walking speed of all people",
    label=ScoreLabel(
        metric="neighbours_velocity",
        symbol="N_v",
        category="effect on crowd",
        unit="1",
        better="higher",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)
CROWD_DEVIATION = MetricComponent(
    spec=CrowdDeviationSpec,
    build="crowdbot.plugins.metrics.crowd_effect_build:CrowdDeviation",
    summary="CD: mean distance between people's positions with and without the robot",
    experimental=True,
    label=ScoreLabel(
        metric="crowd_deviation",
        symbol="CD",
        category="effect on crowd",
        unit="m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, itself=0.0),
    },
)

COMPONENTS = (
    EFFECT_ON_TIME,
    EFFECT_ON_VELOCITY,
    NEIGHBOURS_TIME_TO_GOAL,
    NEIGHBOURS_VELOCITY,
    CROWD_DEVIATION,
)
