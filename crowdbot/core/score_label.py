"""ScoreLabel: what all scores of one metric share; MetricComponent: a metric's words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, SupportsFloat

from crowdbot.core.component import Component, S_co
from crowdbot.core.laws import Laws
from crowdbot.core.score import Better, Score


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreLabel:
    """Name, symbol, category, unit and good direction of a metric and its variants.

    Attributes:
        variants: names of all variants, in the order in which they are scored.
        units: variant -> unit, where it differs from ``unit``.
        betters: variant -> direction, where it differs from ``better``.
    """

    metric: str
    symbol: str
    category: str
    unit: str
    better: Better
    variants: tuple[str, ...] = ("corrected",)
    units: Mapping[str, str] = field(default_factory=dict)
    betters: Mapping[str, Better] = field(default_factory=dict)

    def ok(
        self, variant: str, value: SupportsFloat, extras: Mapping[str, float] | None = None
    ) -> Score:
        """A score with a value."""
        return Score(**self._head(variant), value=float(value), extras=extras or {})

    def undefined(self, variant: str, reason: str) -> Score:
        """A score that does not exist, and why."""
        return Score(**self._head(variant), status="undefined", reason=reason)

    def all_undefined(self, reason: str, variants: Iterable[str] | None = None) -> list[Score]:
        """All variants, or some, that do not exist for the same reason."""
        return [self.undefined(v, reason) for v in variants or self.variants]

    def censored(
        self,
        variant: str,
        reason: str,
        lower: float | None = None,
        upper: float | None = None,
        extras: Mapping[str, float] | None = None,
    ) -> Score:
        """A score that exists but was not seen to its end, with the bounds that are known."""
        return Score(
            **self._head(variant),
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
        """A quotient; undefined (``zero_denominator``) when the denominator counts as zero."""
        if not denominator > zero_tol:
            return self.undefined(variant, "zero_denominator")
        return self.ok(variant, numerator / denominator, extras)

    def _head(self, variant: str) -> dict[str, Any]:
        return {
            "metric": self.metric,
            "symbol": self.symbol,
            "category": self.category,
            "unit": self.units.get(variant, self.unit),
            "better": self.betters.get(variant, self.better),
            "variant": variant,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricComponent(Component[S_co]):
    """A metric: its spec, its deeds, the label that all its scores carry, and its laws.

    Attributes:
        laws: variant -> what it promises; a variant that is not listed keeps to the defaults.
        signals: names of the signals that it reads; the worlds of the conformance kit have them.
    """

    label: ScoreLabel
    laws: Mapping[str, Laws] = field(default_factory=dict)
    signals: tuple[str, ...] = ()
