"""Contacts of the robot with people: how many, how hard."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    JumpSpeed,
    ReleaseGap,
    ZeroTol,
)


class CollisionCountSpec(MetricSpec):
    """Contacts of the robot with people; walls are not counted."""

    kind: Literal["collision_count"] = "collision_count"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0


class CollisionSeveritySpec(MetricSpec):
    """Energy of the robot's contacts with people."""

    kind: Literal["collision_severity"] = "collision_severity"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0


class CollisionRateSpec(MetricSpec):
    """Contacts with people per time, and per length of the robot's path."""

    kind: Literal["collision_rate"] = "collision_rate"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0
    zero_tol: ZeroTol = 1e-9


class CollisionsAtFaultSpec(MetricSpec):
    """Contacts with people that the robot, or that the person ran into."""

    kind: Literal["collisions_at_fault"] = "collisions_at_fault"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0


COLLISION_COUNT = MetricComponent(
    spec=CollisionCountSpec,
    build="crowdbot.plugins.metrics.collision_build:CollisionCount",
    summary="C: contacts of the robot with people; walls are not counted",
    label=ScoreLabel(
        metric="collision_count",
        symbol="C",
        category="collision",
        unit="1",
        better="lower",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(whole=True, least=0.0, more_people="up", finer="free"),
        "corrected": Laws(whole=True, least=0.0, more_people="up", finer="same"),
    },
)
COLLISION_SEVERITY = MetricComponent(
    spec=CollisionSeveritySpec,
    build="crowdbot.plugins.metrics.collision_build:CollisionSeverity",
    summary="S_C: energy of the robot's contacts with people",
    label=ScoreLabel(
        metric="collision_severity",
        symbol="S_C",
        category="collision",
        unit="J",
        better="lower",
        variants=("literal", "per_event", "corrected", "impulse"),
        units={"impulse": "N s"},
    ),
    laws={
        "literal": Laws(least=0.0, more_people="up", finer="double", mass=1),
        "per_event": Laws(least=0.0, more_people="up", finer="same", mass=1),
        "corrected": Laws(least=0.0, more_people="up", finer="same", mass=1),
        "impulse": Laws(least=0.0, more_people="up", finer="same", mass=1),
    },
)
COLLISION_RATE = MetricComponent(
    spec=CollisionRateSpec,
    build="crowdbot.plugins.metrics.collision_build:CollisionRate",
    summary="C_T: contacts with people per time, and per length of the robot's path",
    experimental=True,
    label=ScoreLabel(
        metric="collision_rate",
        symbol="C_T",
        category="collision",
        unit="1/s",
        better="lower",
        variants=("per_time", "per_length"),
        units={"per_length": "1/m"},
    ),
    laws={
        "per_time": Laws(least=0.0, more_people="up", finer="same"),
        "per_length": Laws(least=0.0, more_people="up", finer="same"),
    },
)
COLLISIONS_AT_FAULT = MetricComponent(
    spec=CollisionsAtFaultSpec,
    build="crowdbot.plugins.metrics.collision_build:CollisionsAtFault",
    summary="C_f: contacts with people that the robot, or that the person ran into",
    experimental=True,
    label=ScoreLabel(
        metric="collisions_at_fault",
        symbol="C_f",
        category="collision",
        unit="1",
        better="lower",
        variants=("robot", "person"),
    ),
    laws={
        "robot": Laws(whole=True, least=0.0, more_people="up", finer="same"),
        "person": Laws(whole=True, least=0.0, more_people="up", finer="same"),
    },
)

COMPONENTS = (
    COLLISION_COUNT,
    COLLISION_SEVERITY,
    COLLISION_RATE,
    COLLISIONS_AT_FAULT,
)
