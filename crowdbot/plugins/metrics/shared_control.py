"""How user and shared control get along."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    SamplePeriod,
    ZeroTol,
)


class AgreementSpec(MetricSpec):
    """Agreement in direction of the user's command and the final one."""

    kind: Literal["agreement"] = "agreement"
    zero_tol: ZeroTol = 1e-9


class UserInputEntropySpec(MetricSpec):
    """Unpredictability of the user's commands."""

    kind: Literal["user_input_entropy"] = "user_input_entropy"
    sample_period: SamplePeriod = 0.15
    zero_tol: ZeroTol = 1e-9


class FluencySpec(MetricSpec):
    """Smoothness of the user's commands."""

    kind: Literal["fluency"] = "fluency"


AGREEMENT = MetricComponent(
    spec=AgreementSpec,
    build="crowdbot.plugins.metrics.shared_control_build:Agreement",
    summary="a: agreement in direction of the user's command and the final one",
    label=ScoreLabel(
        metric="agreement",
        symbol="a",
        category="shared control",
        unit="1",
        better="higher",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0, most=1.0),
        "corrected": Laws(least=0.0, most=1.0),
    },
)
USER_INPUT_ENTROPY = MetricComponent(
    spec=UserInputEntropySpec,
    build="crowdbot.plugins.metrics.shared_control_build:UserInputEntropy",
    summary="H: unpredictability of the user's commands",
    label=ScoreLabel(
        metric="user_input_entropy",
        symbol="H",
        category="shared control",
        unit="1",
        better="lower",
        variants=("literal", "corrected"),
    ),
    laws={
        "corrected": Laws(least=0.0, most=1.0),
    },
)
FLUENCY = MetricComponent(
    spec=FluencySpec,
    build="crowdbot.plugins.metrics.shared_control_build:Fluency",
    summary="F: smoothness of the user's commands",
    label=ScoreLabel(
        metric="fluency",
        symbol="F",
        category="shared control",
        unit="1",
        better="higher",
        variants=("literal", "corrected", "variation_rate"),
        units={"variation_rate": "1/s"},
        betters={"variation_rate": "lower"},
    ),
    laws={
        "literal": Laws(most=1.0),
        "corrected": Laws(least=-1.0, most=1.0),
        "variation_rate": Laws(least=0.0),
    },
)

COMPONENTS = (
    AGREEMENT,
    USER_INPUT_ENTROPY,
    FLUENCY,
)
