"""Metrics of agreement between user and shared control."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import SamplePeriod, ZeroTol

declare = partial(declare_metric, category="shared control", unit="1", better="higher")


class AgreementSpec(MetricSpec):
    """Agreement in direction of the user's command and the final one."""

    kind: Literal["agreement"] = "agreement"
    zero_tol: ZeroTol


AGREEMENT = declare(
    AgreementSpec,
    symbol="a",
    minimum=0.0,
    maximum=1.0,
    variants=("literal", "corrected"),
    build="crowdbot.plugins.metrics.shared_control_build:AgreementMetric",
)


class UserInputEntropySpec(MetricSpec):
    """Unpredictability of the user's commands."""

    kind: Literal["user_input_entropy"] = "user_input_entropy"
    sample_period: SamplePeriod
    zero_tol: ZeroTol


USER_INPUT_ENTROPY = declare(
    UserInputEntropySpec,
    symbol="H",
    better="lower",
    variants={"literal": {}, "corrected": {"minimum": 0.0, "maximum": 1.0}},
    spec_version=2,
)


class FluencySpec(MetricSpec):
    """Smoothness of the user's commands."""

    kind: Literal["fluency"] = "fluency"


FLUENCY = declare(
    FluencySpec,
    symbol="F",
    variants={
        "literal": {"maximum": 1.0},
        "corrected": {"minimum": -1.0, "maximum": 1.0},
        "variation_rate": {"unit": "1/s", "better": "lower", "minimum": 0.0},
    },
)
