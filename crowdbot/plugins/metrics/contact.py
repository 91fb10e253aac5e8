"""What the simulator or the robot's skin felt."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec


class MaxContactForceSpec(MetricSpec):
    """Largest force between robot and people."""

    kind: Literal["max_contact_force"] = "max_contact_force"


class ContactImpulseSpec(MetricSpec):
    """Sum of the impulses between robot and people."""

    kind: Literal["contact_impulse"] = "contact_impulse"


class ContactTimeSpec(MetricSpec):
    """Sum of the durations of contacts between robot and people."""

    kind: Literal["contact_time"] = "contact_time"


MAX_CONTACT_FORCE = MetricComponent(
    spec=MaxContactForceSpec,
    build="crowdbot.plugins.metrics.contact_build:MaxContactForce",
    summary="F_max: largest force between robot and people",
    label=ScoreLabel(
        metric="max_contact_force",
        symbol="F_max",
        category="contact",
        unit="N",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up", mass=1),
    },
)
CONTACT_IMPULSE = MetricComponent(
    spec=ContactImpulseSpec,
    build="crowdbot.plugins.metrics.contact_build:ContactImpulse",
    summary="I: sum of the impulses between robot and people",
    label=ScoreLabel(
        metric="contact_impulse",
        symbol="I",
        category="contact",
        unit="N s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up", mass=1),
    },
)
CONTACT_TIME = MetricComponent(
    spec=ContactTimeSpec,
    build="crowdbot.plugins.metrics.contact_build:ContactTime",
    summary="T_c: sum of the durations of contacts between robot and people",
    label=ScoreLabel(
        metric="contact_time",
        symbol="T_c",
        category="contact",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)

COMPONENTS = (
    MAX_CONTACT_FORCE,
    CONTACT_IMPULSE,
    CONTACT_TIME,
)
