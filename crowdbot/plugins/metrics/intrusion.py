"""Metric of how far the robot advances on people who have little room."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    Compliance,
    EvasionReach,
    JumpSpeed,
    LeastWay,
    Room,
    TimeGap,
)

declare = partial(declare_metric, category="proximity")


class IntrusionSpec(MetricSpec):
    """Distance over which the robot drives at people with little time or room, per progress."""

    kind: Literal["intrusion"] = "intrusion"
    time_gap: TimeGap
    room: Room
    least_way: LeastWay
    compliance: Compliance
    evasion_reach: EvasionReach
    jump_speed: JumpSpeed


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
