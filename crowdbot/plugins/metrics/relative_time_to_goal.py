"""Relative time to goal: how much longer the robot takes because of the crowd."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import MetricSpec


class RelativeTimeToGoalSpec(MetricSpec):
    """Time to goal alone, over time to goal in the crowd."""

    kind: Literal["relative_time_to_goal"] = "relative_time_to_goal"
    zero_tol: Annotated[float, Ge(0)] = Field(
        default=1e-9, description="A denominator up to this counts as zero, s."
    )


RELATIVE_TIME_TO_GOAL = Component(
    spec=RelativeTimeToGoalSpec,
    build="crowdbot.plugins.metrics.relative_time_to_goal_build:build",
    summary="T_rtg: time to goal alone over time to goal in the crowd",
)
