"""ScoreFactory: scores as the component of a metric declares them."""

from __future__ import annotations

from typing import Any, Literal

import pytest

from crowdbot.plugin import MetricSpec, Score, ScoreFactory, declare_metric


class GapSpec(MetricSpec):
    """Least gap to anybody."""

    kind: Literal["acme.gap"] = "acme.gap"


FACTORY = ScoreFactory(
    declare_metric(
        GapSpec,
        symbol="g",
        unit="m",
        better="higher",
        category="proximity",
        variants={"corrected": {}, "share": {"unit": "1", "better": "none"}},
    )
)
CORRECTED: dict[str, Any] = {
    "metric": "acme.gap",
    "symbol": "g",
    "category": "proximity",
    "variant": "corrected",
    "unit": "m",
    "better": "higher",
}
SHARE: dict[str, Any] = {**CORRECTED, "variant": "share", "unit": "1", "better": "none"}


def test_scores_carry_what_their_variant_declares() -> None:
    assert FACTORY.variants == ("corrected", "share")
    assert FACTORY.ok("corrected", 2, {"n": 1.0}) == Score(**CORRECTED, value=2.0, extras={"n": 1})
    assert FACTORY.ok("share", True) == Score(**SHARE, value=1.0)
    absent: dict[str, Any] = {"status": "undefined", "reason": "no_agents"}
    assert FACTORY.all_undefined("no_agents") == [
        Score(**CORRECTED, **absent),
        Score(**SHARE, **absent),
    ]
    assert FACTORY.all_undefined("no_agents", ["share"]) == [
        FACTORY.undefined("share", "no_agents")
    ]
    censored = FACTORY.censored("corrected", "goal_not_reached", lower=1.0)
    assert (censored.status, censored.lower, censored.upper) == ("censored", 1.0, None)


@pytest.mark.parametrize("denominator", [0.0, 1e-9, -1.0, float("nan")])
def test_a_ratio_without_denominator(denominator: float) -> None:
    assert FACTORY.ratio("share", 1.0, denominator, 1e-9).reason == "zero_denominator"
    assert FACTORY.ratio("share", 1.0, 2.0, 1e-9).value == 0.5


def test_a_variant_that_was_not_declared() -> None:
    with pytest.raises(ValueError, match=r"declares no variant 'shre', only corrected, share"):
        FACTORY.undefined("shre", "no_agents")
