"""How long the planner thinks."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec


class MeanPlannerTimeSpec(MetricSpec):
    """Mean time of a planner step."""

    kind: Literal["mean_planner_time"] = "mean_planner_time"


class MaxPlannerTimeSpec(MetricSpec):
    """Longest time of a planner step."""

    kind: Literal["max_planner_time"] = "max_planner_time"


MEAN_PLANNER_TIME = MetricComponent(
    spec=MeanPlannerTimeSpec,
    build="crowdbot.plugins.metrics.planner_time_build:MeanPlannerTime",
    summary="t_p: mean time of a planner step",
    label=ScoreLabel(
        metric="mean_planner_time",
        symbol="t_p",
        category="planner",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
MAX_PLANNER_TIME = MetricComponent(
    spec=MaxPlannerTimeSpec,
    build="crowdbot.plugins.metrics.planner_time_build:MaxPlannerTime",
    summary="t_p,max: longest time of a planner step",
    label=ScoreLabel(
        metric="max_planner_time",
        symbol="t_p,max",
        category="planner",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)

COMPONENTS = (
    MEAN_PLANNER_TIME,
    MAX_PLANNER_TIME,
)
