"""Metrics of the burden on people: work done against pushes, and evasive accelerations."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="burden", better="lower")


class PushWorkSpec(MetricSpec):
    """Work of pushing people aside, per metre of progress and per person met."""

    kind: Literal["push_work"] = "push_work"
    demand_time: parameters.DemandTime
    demand_room: parameters.DemandRoom
    usual_acceleration: parameters.UsualAcceleration
    forced_headway: parameters.ForcedHeadway
    least_way: parameters.LeastWay
    evasion_reach: parameters.EvasionReach
    jump_speed: parameters.JumpSpeed


PUSH_WORK = declare(
    PushWorkSpec,
    symbol="W_push",
    spec_version=4,
    unit="J",
    variants={
        "rate": {"minimum": 0.0, "unit": "J/m", "mass_exponent": 1, "rate_over": "way"},
        "forced": {"minimum": 0.0, "unit": "J/m", "mass_exponent": 1, "rate_over": "way"},
        "corrected": {"minimum": 0.0, "mass_exponent": 1},
        "total": {"minimum": 0.0, "more_people": "up", "better": "none", "mass_exponent": 1},
        "excess": {"self_value": 0.0, "mass_exponent": 1},
        "way": {"minimum": 0.0, "unit": "m", "better": "none"},
    },
)


class EvasiveAccelerationSpec(MetricSpec):
    """Accelerations of people near the robot."""

    kind: Literal["evasive_acceleration"] = "evasive_acceleration"
    evasion_reach: parameters.EvasionReach
    jump_speed: parameters.JumpSpeed


EVASIVE_ACCELERATION = declare(
    EvasiveAccelerationSpec,
    symbol="a_ev",
    spec_version=2,
    unit="m/s²",
    minimum=0.0,
    variants={
        "corrected": {},
        "all": {},
        "peak": {"more_people": "up"},
        "rms": {},
        "excess": {"self_value": 0.0},
    },
)
