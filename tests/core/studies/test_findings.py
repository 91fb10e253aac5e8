"""Comparison of conditions with participants as the random factor."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.stats import t as student

from crowdbot.core.studies.findings import adjusted, compare, smallest_p


def rows(values: dict[str, dict[str, list[float | None]]]) -> list[dict[str, Any]]:
    """Rows of drives: condition -> participant -> a value for each trial."""
    return [
        {"participant": p, "condition": c, "x.y": v}
        for c, by_person in values.items()
        for p, found in by_person.items()
        for v in found
    ]


VALUES: dict[str, dict[str, list[float | None]]] = {
    "alone": {"p1": [4.0, 6.0], "p2": [8.0, 8.0], "p3": [7.0, None], "p4": [9.0, 5.0]},
    "helped": {"p1": [3.0, 3.0], "p2": [5.0, 7.0], "p3": [6.0, 4.0], "p4": [4.0, 4.0]},
}


def test_trials_are_averaged_before_participants_are() -> None:
    alone, helped = compare(rows(VALUES), ["alone", "helped"], "x.y")
    assert alone.values == {"p1": 5.0, "p2": 8.0, "p3": 7.0, "p4": 7.0}
    gains = np.array([-2.0, -2.0, -2.0, -3.0])
    half = student.ppf(0.975, 3) * gains.std(ddof=1) / 2.0
    assert helped.gain.value == pytest.approx(-2.25)
    assert helped.gain.low == pytest.approx(-2.25 - half)
    assert helped.gain.high == pytest.approx(-2.25 + half)
    assert (helped.pairs, alone.pairs, alone.p) == (4, 0, None)
    assert helped.p == smallest_p(4) == 0.125  # all four went down: as rare as it can be


def test_more_trials_are_not_more_participants() -> None:
    """Ten times the same drives give the same interval and p."""
    tenfold = {c: {p: v * 10 for p, v in by.items()} for c, by in VALUES.items()}
    for one, ten in zip(
        compare(rows(VALUES), ["alone", "helped"], "x.y"),
        compare(rows(tenfold), ["alone", "helped"], "x.y"),
        strict=True,
    ):
        assert one.mean == ten.mean
        assert one.gain == ten.gain
        assert one.p == ten.p


def test_only_pairs_are_compared_and_nothing_is_no_value() -> None:
    values: dict[str, dict[str, list[float | None]]] = {
        "alone": {"p1": [1.0], "p2": [2.0]}, "helped": {"p1": [2.0], "p3": [9.0]}, "late": {},
    }  # fmt: skip
    _, helped, late = compare(rows(values), ["alone", "helped", "late"], "x.y")
    assert (helped.pairs, helped.gain.value, helped.p) == (1, 1.0, None)
    assert (late.mean.value, late.pairs) == (None, 0)


def test_holm_counts_all_tests_of_a_report() -> None:
    found = compare(rows(VALUES), ["alone", "helped"], "x.y")
    (_, one), three = adjusted(found), adjusted([*found, *found, *found])
    assert one.adjusted == 0.125
    assert [f.adjusted for f in three if f.p is not None] == [0.375] * 3
