"""What is known of the values of a score before any run: bounds, and what it is a rate over."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.registry.registry import Registry


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreScale:
    """Of one variant of a metric, as the metric declares it.

    Attributes:
        minimum, maximum: bounds of every value, inclusive.
        integer: values are whole numbers; of a rate, what is counted: contacts are, work is not.
        rate_over: variant of the same metric that the value is a rate over; empty: not a rate.
    """

    minimum: float = -math.inf
    maximum: float = math.inf
    integer: bool = False
    rate_over: str = ""


#: Of scores that nobody has declared.
UNKNOWN = ScoreScale()
#: By metric and variant.
Scales = Mapping[tuple[str, str], ScoreScale]


def score_scales(registry: Registry) -> Scales:
    """The scales of all scores of the installed metrics."""
    metrics: Mapping[str, Any] = registry.components("metric")
    return {
        (kind, name): ScoreScale(
            minimum=variant.invariants.minimum,
            maximum=variant.invariants.maximum,
            integer=variant.invariants.integer or _counts(variant.rate_over, variant.unit),
            rate_over=variant.rate_over,
        )
        for kind, metric in metrics.items()
        for name, variant in metric.variants.items()
    }


def _counts(rate_over: str, unit: str) -> bool:
    """Whether a rate is one of things that are counted, which have no unit: 1/km, not J/m."""
    return bool(rate_over) and unit.startswith("1/")
