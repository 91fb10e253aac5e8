"""Metrics of the planner's computing time: wall clock, machine-dependent, never ranked."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(
    declare_metric, category="planner", spec_version=2, unit="s", better="none", minimum=0.0
)


class MeanPlannerTimeSpec(MetricSpec):
    """Mean time of a planner step."""

    kind: Literal["mean_planner_time"] = "mean_planner_time"


MEAN_PLANNER_TIME = declare(MeanPlannerTimeSpec, symbol="t_p")


class MaxPlannerTimeSpec(MetricSpec):
    """Longest time of a planner step."""

    kind: Literal["max_planner_time"] = "max_planner_time"


MAX_PLANNER_TIME = declare(MaxPlannerTimeSpec, symbol="t_p,max")
