"""A campaign runs the user's planners before floors, and says what the reference scores hold."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from crowdbot.cli.output.campaign_hints import OwnFirst, known_runs
from crowdbot.core.campaign.plan import Plan, make_plan
from crowdbot.core.campaign.request import CampaignRequest
from crowdbot.core.campaign.run import State
from crowdbot.core.registry.registry import discover
from crowdbot.core.results import reference_file


def planned(out: Path, scenario: str, **changes: object) -> Plan:
    request = CampaignRequest(
        suites=["challenge-2026"],
        only=[scenario],
        planners=["dwa", "bully"],
        floors=True,
        out=out,
    )
    return make_plan(replace(request, **changes), discover())  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Plan:
    return planned(tmp_path_factory.mktemp("hints"), "counter-d020-late-n01")


def state_of(plan: Plan, left: int) -> State:
    """The state of a campaign with this many jobs left, the last of the plan."""
    jobs = plan.jobs[len(plan.jobs) - left :]
    return State(
        plan=plan, estimate=plan.estimate, statuses={}, labels={}, size=1,
        left={job.key: job for job in jobs},
    )  # fmt: skip


def test_floors_come_last_with_what_only_they_need(plan: Plan) -> None:
    added = [job.added for job in plan.jobs]
    assert added == sorted(added)
    own = {(job.kind, job.label) for job in plan.jobs if not job.added}
    assert {label for _, label in own} == {"dwa", "bully"}
    assert {kind for kind, _ in own} == {"crowd_alone", "robot_alone", "run"}
    done: set[str] = set()
    for job in plan.jobs:
        assert done.issuperset(job.depends_on)
        done.add(job.key)


def test_the_end_of_the_users_own_runs_is_told_once(plan: Plan) -> None:
    floors = sum(job.added for job in plan.jobs)
    first = OwnFirst()
    assert first.line(state_of(plan, floors + 1)) == ""
    assert first.line(state_of(plan, floors)) == (
        f"your planners are done; {floors} jobs of floors and ceilings left. "
        "Ctrl-C keeps what is done"
    )
    assert first.line(state_of(plan, floors - 1)) == ""
    assert OwnFirst().line(state_of(plan, 0)) == ""
    only_floors = replace(plan, jobs=tuple(job for job in plan.jobs if job.added))
    assert OwnFirst().line(state_of(only_floors, floors)) == ""


def test_known_runs_are_named(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reference_file, "shipped_runs", cache(reference_file.shipped_runs))
    floors = sum(job.added for job in plan.jobs if job.kind == "run")
    assert known_runs(plan) == (
        f"{floors + 1} of {floors + 2} runs are in the reference scores: to save time, leave out "
        "dwa and add --no-floors, then see 'crowdbot results --reference crowdbot'"
    )
    altered = planned(
        tmp_path, "counter-d020-late-n01", overrides=["robots.robot.task.time_limit=20 s"]
    )
    other = planned(tmp_path, "counter-d020-late-n18")
    without = planned(tmp_path, "counter-d020-late-n01", floors=False)
    assert [known_runs(p) for p in (altered, other, without)] == ["", "", ""]
