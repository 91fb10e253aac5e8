"""Metrics of the burden on people: work done against pushes, and evasive accelerations."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    DemandRoom,
    DemandTime,
    EvasionReach,
    ForcedHeadway,
    JumpSpeed,
    LeastWay,
    UsualAcceleration,
)

declare = partial(declare_metric, category="burden", better="lower")


class PushWorkSpec(MetricSpec):
    """Work of pushing people aside, per metre of progress and per person met."""

    kind: Literal["push_work"] = "push_work"
    demand_time: DemandTime
    demand_room: DemandRoom
    usual_acceleration: UsualAcceleration
    forced_headway: ForcedHeadway
    least_way: LeastWay
    evasion_reach: EvasionReach
    jump_speed: JumpSpeed


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
    evasion_reach: EvasionReach
    jump_speed: JumpSpeed


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
