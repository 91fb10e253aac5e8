"""The odds of finding edited runs."""

from __future__ import annotations

import pytest

from crowdbot.core.bundle.odds import odds_of_finding


@pytest.mark.parametrize(
    ("again", "one", "many"), [(5, 0.03, 0.41), (10, 0.06, 0.66), (20, 0.12, 0.89)]
)
def test_odds_in_a_suite_of_162_runs(again: int, one: float, many: float) -> None:
    odds = odds_of_finding(162, again)
    assert odds[1] == pytest.approx(one, abs=0.005)
    assert odds[16] == pytest.approx(many, abs=0.01)


def test_all_or_none() -> None:
    assert set(odds_of_finding(6, 6).values()) == {1.0}
    assert set(odds_of_finding(6, 0).values()) == {0.0}
