"""The ranking rule: what is ahead, behind, tied, traded and open."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.scoring.score_scale import ScoreScale
from crowdbot.core.statistics.ranking import rank
from crowdbot.core.statistics.rules import orders
from crowdbot.core.statistics.table import Table
from tests.core.statistics.made_up_results import run, score

SCALES = {
    ("contacts_per_km", "at_fault"): ScoreScale(minimum=0.0, rate_over="way"),
    ("intrusion", "rate"): ScoreScale(minimum=0.0, rate_over="way"),
    ("safe_efficiency", "corrected"): ScoreScale(minimum=0.0, maximum=1.0),
}
NOISE = np.random.default_rng(3).uniform(-0.02, 0.02, size=(3, 20))
NOISE -= NOISE.mean(axis=1, keepdims=True)


def table(a: tuple[float, float | None, float | None], spread: float = 0.0) -> Table:
    """Planner b has 0.6, 2 contacts per km and 0.1; a has efficiency, contacts and intrusion.

    The efficiency of a is higher by ``spread`` in every second draw, and lower in the others.
    """
    runs, scores = [], []
    for planner, (efficiency, contacts, intrusion) in (("a", a), ("b", (0.6, 2.0, 0.1))):
        for i in range(20):
            arrived = intrusion is not None
            made = run(planner, f"s{i}", f"d{i}", status="arrived" if arrived else "timeout")
            runs.append(made)
            e, c, n = NOISE[:, i] if planner == "a" else np.zeros(3)
            e += spread * (-1) ** i if planner == "a" else 0.0
            rows: list[tuple[str, str, float | None, str]] = [
                ("safe_efficiency", "corrected", efficiency and efficiency + e, "higher"),
                ("contacts_per_km", "at_fault", contacts and contacts + c, "lower"),
                ("contacts_per_km", "way", 0.04, "none"),
                ("intrusion", "rate", intrusion and intrusion + n, "lower"),
                ("intrusion", "way", 40.0, "none"),
            ]
            scores += [
                score(made, value, metric=metric, variant=variant, better=better)
                for metric, variant, value, better in rows
            ]
    return Table(Results(runs=tuple(runs), scores=tuple(scores), scales=SCALES))


@pytest.mark.parametrize(
    ("a", "standing"),
    [
        ((0.8, 2.0, 0.1), "ahead"),
        ((0.6, 2.0, 0.03), "ahead"),
        ((0.8, 0.0, 0.03), "ahead"),
        ((0.8, 9.0, 0.1), "traded"),  # faster by force
        ((0.8, 2.0, 0.5), "traded"),
        ((0.3, 2.0, 0.1), "behind"),
        ((0.3, 0.0, 0.1), "traded"),  # safer and slower
        ((0.599, 2.0, 0.099), "tied"),
        ((0.599, 0.0, 0.099), "tied"),  # only safer
        ((0.0, 0.0, 0.0), "traded"),  # quits
        ((0.0, None, None), "behind"),  # parks
    ],
)
def test_standings(a: tuple[float, float | None, float | None], standing: str) -> None:
    (found,) = rank(table(a), [("a", "b")])
    assert found.standing == standing
    (back,) = rank(table(a), [("b", "a")])
    opposite = {"ahead": "behind", "behind": "ahead"}
    assert back.standing == opposite.get(standing, standing)


@pytest.mark.parametrize(
    ("a", "ranks"),
    [
        ((0.8, 2.0, 0.1), {"the ranking rule": 1, "efficiency alone": 1, "safety first": 1}),
        ((0.8, 9.0, 0.1), {"the ranking rule": 1, "efficiency alone": 1, "safety first": 2}),
        ((0.3, 0.0, 0.1), {"the ranking rule": 1, "efficiency alone": 2, "safety first": 1}),
        ((0.3, 2.0, 0.1), {"the ranking rule": 2, "acceptance alone": 1, "safety first": 2}),
        ((0.6, 2.0, 0.03), {"efficiency alone": 1, "acceptance alone": 1, "safety first": 1}),
    ],
)
def test_other_rules_order_otherwise(a: tuple[float, float, float], ranks: dict[str, int]) -> None:
    found = orders(table(a))
    assert {o.name: o.ranks["a"] for o in found.orders if o.name in ranks} == ranks
    assert found.rule.name == "the ranking rule"


def test_the_correction_hides_no_loss() -> None:
    """Many comparisons must not turn a slower planner that people accept more into one ahead."""
    found = rank(table((0.57, 2.0, 0.03), spread=0.06), [("a", "b"), ("b", "a")])
    one = found[0].aspects["efficiency"]
    assert one.p is not None
    assert one.p_holm is not None
    assert one.p <= 0.05 < one.p_holm
    assert one.verdict == "not distinguishable"
    assert found[0].aspects["acceptance"].verdict == "better"
    assert {x.standing for x in found} == {"traded"}


@pytest.mark.parametrize(("spread", "standing"), [(0.02, "ahead"), (0.2, "open")])
def test_few_runs_hide_no_loss(spread: float, standing: str) -> None:
    """Who gains in acceptance is ahead only if a loss in efficiency above 0.05 is excluded."""
    found = rank(table((0.595, 2.0, 0.03), spread=spread), [("a", "b")])[0]
    assert found.aspects["acceptance"].verdict == "better"
    assert found.standing == standing
    assert orders(table((0.595, 2.0, 0.03), spread=spread)).rule.ranks["b"] == 1 + (spread < 0.1)


def test_the_verdict_is_a_sentence() -> None:
    assert orders(table((0.8, 2.0, 0.1))).verdict == "a is ahead of b"
    assert orders(table((0.3, 2.0, 0.1))).verdict == "b is ahead of a"
    traded = orders(table((0.8, 9.0, 0.1)))
    assert traded.verdict == "no planner is ahead of another by the ranking rule"
    assert all(traded.rule.shares_rank(planner) for planner in "ab")


def test_no_rule_orders_without_an_aspect() -> None:
    whole = table((0.8, 2.0, 0.1))
    results = Results(
        runs=tuple(whole.runs.values()),
        scores=tuple(
            score(made, value, metric="safe_efficiency", variant="corrected", better="higher")
            for (planner, _), made in whole.runs.items()
            for value in [0.9 if planner == "a" else 0.1]
        ),
        scales=SCALES,
    )
    found = orders(Table(results))
    assert found.missing == ("safety", "acceptance")
    assert set(found.rule.ranks.values()) == {1}
    assert "needs scores that no run has: safety, acceptance" in found.verdict
