"""Whether, how directly and how steadily the robot reaches its goal."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    JumpSpeed,
    ProgressDistance,
    ProgressWindow,
    ReleaseGap,
    ZeroTol,
)


class SuccessSpec(MetricSpec):
    """1 if the robot arrived, else 0."""

    kind: Literal["success"] = "success"


class SuccessNoCollisionSpec(MetricSpec):
    """1 if the robot arrived without touching anybody, else 0."""

    kind: Literal["success_no_collision"] = "success_no_collision"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0


class SplSpec(MetricSpec):
    """Success, weighted by the shortest over the driven path length."""

    kind: Literal["spl"] = "spl"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class StlSpec(MetricSpec):
    """Success, weighted by the time alone over the time in the crowd."""

    kind: Literal["stl"] = "stl"
    zero_tol: ZeroTol = 1e-9


class TimeoutSpec(MetricSpec):
    """1 if the robot did not arrive, else 0."""

    kind: Literal["timeout"] = "timeout"


class FinalDistanceToGoalSpec(MetricSpec):
    """Distance from the robot's last position to the goal."""

    kind: Literal["final_distance_to_goal"] = "final_distance_to_goal"


class MinDistanceToGoalSpec(MetricSpec):
    """Least distance from the robot to the goal."""

    kind: Literal["min_distance_to_goal"] = "min_distance_to_goal"


class PathEfficiencySpec(MetricSpec):
    """Shortest path to the goal, over the driven path."""

    kind: Literal["path_efficiency"] = "path_efficiency"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class FailureToProgressSpec(MetricSpec):
    """Windows of time in which the robot came no nearer to the goal."""

    kind: Literal["failure_to_progress"] = "failure_to_progress"
    progress_window: ProgressWindow = 5.0
    progress_distance: ProgressDistance = 0.1


class AggregatedTimeSpec(MetricSpec):
    """Time to goal of the robot plus all trips of people."""

    kind: Literal["aggregated_time"] = "aggregated_time"


SUCCESS = MetricComponent(
    spec=SuccessSpec,
    build="crowdbot.plugins.metrics.task_build:Success",
    summary="S: 1 if the robot arrived, else 0",
    label=ScoreLabel(
        metric="success",
        symbol="S",
        category="task",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(whole=True, least=0.0, most=1.0),
    },
)
SUCCESS_NO_COLLISION = MetricComponent(
    spec=SuccessNoCollisionSpec,
    build="crowdbot.plugins.metrics.task_build:SuccessNoCollision",
    summary="S_C0: 1 if the robot arrived without touching anybody, else 0",
    label=ScoreLabel(
        metric="success_no_collision",
        symbol="S_C0",
        category="task",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(whole=True, least=0.0, most=1.0, more_people="down"),
    },
)
SPL = MetricComponent(
    spec=SplSpec,
    build="crowdbot.plugins.metrics.task_build:Spl",
    summary="SPL: success, weighted by the shortest over the driven path length",
    label=ScoreLabel(
        metric="spl",
        symbol="SPL",
        category="task",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0),
    },
)
STL = MetricComponent(
    spec=StlSpec,
    build="crowdbot.plugins.metrics.task_build:Stl",
    summary="STL: success, weighted by the time alone over the time in the crowd",
    experimental=True,
    label=ScoreLabel(
        metric="stl",
        symbol="STL",
        category="task",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0),
    },
)
TIMEOUT = MetricComponent(
    spec=TimeoutSpec,
    build="crowdbot.plugins.metrics.task_build:Timeout",
    summary="TO: 1 if the robot did not arrive, else 0",
    experimental=True,
    label=ScoreLabel(
        metric="timeout",
        symbol="TO",
        category="task",
        unit="1",
        better="lower",
    ),
    laws={
        "corrected": Laws(whole=True, least=0.0, most=1.0),
    },
)
FINAL_DISTANCE_TO_GOAL = MetricComponent(
    spec=FinalDistanceToGoalSpec,
    build="crowdbot.plugins.metrics.task_build:FinalDistanceToGoal",
    summary="DG_fin: distance from the robot's last position to the goal",
    label=ScoreLabel(
        metric="final_distance_to_goal",
        symbol="DG_fin",
        category="task",
        unit="m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
MIN_DISTANCE_TO_GOAL = MetricComponent(
    spec=MinDistanceToGoalSpec,
    build="crowdbot.plugins.metrics.task_build:MinDistanceToGoal",
    summary="DG_min: least distance from the robot to the goal",
    label=ScoreLabel(
        metric="min_distance_to_goal",
        symbol="DG_min",
        category="task",
        unit="m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
PATH_EFFICIENCY = MetricComponent(
    spec=PathEfficiencySpec,
    build="crowdbot.plugins.metrics.task_build:PathEfficiency",
    summary="PE: shortest path to the goal, over the driven path",
    experimental=True,
    label=ScoreLabel(
        metric="path_efficiency",
        symbol="PE",
        category="task",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
FAILURE_TO_PROGRESS = MetricComponent(
    spec=FailureToProgressSpec,
    build="crowdbot.plugins.metrics.task_build:FailureToProgress",
    summary="FP: windows of time in which the robot came no nearer to the goal",
    experimental=True,
    label=ScoreLabel(
        metric="failure_to_progress",
        symbol="FP",
        category="task",
        unit="1",
        better="lower",
    ),
    laws={
        "corrected": Laws(whole=True, least=0.0),
    },
)
AGGREGATED_TIME = MetricComponent(
    spec=AggregatedTimeSpec,
    build="crowdbot.plugins.metrics.task_build:AggregatedTime",
    summary="AT: time to goal of the robot plus all trips of people",
    experimental=True,
    label=ScoreLabel(
        metric="aggregated_time",
        symbol="AT",
        category="task",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)

COMPONENTS = (
    SUCCESS,
    SUCCESS_NO_COLLISION,
    SPL,
    STL,
    TIMEOUT,
    FINAL_DISTANCE_TO_GOAL,
    MIN_DISTANCE_TO_GOAL,
    PATH_EFFICIENCY,
    FAILURE_TO_PROGRESS,
    AGGREGATED_TIME,
)
