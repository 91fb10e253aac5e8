"""ScoreLabel: what all scores of one metric share; fills in the rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.score import Better, Score


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreLabel:
    """Name, symbol, category, unit and good direction of a metric (or of one variant)."""

    metric: str
    symbol: str
    category: str
    unit: str
    better: Better

    def ok(self, variant: str, value: float, extras: Mapping[str, float] | None = None) -> Score:
        """A score with a value."""
        return Score(**self._head(variant), value=float(value), extras=extras or {})

    def undefined(self, variant: str, reason: str) -> Score:
        """A score that does not exist, and why."""
        return Score(**self._head(variant), status="undefined", reason=reason)

    def censored(
        self, variant: str, reason: str, lower: float | None = None, upper: float | None = None
    ) -> Score:
        """A score that exists but was not seen to its end, with the bounds that are known."""
        return Score(
            **self._head(variant), status="censored", reason=reason, lower=lower, upper=upper
        )

    def ratio(
        self,
        variant: str,
        numerator: float,
        denominator: float,
        zero_tol: float,
        extras: Mapping[str, float] | None = None,
    ) -> Score:
        """A quotient; undefined (``zero_denominator``) when the denominator counts as zero."""
        if not denominator > zero_tol:
            return self.undefined(variant, "zero_denominator")
        return self.ok(variant, numerator / denominator, extras)

    def _head(self, variant: str) -> dict[str, Any]:
        return {
            "metric": self.metric,
            "symbol": self.symbol,
            "category": self.category,
            "unit": self.unit,
            "better": self.better,
            "variant": variant,
        }
