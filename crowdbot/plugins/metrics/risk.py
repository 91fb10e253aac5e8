"""How near in time the next collision is."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    JumpSpeed,
    RelSpeedTol,
    RiskHorizon,
)


class RiskSpec(MetricSpec):
    """Imminence of the next collision, summed over the run."""

    kind: Literal["risk"] = "risk"
    risk_horizon: RiskHorizon = 5.0
    contact_tol: ContactTol = 1e-9
    rel_speed_tol: RelSpeedTol = 1e-6
    jump_speed: JumpSpeed = 10.0


class ExpectedSeveritySpec(MetricSpec):
    """Imminence of the next collision, weighted by the squared relative speed."""

    kind: Literal["expected_severity"] = "expected_severity"
    risk_horizon: RiskHorizon = 5.0
    contact_tol: ContactTol = 1e-9
    rel_speed_tol: RelSpeedTol = 1e-6
    jump_speed: JumpSpeed = 10.0


class TimeExposedSpec(MetricSpec):
    """Time during which a collision is nearer than the horizon."""

    kind: Literal["time_exposed"] = "time_exposed"
    risk_horizon: RiskHorizon = 5.0
    contact_tol: ContactTol = 1e-9
    rel_speed_tol: RelSpeedTol = 1e-6
    jump_speed: JumpSpeed = 10.0


class IntegratedTimeToCollisionSpec(MetricSpec):
    """Shortfall of the time to collision below the horizon, integrated over the run."""

    kind: Literal["integrated_time_to_collision"] = "integrated_time_to_collision"
    risk_horizon: RiskHorizon = 5.0
    contact_tol: ContactTol = 1e-9
    rel_speed_tol: RelSpeedTol = 1e-6
    jump_speed: JumpSpeed = 10.0


class MinTimeToCollisionSpec(MetricSpec):
    """Least time to collision of the run."""

    kind: Literal["min_time_to_collision"] = "min_time_to_collision"
    contact_tol: ContactTol = 1e-9
    rel_speed_tol: RelSpeedTol = 1e-6
    jump_speed: JumpSpeed = 10.0


RISK = MetricComponent(
    spec=RiskSpec,
    build="crowdbot.plugins.metrics.risk_build:Risk",
    summary="R: imminence of the next collision, summed over the run",
    label=ScoreLabel(
        metric="risk",
        symbol="R",
        category="collision",
        unit="s",
        better="lower",
        variants=("literal", "corrected", "exposed_time"),
        betters={"literal": "none"},
    ),
    laws={
        "literal": Laws(least=0.0, finer="double"),
        "corrected": Laws(least=0.0, more_people="up"),
        "exposed_time": Laws(least=0.0, more_people="up"),
    },
)
EXPECTED_SEVERITY = MetricComponent(
    spec=ExpectedSeveritySpec,
    build="crowdbot.plugins.metrics.risk_build:ExpectedSeverity",
    summary="S_R: imminence of the next collision, weighted by the squared relative speed",
    label=ScoreLabel(
        metric="expected_severity",
        symbol="S_R",
        category="collision",
        unit="m²/s",
        better="lower",
        variants=("literal", "corrected"),
        betters={"literal": "none"},
    ),
    laws={
        "literal": Laws(least=0.0, finer="double"),
        "corrected": Laws(least=0.0),
    },
)
TIME_EXPOSED = MetricComponent(
    spec=TimeExposedSpec,
    build="crowdbot.plugins.metrics.risk_build:TimeExposed",
    summary="TET: time during which a collision is nearer than the horizon",
    label=ScoreLabel(
        metric="time_exposed",
        symbol="TET",
        category="collision",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)
INTEGRATED_TIME_TO_COLLISION = MetricComponent(
    spec=IntegratedTimeToCollisionSpec,
    build="crowdbot.plugins.metrics.risk_build:IntegratedTimeToCollision",
    summary="TIT: shortfall of the time to collision below the horizon, integrated over the run",
    label=ScoreLabel(
        metric="integrated_time_to_collision",
        symbol="TIT",
        category="collision",
        unit="s²",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)
MIN_TIME_TO_COLLISION = MetricComponent(
    spec=MinTimeToCollisionSpec,
    build="crowdbot.plugins.metrics.risk_build:MinTimeToCollision",
    summary="TTC_min: least time to collision of the run",
    experimental=True,
    label=ScoreLabel(
        metric="min_time_to_collision",
        symbol="TTC_min",
        category="collision",
        unit="s",
        better="higher",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="down"),
    },
)

COMPONENTS = (
    RISK,
    EXPECTED_SEVERITY,
    TIME_EXPOSED,
    INTEGRATED_TIME_TO_COLLISION,
    MIN_TIME_TO_COLLISION,
)
