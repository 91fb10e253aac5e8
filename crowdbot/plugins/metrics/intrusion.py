"""Metric of how far the robot advances on people who have little room."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="proximity")


class IntrusionSpec(MetricSpec):
    """Distance over which the robot drives at people with little time or room, per progress."""

    kind: Literal["intrusion"] = "intrusion"
    time_gap: parameters.TimeGap
    room: parameters.Room
    least_way: parameters.LeastWay
    compliance: parameters.Compliance
    evasion_reach: parameters.EvasionReach
    jump_speed: parameters.JumpSpeed


INTRUSION = declare(
    IntrusionSpec,
    symbol="L_in",
    spec_version=3,
    unit="m",
    better="lower",
    minimum=0.0,
    variants={
        "rate": {"unit": "1", "rate_over": "way"},
        "hurried": {"unit": "1", "rate_over": "way"},
        "corrected": {},
        "total": {"better": "none", "more_people": "up"},
        "way": {"better": "none"},
    },
)
