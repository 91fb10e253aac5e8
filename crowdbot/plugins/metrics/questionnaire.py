"""Metrics from questionnaires."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="questionnaire", unit="points")


class NasaTlxSpec(MetricSpec):
    """Workload by the NASA task load index."""

    kind: Literal["nasa_tlx"] = "nasa_tlx"


NASA_TLX = declare(
    NasaTlxSpec,
    symbol="TLX",
    better="lower",
    minimum=0.0,
    maximum=100.0,
    variants=("raw", "weighted"),
)


class UseSpec(MetricSpec):
    """Usability by the USE questionnaire."""

    kind: Literal["use"] = "use"


USE = declare(
    UseSpec,
    symbol="USE",
    better="higher",
    minimum=1.0,
    maximum=7.0,
    variants=("usefulness", "ease_of_use", "ease_of_learning", "satisfaction"),
)
