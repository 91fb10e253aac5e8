"""Claimed scores against those on new people."""

from __future__ import annotations

from crowdbot.core.bundle.fresh_verdict import with_fresh
from crowdbot.core.bundle.rerun_verdict import RerunVerdict
from tests.core.bundle.test_rerun_verdict import claimed, rerun, scored

MAIN = "safe_efficiency"


def _verdict(pairs: list[tuple[float, float]]) -> RerunVerdict:
    runs = [
        rerun(claimed(scored(MAIN, a, better="higher")), scored(MAIN, b, better="higher"))
        for a, b in pairs
    ]
    return with_fresh(RerunVerdict(outcome="verified"), runs)


def test_scores_that_hold_on_new_people_are_fine() -> None:
    found = _verdict([(0.50, 0.52), (0.61, 0.55), (0.43, 0.49), (0.70, 0.68), (0.58, 0.60)])
    assert (found.outcome, found.findings) == ("verified", ())
    assert found.fresh[0].startswith("safe_efficiency: claimed 0.564, on new people 0.568 (5 runs")


def test_scores_that_do_not_hold_are_told() -> None:
    found = _verdict([(0.90, 0.30), (0.91, 0.35), (0.88, 0.20), (0.95, 0.31), (0.93, 0.28)])
    assert found.outcome == "worse on new people"
    assert "learnt by heart" in found.findings[0]


def test_better_scores_and_few_pairs_accuse_no_planner() -> None:
    assert _verdict([(0.1, 0.9)] * 6).outcome == "verified"
    assert _verdict([(0.9, 0.1)] * 3).outcome == "verified"
    assert _verdict([(0.9, 0.1)] * 4).outcome == "worse on new people"


def test_another_outcome_stays() -> None:
    runs = [rerun(claimed(scored(MAIN, 0.9)), scored(MAIN, 0.1)) for _ in range(5)]
    assert with_fresh(RerunVerdict(outcome="suspicious"), runs).outcome == "suspicious"
