"""Distance between the surfaces of robot and people, and the zones of proxemics."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import Compliance, Intimate, Personal, Social

declare = partial(declare_metric, category="proximity", unit="1")


class MinClearanceSpec(MetricSpec):
    """Least distance between the surfaces of robot and people."""

    kind: Literal["min_clearance"] = "min_clearance"


MIN_CLEARANCE = declare(
    MinClearanceSpec,
    symbol="CD_min",
    spec_version=2,
    unit="m",
    better="higher",
    more_people="down",
    variants=("corrected", "disc"),
)


class AvgClearanceSpec(MetricSpec):
    """Mean distance between the surfaces of robot and nearest person."""

    kind: Literal["avg_clearance"] = "avg_clearance"


AVG_CLEARANCE = declare(
    AvgClearanceSpec, symbol="CD_avg", unit="m", better="higher", experimental=True
)


class IntimateTimeFractionSpec(MetricSpec):
    """Share of time with a person in the intimate zone."""

    kind: Literal["intimate_time_fraction"] = "intimate_time_fraction"
    intimate: Intimate


INTIMATE_TIME_FRACTION = declare(
    IntimateTimeFractionSpec,
    symbol="f_int",
    better="lower",
    minimum=0.0,
    maximum=1.0,
    more_people="up",
)


class PersonalTimeFractionSpec(MetricSpec):
    """Share of time with the nearest person in the personal zone."""

    kind: Literal["personal_time_fraction"] = "personal_time_fraction"
    intimate: Intimate
    personal: Personal


PERSONAL_TIME_FRACTION = declare(
    PersonalTimeFractionSpec, symbol="f_pers", better="lower", minimum=0.0, maximum=1.0
)


class SocialTimeFractionSpec(MetricSpec):
    """Share of time with the nearest person in the social zone."""

    kind: Literal["social_time_fraction"] = "social_time_fraction"
    personal: Personal
    social: Social


SOCIAL_TIME_FRACTION = declare(
    SocialTimeFractionSpec, symbol="f_soc", better="none", minimum=0.0, maximum=1.0
)


class SpaceComplianceSpec(MetricSpec):
    """Share of time with no person nearer than a given gap."""

    kind: Literal["space_compliance"] = "space_compliance"
    compliance: Compliance


SPACE_COMPLIANCE = declare(
    SpaceComplianceSpec, symbol="SC", better="higher", minimum=0.0, maximum=1.0, more_people="down"
)
