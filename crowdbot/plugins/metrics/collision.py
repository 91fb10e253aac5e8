"""Metrics of contacts with people: number, rate and severity."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import declare_metric
from crowdbot.plugins.metrics.parameters import ContactMetricSpec, ZeroTol

declare = partial(
    declare_metric,
    category="collision",
    spec_version=2,
    better="lower",
    minimum=0.0,
    more_people="up",
)


class CollisionCountSpec(ContactMetricSpec):
    """Contacts of the robot with people; walls are not counted."""

    kind: Literal["collision_count"] = "collision_count"


COLLISION_COUNT = declare(
    CollisionCountSpec,
    symbol="C",
    unit="1",
    integer=True,
    variants={"literal": {"refinement": "free"}, "corrected": {"refinement": "same"}},
)


class CollisionSeveritySpec(ContactMetricSpec):
    """Energy of the robot's contacts with people."""

    kind: Literal["collision_severity"] = "collision_severity"


COLLISION_SEVERITY = declare(
    CollisionSeveritySpec,
    symbol="S_C",
    unit="J",
    refinement="same",
    mass_exponent=1,
    variants={
        "literal": {"refinement": "double"},
        "per_event": {},
        "corrected": {},
        "impulse": {"unit": "N s"},
    },
)


class CollisionRateSpec(ContactMetricSpec):
    """Contacts with people per time, and per length of the robot's path."""

    kind: Literal["collision_rate"] = "collision_rate"
    zero_tol: ZeroTol


COLLISION_RATE = declare(
    CollisionRateSpec,
    symbol="C_T",
    unit="1/s",
    experimental=True,
    refinement="same",
    variants={"per_time": {}, "per_length": {"unit": "1/m"}},
)


class CollisionsAtFaultSpec(ContactMetricSpec):
    """Contacts with people, split by who caused them."""

    kind: Literal["collisions_at_fault"] = "collisions_at_fault"


COLLISIONS_AT_FAULT = declare(
    CollisionsAtFaultSpec,
    symbol="C_f",
    unit="1",
    experimental=True,
    integer=True,
    refinement="same",
    variants=("robot", "person"),
)
