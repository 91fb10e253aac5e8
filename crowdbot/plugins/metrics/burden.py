"""What people have to do for the robot: work, and sudden changes of their way."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.dsl import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import EvasionReach, JumpSpeed

declare = partial(declare_metric, category="burden")


class PushWorkSpec(MetricSpec):
    """Work of pushing people aside, per person met."""

    kind: Literal["push_work"] = "push_work"
    evasion_reach: EvasionReach
    jump_speed: JumpSpeed


PUSH_WORK = declare(
    PushWorkSpec,
    symbol="W_push",
    unit="J",
    better="lower",
    mass_exponent=1,
    variants={
        "corrected": {"minimum": 0.0},
        "total": {"minimum": 0.0, "more_people": "up", "better": "none"},
        "excess": {"self_value": 0.0},
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
    unit="m/s²",
    better="lower",
    minimum=0.0,
    variants={
        "corrected": {},
        "peak": {"more_people": "up"},
        "rms": {},
        "excess": {"self_value": 0.0},
    },
)

COMPONENTS = (
    PUSH_WORK,
    EVASIVE_ACCELERATION,
)
