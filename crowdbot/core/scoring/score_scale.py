"""Properties of a score that its metric declares: bounds, and the exposure of a rate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.registry.registry import Registry


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreScale:
    """Scale of one variant, as its metric declares it.

    Attributes:
        minimum, maximum: bounds of every value, inclusive.
        integer: values are whole numbers; for a rate, its numerator is a count, such as contacts
            but not work.
        rate_over: variant of the same metric by which the rate is divided; empty: not a rate.
    """

    minimum: float = -math.inf
    maximum: float = math.inf
    integer: bool = False
    rate_over: str = ""


#: Scale of undeclared scores.
UNKNOWN = ScoreScale()
#: By metric and variant.
Scales = Mapping[tuple[str, str], ScoreScale]


def score_scales(registry: Registry) -> Scales:
    """Return the scales of all scores of the installed metrics."""
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
    """Return True if a rate's numerator is a count, which has no unit: 1/km, not J/m."""
    return bool(rate_over) and unit.startswith("1/")
