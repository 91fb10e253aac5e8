"""Distance between the surfaces of robot and people, and the zones of proxemics."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    Compliance,
    Intimate,
    Personal,
    Social,
)


class MinClearanceSpec(MetricSpec):
    """Least distance between the surfaces of robot and people."""

    kind: Literal["min_clearance"] = "min_clearance"


class AvgClearanceSpec(MetricSpec):
    """Mean distance between the surfaces of robot and nearest person."""

    kind: Literal["avg_clearance"] = "avg_clearance"


class IntimateTimeFractionSpec(MetricSpec):
    """Share of time with somebody in the intimate zone."""

    kind: Literal["intimate_time_fraction"] = "intimate_time_fraction"
    intimate: Intimate = 0.45


class PersonalTimeFractionSpec(MetricSpec):
    """Share of time with the nearest person in the personal zone."""

    kind: Literal["personal_time_fraction"] = "personal_time_fraction"
    intimate: Intimate = 0.45
    personal: Personal = 1.2


class SocialTimeFractionSpec(MetricSpec):
    """Share of time with the nearest person in the social zone."""

    kind: Literal["social_time_fraction"] = "social_time_fraction"
    personal: Personal = 1.2
    social: Social = 3.6


class SpaceComplianceSpec(MetricSpec):
    """Share of time with nobody nearer than a given gap."""

    kind: Literal["space_compliance"] = "space_compliance"
    compliance: Compliance = 0.5


MIN_CLEARANCE = MetricComponent(
    spec=MinClearanceSpec,
    build="crowdbot.plugins.metrics.clearance_build:MinClearance",
    summary="CD_min: least distance between the surfaces of robot and people",
    label=ScoreLabel(
        metric="min_clearance",
        symbol="CD_min",
        category="proximity",
        unit="m",
        better="higher",
    ),
    laws={
        "corrected": Laws(more_people="down"),
    },
)
AVG_CLEARANCE = MetricComponent(
    spec=AvgClearanceSpec,
    build="crowdbot.plugins.metrics.clearance_build:AvgClearance",
    summary="CD_avg: mean distance between the surfaces of robot and nearest person",
    experimental=True,
    label=ScoreLabel(
        metric="avg_clearance",
        symbol="CD_avg",
        category="proximity",
        unit="m",
        better="higher",
    ),
)
INTIMATE_TIME_FRACTION = MetricComponent(
    spec=IntimateTimeFractionSpec,
    build="crowdbot.plugins.metrics.clearance_build:IntimateTimeFraction",
    summary="f_int: share of time with somebody in the intimate zone",
    label=ScoreLabel(
        metric="intimate_time_fraction",
        symbol="f_int",
        category="proximity",
        unit="1",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0, more_people="up"),
    },
)
PERSONAL_TIME_FRACTION = MetricComponent(
    spec=PersonalTimeFractionSpec,
    build="crowdbot.plugins.metrics.clearance_build:PersonalTimeFraction",
    summary="f_pers: share of time with the nearest person in the personal zone",
    label=ScoreLabel(
        metric="personal_time_fraction",
        symbol="f_pers",
        category="proximity",
        unit="1",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0),
    },
)
SOCIAL_TIME_FRACTION = MetricComponent(
    spec=SocialTimeFractionSpec,
    build="crowdbot.plugins.metrics.clearance_build:SocialTimeFraction",
    summary="f_soc: share of time with the nearest person in the social zone",
    label=ScoreLabel(
        metric="social_time_fraction",
        symbol="f_soc",
        category="proximity",
        unit="1",
        better="none",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0),
    },
)
SPACE_COMPLIANCE = MetricComponent(
    spec=SpaceComplianceSpec,
    build="crowdbot.plugins.metrics.clearance_build:SpaceCompliance",
    summary="SC: share of time with nobody nearer than a given gap",
    label=ScoreLabel(
        metric="space_compliance",
        symbol="SC",
        category="proximity",
        unit="1",
        better="higher",
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0, more_people="down"),
    },
)

COMPONENTS = (
    MIN_CLEARANCE,
    AVG_CLEARANCE,
    INTIMATE_TIME_FRACTION,
    PERSONAL_TIME_FRACTION,
    SOCIAL_TIME_FRACTION,
    SPACE_COMPLIANCE,
)
