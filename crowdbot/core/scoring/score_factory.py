"""ScoreFactory: builds the scores of one metric from its declaration."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, SupportsFloat

from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.metric_component import MetricComponent


@dataclass(frozen=True, slots=True)
class ScoreFactory:
    """Builds scores with the symbol, category, unit and direction of a metric.

    Attributes:
        metric: the component that declares the metric.

    Raises:
        ValueError: from any method, if the metric declares no such variant.
    """

    metric: MetricComponent[Any]

    @property
    def variants(self) -> tuple[str, ...]:
        """Names of all variants, in the order in which they are scored."""
        return tuple(self.metric.variants)

    def ok(
        self, variant: str, value: SupportsFloat, extras: Mapping[str, float] | None = None
    ) -> Score:
        """Return a score with a value."""
        return Score(**self._common(variant), value=float(value), extras=extras or {})

    def undefined(self, variant: str, reason: str) -> Score:
        """Return an undefined score with its reason."""
        return Score(**self._common(variant), status="undefined", reason=reason)

    def all_undefined(self, reason: str, variants: Iterable[str] | None = None) -> list[Score]:
        """Return all variants, or some, as undefined for the same reason."""
        return [self.undefined(v, reason) for v in variants or self.variants]

    def censored(
        self,
        variant: str,
        reason: str,
        lower: float | None = None,
        upper: float | None = None,
        extras: Mapping[str, float] | None = None,
    ) -> Score:
        """Return a score whose true value was not observed to the end, with its known bounds."""
        return Score(
            **self._common(variant),
            status="censored",
            reason=reason,
            lower=lower,
            upper=upper,
            extras=extras or {},
        )

    def ratio(
        self,
        variant: str,
        numerator: float,
        denominator: float,
        zero_tol: float,
        extras: Mapping[str, float] | None = None,
    ) -> Score:
        """Return a quotient; undefined (``zero_denominator``) if the denominator counts as zero."""
        if not denominator > zero_tol:
            return self.undefined(variant, "zero_denominator")
        return self.ok(variant, numerator / denominator, extras)

    def _common(self, variant: str) -> dict[str, Any]:
        """Return the fields of a score that do not depend on the run."""
        metric = self.metric
        if variant not in metric.variants:
            declared = ", ".join(metric.variants)
            raise ValueError(f"'{metric.kind}' declares no variant '{variant}', only {declared}")
        return {
            "metric": metric.kind,
            "symbol": metric.symbol,
            "category": metric.score_category,
            "unit": metric.variants[variant].unit,
            "better": metric.variants[variant].better,
            "variant": variant,
        }
