"""What people answer when asked."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec


class NasaTlxSpec(MetricSpec):
    """Workload by the NASA task load index."""

    kind: Literal["nasa_tlx"] = "nasa_tlx"


class UseSpec(MetricSpec):
    """Usability by the USE questionnaire."""

    kind: Literal["use"] = "use"


NASA_TLX = MetricComponent(
    spec=NasaTlxSpec,
    build="crowdbot.plugins.metrics.questionnaire_build:NasaTlx",
    summary="TLX: workload by the NASA task load index",
    label=ScoreLabel(
        metric="nasa_tlx",
        symbol="TLX",
        category="questionnaire",
        unit="points",
        better="lower",
        variants=("raw", "weighted"),
    ),
    laws={
        "raw": Laws(least=0.0, most=100.0),
        "weighted": Laws(least=0.0, most=100.0),
    },
)
USE = MetricComponent(
    spec=UseSpec,
    build="crowdbot.plugins.metrics.questionnaire_build:Use",
    summary="USE: usability by the USE questionnaire",
    label=ScoreLabel(
        metric="use",
        symbol="USE",
        category="questionnaire",
        unit="points",
        better="higher",
        variants=("usefulness", "ease_of_use", "ease_of_learning", "satisfaction"),
    ),
    laws={
        "usefulness": Laws(least=1.0, most=7.0),
        "ease_of_use": Laws(least=1.0, most=7.0),
        "ease_of_learning": Laws(least=1.0, most=7.0),
        "satisfaction": Laws(least=1.0, most=7.0),
    },
)

COMPONENTS = (
    NASA_TLX,
    USE,
)
