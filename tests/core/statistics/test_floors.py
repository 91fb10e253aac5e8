"""Whether a planner beats the floors, and who could be fooled by saying so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.statistics.floors import FloorCheck, check_floors
from crowdbot.core.statistics.summary import summarise
from tests.core.statistics.made_up_results import run, score

ROLES = {
    "blind": "floor",
    "still": "floor",
    "known": "baseline",
    "seer": "ceiling",
    "slow": "floor",
}
PRIMARY = "success_no_collision"


def results(
    values: Mapping[str, Sequence[float | None]],
    *,
    metric: str = PRIMARY,
    better: str = "higher",
    draws: Sequence[str] | None = None,
) -> Results:
    """One score of some planners; roles by `ROLES`, each scenario with a crowd of its own."""
    runs, scores = [], []
    for planner, found in values.items():
        for i, value in enumerate(found):
            draw = f"d{i}" if draws is None else draws[i]
            role = ROLES.get(planner, "candidate")
            runs.append(run(planner, f"s{i}", draw, role=role, privileged=role == "ceiling"))
            scores.append(score(runs[-1], value, metric=metric, better=better))
    return Results(runs=tuple(runs), scores=tuple(scores))


def check(planner: str, found: Results) -> FloorCheck:
    (one,) = (c for c in check_floors(found) if c.planner == planner)
    return one


def test_who_arrives_where_no_floor_does_beats_them() -> None:
    found = check("mine", results({"mine": [1.0] * 8, "blind": [0.0] * 8, "still": [0.0] * 8}))
    assert found.beats_all
    assert [lead.by.value for lead in found.leads] == [1.0, 1.0]
    assert found.text.startswith("mine beats the floors in success no collision: +1 [1, 1]")


def test_the_worst_floor_decides() -> None:
    found = check("mine", results({
        "mine": [1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0],
        "blind": [1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 0.0],
        "still": [0.0] * 8,
    }))  # fmt: skip
    assert not found.beats_all
    assert "mine does not beat the floors" in found.text
    assert "against blind" in found.text
    assert "still" not in found.text


def test_floors_are_not_checked_and_everybody_else_is() -> None:
    found = check_floors(results({p: [1.0] * 8 for p in ("blind", "known", "mine", "seer")}))
    assert [c.planner for c in found] == ["known", "mine", "seer"]
    assert not any(c.beats_all for c in found)


def test_without_floors_it_says_so() -> None:
    found = check("mine", results({"mine": [1.0] * 8, "known": [0.0] * 8}))
    assert not found.beats_all
    assert "no floor planner ran" in found.text


def test_a_floor_that_shares_no_scenario_is_none() -> None:
    one = results({"mine": [1.0] * 8})
    elsewhere = run("blind", "another", "d9", role="floor")
    found = Results(
        runs=(*one.runs, elsewhere),
        scores=(*one.scores, score(elsewhere, 0.0, metric=PRIMARY)),
    )
    assert check("mine", found).leads == ()


def test_two_crowds_prove_nothing() -> None:
    """With two draws that agree the interval has no width, and any two planners may agree."""
    found = check("mine", results({"mine": [1.0] * 2, "blind": [0.0] * 2}))
    assert found.leads[0].by.low == 1.0
    assert not found.beats_all
    assert "too few crowd draws: 2" in found.text


def test_nine_scenarios_with_one_crowd_are_one_witness() -> None:
    found = check("mine", results({"mine": [1.0] * 9, "blind": [0.0] * 9}, draws=["d"] * 9))
    assert not found.beats_all


def test_who_leaves_out_bad_runs_gains_nothing() -> None:
    good = results({"mine": [0.9] * 12, "blind": [0.5] * 12})
    assert check("mine", good).beats_all
    picked = results({"mine": [0.9] * 9 + [None] * 3, "blind": [0.5] * 12})
    assert not check("mine", picked).beats_all
    assert "3 of 12 pairs have no value" in check("mine", picked).text


def test_runs_that_could_not_be_made_are_not_arrivals() -> None:
    made = results({"mine": [1.0] * 4, "blind": [0.0] * 4 + [1.0] * 8})
    lost = tuple(
        Failure(suite="suite", scenario=f"s{i}", planner="mine", seed=0, error="", traceback="")
        for i in range(4, 12)
    )
    found = check("mine", Results(runs=made.runs, scores=made.scores, failures=lost))
    assert found.leads[0].pairs == 12
    assert found.leads[0].by.value == pytest.approx((4 - 8) / 12)


def test_less_is_better_where_the_score_says_so() -> None:
    values = {"mine": [0.1] * 8, "blind": [0.4] * 8}
    found = check("mine", results(values, better="lower"))
    assert found.beats_all
    assert found.leads[0].by.value == pytest.approx(0.3)


def test_the_first_of_the_primary_scores_that_there_is_decides() -> None:
    values = {"mine": [1.0] * 8, "blind": [0.0] * 8}
    worse = {"mine": [0.0] * 8, "blind": [1.0] * 8}
    both = results(values, metric="safe_efficiency")
    other = results(worse, metric="success")
    found = check("mine", Results(runs=both.runs, scores=(*both.scores, *other.scores)))
    assert (found.metric, found.beats_all) == ("safe_efficiency", True)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_exchanging_the_planners_turns_the_lead(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(2, 10)).tolist()
    there = check("mine", results({"mine": a, "blind": b})).leads[0]
    back = check("mine", results({"mine": b, "blind": a})).leads[0]
    assert there.by.value == pytest.approx(-(back.by.value or 0.0))
    assert there.by.low == pytest.approx(-(back.by.high or 0.0))
    assert (there.verdict == "ahead") == (back.verdict == "behind")


def test_floors_do_not_make_it_harder_to_tell_others_apart() -> None:
    rng = np.random.default_rng(8)
    two = {p: (rng.random(10) + shift).tolist() for p, shift in (("mine", 0.3), ("known", 0.0))}
    floors = {p: rng.random(10).tolist() for p in ("blind", "still")}
    alone, among = summarise(results(two)), summarise(results({**two, **floors}))
    (there,) = alone.comparisons
    (again,) = (c for c in among.comparisons if {c.a, c.b} == {"mine", "known"})
    assert again.p_holm == there.p_holm
    assert among.tests == alone.tests == 1
    others = [c for c in among.comparisons if {c.a, c.b} & floors.keys()]
    assert len(others) == 5
    assert any(c.p_holm != c.p for c in others)  # which are corrected for each other


def test_equal_planners_are_seldom_told_apart() -> None:
    """No more often than in 1 of 40 on either side; 200 suites of 18 draws."""
    rng = np.random.default_rng(5)
    ahead = 0
    for _ in range(200):
        a, b = (rng.random((2, 18)) < 0.6).astype(float).tolist()
        ahead += check("mine", results({"mine": a, "blind": b})).beats_all
    assert ahead <= 12  # 5 are expected; more than 12 with probability 0.002


def test_a_reason_that_leads_share_is_said_once() -> None:
    values: dict[str, list[float | None]]
    values = {"mine": [1.0, 0.0], "blind": [0.0, 0.0], "still": [0.0, 0.0], "slow": [0.0, 1.0]}
    shared = check("mine", results(values, draws=["d", "d"])).text
    assert shared.count("(") == 1
    assert shared.endswith("(all: one crowd draw: its chance cannot be told from a difference)")
    alone = check("mine", results({"mine": [1.0], "blind": [0.0]})).text
    assert alone.endswith("(one crowd draw: its chance cannot be told from a difference)")
    values = {"mine": [1.0] * 3, "blind": [0.0] * 3, "still": [0.0, None, None]}
    apart = check("mine", results(values)).text
    assert apart.count("(") == 2
