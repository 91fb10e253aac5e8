"""What follows from runs that were made again; no honest team is accused."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.bundle.manifest import BundledRun
from crowdbot.core.bundle.rerun_verdict import FINE, Rerun, verdict_of
from crowdbot.core.bundle.tolerances import SPREADS, variant_of
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.four_scores import MAIN_SCORES
from crowdbot.core.types.score import Score
from tests.core.results.made_up_record import made_up_record

HERE = {"processor": "znver3", "rounding": "aa"}
VERSIONS = {"crowdbot": "0.1.0"}


def scored(metric: str = "risk", value: float | None = 1.0, **more: Any) -> Score:
    status = "ok" if value is not None else "undefined"
    values: dict[str, Any] = {"symbol": "R", "category": "c", "variant": "corrected", "unit": "s",
                              "better": "lower", "status": status, **more}  # fmt: skip
    return Score(metric=metric, value=value, **values)


def record(trajectory: str = "t", **more: Any) -> RunRecord:
    values = {"machine": HERE, "versions": VERSIONS, "metrics": {"risk": {"spec_version": 1}}}
    return made_up_record(**{"trajectory_hash": trajectory, **values, **more})


def claimed(*scores: Score, number: int = 0, **more: Any) -> ClaimedRun:
    entry = BundledRun(scenario=f"s{number}", seed=0, directory="d", run_id="r", trajectory="t")
    return ClaimedRun(entry=entry, record=record(**more), scores=scores or (scored(),))


def rerun(run: ClaimedRun, *scores: Score, **more: Any) -> Rerun:
    repeated = more.pop("repeated", None)
    found = Rerun(claimed=run, record=record(**more), scores=scores or (scored(),))
    return replace(found, repeated=repeated)


def test_the_same_trajectory_and_scores_are_verified() -> None:
    found = verdict_of([rerun(claimed())])
    assert (found.outcome, found.findings) == ("verified", ())
    assert found.relations == {"s0 seed-0": "identical"}


@pytest.mark.parametrize(("claim", "why"), [
    ({"status": "timeout"}, "status is claimed to be 'timeout', but is 'planner_failed'"),
    ({"goal_time": 3.0}, "goal_time is claimed to be 3.0, but is None"),
    ({"sim_time": 4.0}, "sim_time is claimed to be 4.0, but is 2.0"),
    ({"privileged": False}, "privileged is claimed to be False"),
    ({"role": "floor"}, "role is claimed to be 'floor', but is 'candidate'"),
    ({"conditions": {"rates.log": "8 Hz"}}, "conditions differ from those of the suite: rates.log"),
    ({"metrics": {"risk": {"spec_version": 1, "horizon": 9.0}}}, "metrics differ from those"),
    ({"reference_hashes": {"robot_alone": "x"}}, "reference_hashes does not follow from the run"),
])  # fmt: skip
def test_records_that_the_trajectory_does_not_bear_out(claim: dict[str, Any], why: str) -> None:
    true: dict[str, Any] = {
        "status": "planner_failed", "goal_time": None, "sim_time": 2.0, "privileged": True,
        "conditions": {"rates.log": "16 Hz"},
    }  # fmt: skip
    found = verdict_of([rerun(claimed(**{**true, **claim}), **true)])
    assert found.outcome == "suspicious"
    assert why in found.findings[0]
    assert verdict_of([rerun(claimed(**true), **true)]).outcome == "verified"


@pytest.mark.parametrize(("claim", "why"), [
    (scored(value=0.5), "risk.corrected is claimed to be 0.5, but the same trajectory gives 1.0"),
    (scored(value=None, reason="no_agents"), "is claimed to be undefined"),
    (scored(unit="ms"), "is claimed"),
    (scored(variant="better"), "there is no such score"),
])  # fmt: skip
def test_scores_that_the_trajectory_does_not_give(claim: Score, why: str) -> None:
    found = verdict_of([rerun(claimed(claim))])
    assert found.outcome == "suspicious"
    assert why in found.findings[0]


def test_a_score_that_was_left_out() -> None:
    run = claimed(scored("risk"))
    found = verdict_of([rerun(run, scored("risk"), scored("spl"))])
    assert found.findings == ("s0 seed-0: spl.corrected was left out",)


def test_times_of_the_wall_clock_are_nobodys_fault() -> None:
    run = claimed(scored("mean_planner_time", 1.0))
    assert verdict_of([rerun(run, scored("mean_planner_time", 9.0))]).outcome == "verified"


def test_other_versions_of_a_metric_are_not_compared() -> None:
    run = claimed(scored(value=0.5), metrics={"risk": {"spec_version": 2}})
    found = verdict_of([rerun(run)])
    assert (found.outcome, found.not_comparable) == ("not comparable", ("risk",))
    assert found.findings == (
        "risk is not comparable: version 2 was scored; here it has version 1",
    )
    elsewhere = rerun(run, trajectory="x", machine={"processor": "skylake"})
    assert verdict_of([elsewhere]).outcome == "not comparable"


def test_people_of_an_unlocked_suite_are_those_that_are_drawn() -> None:
    true = {"hashes": {"realisation": "cb1-sha256:aa", "trajectory": "t"}}
    run = claimed(hashes={"realisation": "cb1-sha256:bb", "trajectory": "t"})
    found = verdict_of([rerun(run, **true)])
    assert found.outcome == "suspicious"
    assert "its people are claimed to have the hash cb1-sha256:bb" in found.findings[0]


def test_another_trajectory_on_the_same_platform_is_suspicious() -> None:
    found = verdict_of([rerun(claimed(), trajectory="x", repeated="x")])
    assert found.outcome == "suspicious"
    assert "another one on the same processor (znver3)" in found.findings[0]


@pytest.mark.parametrize("there", [
    {"machine": {"processor": "skylake", "rounding": "aa"}},
    {"machine": {"processor": "znver3", "rounding": "bb"}},
    {"machine": {"processor": "znver3"}},
    {"machine": {}},
    {"versions": {"crowdbot": "0.2.0"}},
])  # fmt: skip
def test_another_trajectory_on_another_platform_is_not(there: dict[str, Any]) -> None:
    found = verdict_of([rerun(claimed(), trajectory="x", **there)])
    assert found.outcome == "within tolerance"
    assert found.relations == {"s0 seed-0": "different_platform"}


def test_planners_that_do_not_repeat_themselves_are_not_accused() -> None:
    found = verdict_of([rerun(claimed(), trajectory="x", repeated="y")])
    assert (found.outcome, found.relations) == (
        "nondeterministic",
        {"s0 seed-0": "nondeterministic"},
    )
    assert found.outcome not in FINE
    assert found.findings == ()


def test_another_processor_does_not_hide_a_planner_that_does_not_repeat_itself() -> None:
    there = {"machine": {"processor": "skylake"}}
    found = verdict_of([rerun(claimed(), trajectory="x", repeated="y", **there)])
    assert found.outcome == "nondeterministic"
    assert verdict_of([rerun(claimed(), trajectory="x", repeated="x", **there)]).outcome in FINE


def test_scores_without_a_tolerance_are_named() -> None:
    run = claimed(scored("risk"), scored("made_up"), scored("mean_planner_time"))
    found = verdict_of([rerun(run, scored("risk"), trajectory="x", machine={"processor": "sky"})])
    assert found.not_compared == ("made_up.corrected",)
    assert verdict_of([rerun(run, *run.scores)]).not_compared == ()


def test_each_main_score_has_a_tolerance() -> None:
    for score in MAIN_SCORES:
        assert variant_of(score.metric) == score.variant


def test_equal_trajectories_on_another_platform_still_bear_out_their_scores() -> None:
    run = claimed(scored(value=0.5), scored("spl", 0.5))
    there = rerun(run, scored(), scored("spl", 0.6), machine={"processor": "skylake"})
    own = replace(there, own=frozenset({("risk", "corrected")}))
    assert verdict_of([own]).findings == (
        "s0 seed-0: risk.corrected is claimed to be 0.5, but the same trajectory gives 1.0",
    )
    assert verdict_of([replace(there, own=frozenset())]).outcome == "verified"


def on_different_platform(gaps: np.ndarray[Any, Any]) -> list[Rerun]:
    return [
        rerun(claimed(scored(value=10.0 + gap), number=i), scored(value=10.0), trajectory="x",
              machine={"processor": "skylake"})
        for i, gap in enumerate(gaps.tolist())
    ]  # fmt: skip


@pytest.mark.slow
def test_honest_scatter_is_never_accused() -> None:
    rng = np.random.default_rng(8)
    spread = SPREADS["risk"]
    for _ in range(500):
        # published spreads are twice what was measured; heavy tails as of chaos
        gaps = spread / 2 * rng.standard_t(5, size=20) * (3 / 5) ** 0.5
        assert verdict_of(on_different_platform(gaps)).outcome == "within tolerance"


def test_scores_that_are_all_too_good_are_noticed() -> None:
    gaps = np.random.default_rng(9).normal(-2.0 * SPREADS["risk"], SPREADS["risk"] / 2, size=20)
    found = verdict_of(on_different_platform(gaps))
    assert found.outcome == "suspicious"
    assert "risk is off by" in found.findings[-1]
    assert "on the mean of 20 runs" in found.findings[-1]


def test_one_impossible_score_is_noticed() -> None:
    found = verdict_of(on_different_platform(np.array([0.0, -11.0 * SPREADS["risk"], 0.0])))
    assert found.findings[0].startswith("s1 seed-0: risk is off by -")


def test_a_metric_that_does_not_exist_here_is_never_verified() -> None:
    run = claimed(
        scored(),
        scored("glory"),
        metrics={"risk": {"spec_version": 1}, "glory": {"spec_version": 1}},
    )
    found = verdict_of([rerun(run)])
    assert (found.outcome, found.not_comparable) == ("not comparable", ("glory",))
    assert "here there is no such metric" in found.findings[0]
