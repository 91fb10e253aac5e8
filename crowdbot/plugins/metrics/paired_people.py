"""Metrics of displacement and delay of each person, against the same person without the robot."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="burden", better="lower", self_value=0.0)


class DisplacementSpec(MetricSpec):
    """Displacement of people who meet the robot from the path that they walk without it."""

    kind: Literal["displacement"] = "displacement"
    much_displacement: parameters.MuchDisplacement
    neighbour_radius: parameters.NeighbourRadius
    after_meeting: parameters.AfterMeeting
    same_start: parameters.SameStart
    jump_speed: parameters.JumpSpeed


DISPLACEMENT = declare(
    DisplacementSpec,
    symbol="D_p",
    unit="m",
    variants={
        "corrected": {"minimum": 0.0},
        "worst": {"minimum": 0.0},
        "count": {"unit": "1", "minimum": 0.0, "integer": True, "more_people": "up"},
        "slope": {"unit": "s", "better": "none"},
        "whole": {"better": "none", "minimum": 0.0},
    },
)


class DelaySpec(MetricSpec):
    """Time that people who meet the robot lose compared with their trips without it."""

    kind: Literal["delay"] = "delay"
    much_delay: parameters.MuchDelay
    neighbour_radius: parameters.NeighbourRadius
    after_meeting: parameters.AfterMeeting
    same_start: parameters.SameStart
    jump_speed: parameters.JumpSpeed


DELAY = declare(
    DelaySpec,
    symbol="Δt_p",
    unit="s",
    variants={
        "corrected": {},
        "worst": {},
        "count": {"unit": "1", "minimum": 0.0, "integer": True, "more_people": "up"},
        "slope": {"unit": "s²/m", "better": "none"},
        "whole": {"better": "none"},
    },
)
