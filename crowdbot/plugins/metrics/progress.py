"""Metric of how far the robot moves, or is pushed, away from its goal."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import AwaySpeed

declare = partial(declare_metric, category="task")


class RegressSpec(MetricSpec):
    """Distance by which the goal recedes, and the share of time."""

    kind: Literal["regress"] = "regress"
    away_speed: AwaySpeed


REGRESS = declare(
    RegressSpec,
    symbol="DG_back",
    unit="m",
    better="lower",
    minimum=0.0,
    variants={"corrected": {}, "time_share": {"unit": "1", "maximum": 1.0}},
)
