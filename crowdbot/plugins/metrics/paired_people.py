"""How far the robot displaces people, and how long it delays them: each against himself."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.dsl import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import JumpSpeed, MuchDelay, MuchDisplacement, SameStart

declare = partial(declare_metric, category="burden")


class DisplacementSpec(MetricSpec):
    """Largest distance of people from the way that they walk without the robot."""

    kind: Literal["displacement"] = "displacement"
    much_displacement: MuchDisplacement
    same_start: SameStart
    jump_speed: JumpSpeed


DISPLACEMENT = declare(
    DisplacementSpec,
    symbol="D_p",
    unit="m",
    better="lower",
    self_value=0.0,
    variants={
        "corrected": {"minimum": 0.0},
        "worst": {"minimum": 0.0},
        "count": {"unit": "1", "minimum": 0.0, "integer": True, "more_people": "up"},
        "slope": {"unit": "s", "better": "none"},
    },
)


class DelaySpec(MetricSpec):
    """Time that people lose against their trips without the robot."""

    kind: Literal["delay"] = "delay"
    much_delay: MuchDelay
    same_start: SameStart
    jump_speed: JumpSpeed


DELAY = declare(
    DelaySpec,
    symbol="Δt_p",
    unit="s",
    better="lower",
    self_value=0.0,
    variants={
        "corrected": {},
        "worst": {},
        "count": {"unit": "1", "minimum": 0.0, "integer": True, "more_people": "up"},
        "slope": {"unit": "s²/m", "better": "none"},
    },
)

COMPONENTS = (
    DISPLACEMENT,
    DELAY,
)
