"""Metrics of reaching the goal: success, directness and progress."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="task", minimum=0.0, unit="1")


class SuccessSpec(MetricSpec):
    """1 if the robot arrived, else 0."""

    kind: Literal["success"] = "success"


SUCCESS = declare(
    SuccessSpec, symbol="S", spec_version=2, better="higher", maximum=1.0, integer=True
)


class SuccessNoCollisionSpec(parameters.ContactMetricSpec):
    """1 if the robot arrived without touching anyone, else 0."""

    kind: Literal["success_no_collision"] = "success_no_collision"


SUCCESS_NO_COLLISION = declare(
    SuccessNoCollisionSpec,
    symbol="S_C0",
    spec_version=2,
    better="higher",
    maximum=1.0,
    integer=True,
    more_people="down",
)


class SplSpec(MetricSpec):
    """Success, weighted by shortest path length over driven path length."""

    kind: Literal["spl"] = "spl"
    zero_tol: parameters.ZeroTol
    jump_speed: parameters.JumpSpeed


SPL = declare(SplSpec, symbol="SPL", better="higher", maximum=1.0)


class StlSpec(MetricSpec):
    """Success, weighted by time alone over time in the crowd."""

    kind: Literal["stl"] = "stl"
    zero_tol: parameters.ZeroTol


STL = declare(
    StlSpec, symbol="STL", spec_version=2, better="higher", experimental=True, maximum=1.0
)


class TimeoutSpec(MetricSpec):
    """1 if the robot did not arrive, else 0."""

    kind: Literal["timeout"] = "timeout"


TIMEOUT = declare(
    TimeoutSpec,
    symbol="TO",
    spec_version=2,
    better="lower",
    experimental=True,
    maximum=1.0,
    integer=True,
)


class FinalDistanceToGoalSpec(MetricSpec):
    """Distance from the robot's last position to the goal."""

    kind: Literal["final_distance_to_goal"] = "final_distance_to_goal"


FINAL_DISTANCE_TO_GOAL = declare(FinalDistanceToGoalSpec, symbol="DG_fin", unit="m", better="lower")


class MinDistanceToGoalSpec(MetricSpec):
    """Least distance from the robot to the goal."""

    kind: Literal["min_distance_to_goal"] = "min_distance_to_goal"


MIN_DISTANCE_TO_GOAL = declare(MinDistanceToGoalSpec, symbol="DG_min", unit="m", better="lower")


class PathEfficiencySpec(MetricSpec):
    """Shortest path to the goal, divided by the driven path."""

    kind: Literal["path_efficiency"] = "path_efficiency"
    zero_tol: parameters.ZeroTol
    jump_speed: parameters.JumpSpeed


PATH_EFFICIENCY = declare(
    PathEfficiencySpec, symbol="PE", spec_version=2, better="higher", experimental=True
)


class FailureToProgressSpec(MetricSpec):
    """Time windows in which the robot came no nearer to the goal."""

    kind: Literal["failure_to_progress"] = "failure_to_progress"
    progress_window: parameters.ProgressWindow
    progress_distance: parameters.ProgressDistance


FAILURE_TO_PROGRESS = declare(
    FailureToProgressSpec, symbol="FP", better="lower", experimental=True, integer=True
)


class AggregatedTimeSpec(MetricSpec):
    """Time to goal of the robot plus all trips of people."""

    kind: Literal["aggregated_time"] = "aggregated_time"


AGGREGATED_TIME = declare(
    AggregatedTimeSpec,
    symbol="AT",
    spec_version=2,
    unit="s",
    better="lower",
    experimental=True,
    more_people="up",
)
