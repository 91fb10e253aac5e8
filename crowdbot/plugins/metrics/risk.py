"""Metrics of time to collision."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    HorizonMetricSpec,
    JumpSpeed,
    RelSpeedTol,
)

declare = partial(
    declare_metric, category="collision", minimum=0.0, better="lower", spec_version=2, unit="s"
)


class RiskSpec(HorizonMetricSpec):
    """Imminence of the next collision, summed over the run."""

    kind: Literal["risk"] = "risk"


RISK = declare(
    RiskSpec,
    symbol="R",
    spec_version=3,
    variants={
        "literal": {"better": "none", "refinement": "double"},
        "corrected": {"better": "none", "more_people": "up"},
        "exposed_time": {"better": "none", "more_people": "up"},
        "rate": {"unit": "1", "maximum": 1.0, "more_people": "up"},
        "disc": {"unit": "1", "maximum": 1.0, "more_people": "up"},
    },
)


class ExpectedSeveritySpec(HorizonMetricSpec):
    """Imminence of the next collision, weighted by the squared relative speed."""

    kind: Literal["expected_severity"] = "expected_severity"


EXPECTED_SEVERITY = declare(
    ExpectedSeveritySpec,
    symbol="S_R",
    unit="m²/s",
    variants={
        "literal": {"better": "none", "refinement": "double"},
        "corrected": {"better": "none"},
        "rate": {"unit": "m²/s²"},
    },
)


class TimeExposedSpec(HorizonMetricSpec):
    """Time during which a collision is nearer than the horizon."""

    kind: Literal["time_exposed"] = "time_exposed"


TIME_EXPOSED = declare(
    TimeExposedSpec,
    symbol="TET",
    more_people="up",
    variants={"corrected": {"better": "none"}, "rate": {"unit": "1", "maximum": 1.0}},
)


class IntegratedTimeToCollisionSpec(HorizonMetricSpec):
    """Shortfall of the time to collision below the horizon, integrated over the run."""

    kind: Literal["integrated_time_to_collision"] = "integrated_time_to_collision"


INTEGRATED_TIME_TO_COLLISION = declare(
    IntegratedTimeToCollisionSpec,
    symbol="TIT",
    unit="s²",
    more_people="up",
    variants={"corrected": {"better": "none"}, "rate": {"unit": "s"}},
)


class MinTimeToCollisionSpec(MetricSpec):
    """Smallest time to collision in the run."""

    kind: Literal["min_time_to_collision"] = "min_time_to_collision"
    contact_tol: ContactTol
    rel_speed_tol: RelSpeedTol
    jump_speed: JumpSpeed


MIN_TIME_TO_COLLISION = declare(
    MinTimeToCollisionSpec,
    symbol="TTC_min",
    better="higher",
    experimental=True,
    more_people="down",
    variants=("corrected", "disc"),
)
