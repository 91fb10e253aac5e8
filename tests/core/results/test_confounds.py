"""The linter: everything besides the planner that differs is found, named and measured."""

from __future__ import annotations

from typing import Any

import pytest

from crowdbot.core.results.confounds import KINDS, check_comparable, confounds
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.errors import InputError, UnknownNameError
from tests.core.statistics.made_up_results import run

CONDITIONS = {
    "rates.log": "16 Hz", "perceived_radius": "0.18 m", "people_and_robot": "full, velocity true",
}  # fmt: skip
RECORD: dict[str, Any] = {
    "versions": {"crowdbot": "0.1.0", "numpy": "2.4.6"},
    "metrics": {"risk": {"spec_version": 1, "risk_horizon": 5.0}},
    "machine": {"processor": "znver3"},
    "agents": "locked",
    "planner": {"kind": "dwa"},
}


def row(planner: str, scenario: str = "s0", **more: Any) -> RunRow:
    values = {"conditions": CONDITIONS, "record": RECORD, **more}
    return run(planner, scenario, directory=f"suite/{scenario}/{planner}/seed-0", **values)


def found(*rows: RunRow, accept: tuple[str, ...] = ()) -> dict[str, str]:
    return {f.kind: str(f) for f in confounds(Results(runs=rows), accept)}


def test_equal_runs_have_none() -> None:
    assert found(row("a"), row("b"), row("a", "s1"), row("b", "s1")) == {}
    assert found() == {}


@pytest.mark.parametrize(("kind", "changes"), [
    ("scenario", {"spec_hash": "cb1-sha256:other"}),
    ("crowd", {"realisation_hash": "cb1-sha256:other"}),
    ("rates", {"conditions": CONDITIONS | {"rates.log": "20 Hz"}}),
    ("perceived_radius", {"conditions": CONDITIONS | {"perceived_radius": "0.25 m"}}),
    ("visibility", {"conditions": CONDITIONS | {"people_and_robot": "none, velocity true"}}),
    ("condition", {"conditions": CONDITIONS | {"weather": "rain"}}),
    ("versions", {"record": RECORD | {"versions": {"crowdbot": "0.2.0", "numpy": "2.4.6"}}}),
    ("metrics", {"record": RECORD | {"metrics": {"risk": {"spec_version": 2}}}}),
    ("privileged", {"privileged": True}),
])  # fmt: skip
def test_what_differs_is_refused_unless_it_is_accepted(kind: str, changes: dict[str, Any]) -> None:
    results = Results(runs=(row("a"), row("b", **changes)))
    findings = confounds(results)
    assert {f.kind for f in findings} == {kind}
    with pytest.raises(InputError, match=rf"differ in more than the planner:\n  {kind}: .*") as e:
        check_comparable(findings)
    assert str(e.value).endswith(f"accept what differs: --accept {kind}")
    accepted = confounds(results, accept=[kind])
    assert all(f.accepted for f in accepted)
    check_comparable(accepted)


@pytest.mark.parametrize(("kind", "changes"), [
    ("agents", {"record": RECORD | {"agents": "drawn"}}),
    ("unpinned", {"pinned": False}),
    ("libraries", {"record": RECORD | {"versions": {**RECORD["versions"], "pydantic": "2.14.4"}}}),
    ("processor", {"record": RECORD | {"machine": {"processor": "generic"}}}),
])  # fmt: skip
def test_what_only_warns(kind: str, changes: dict[str, Any]) -> None:
    findings = confounds(Results(runs=(row("a"), row("b", **changes))))
    assert [(f.kind, f.severity) for f in findings] == [(kind, "warning")]
    check_comparable(findings)


def test_a_finding_says_what_where_and_by_how_much() -> None:
    text = found(row("a"), row("b", conditions=CONDITIONS | {"rates.log": "20 Hz"}))["rates"]
    assert text == (
        "rates: rates.log, suite/s0: 16 Hz in 1 run (suite/s0/a/seed-0); "
        "20 Hz in 1 run (suite/s0/b/seed-0) (+4, +25.0%)"
    )


def test_axes_of_the_suite_are_no_confounds() -> None:
    other = {"conditions": CONDITIONS | {"rates.log": "20 Hz"}, "spec_hash": "x"}
    assert found(row("a"), row("b"), row("a", "s1", **other), row("b", "s1", **other)) == {}


def test_versions_must_be_equal_everywhere() -> None:
    newer = RECORD | {"versions": {"crowdbot": "0.1.0", "numpy": "2.5.0"}}
    text = found(row("a"), row("a", "s1", record=newer))["versions"]
    assert "versions.numpy: 2.4.6 in 1 run" in text
    assert "2.5.0 in 1 run" in text


def test_the_same_difference_in_many_scenarios_is_told_once() -> None:
    slow = {"conditions": CONDITIONS | {"rates.log": "8 Hz"}}
    rows = [r for i in range(9) for r in (row("a", f"s{i}"), row("b", f"s{i}", **slow))]
    (finding,) = confounds(Results(runs=tuple(rows)))
    assert finding.subject == "rates.log, 9 scenarios"
    assert [len(runs) for runs in finding.values.values()] == [9, 9]


def test_many_findings_are_told_in_part() -> None:
    rows = [r for i in range(9) for r in (row("a", f"s{i}"), row("b", f"s{i}", spec_hash="x"))]
    with pytest.raises(InputError) as e:
        check_comparable(confounds(Results(runs=tuple(rows))))
    assert "scenario: 6 more like these" in str(e.value)
    assert str(e.value).count("suite/s") < 30


def test_runs_without_a_partner_are_told() -> None:
    text = found(row("a"), row("b"), row("a", "s1"))["unpaired"]
    assert "only a in 1 run (suite/s1/a/seed-0)" in text
    text = found(row("a"), row("b", "s1"))["unpaired"]
    assert "all planners" not in text, "no run is shared"


def test_a_ceiling_may_know_what_others_sense() -> None:
    assert found(row("a"), row("b", privileged=True, role="ceiling")) == {}


def test_floors_and_ceilings_are_run_in_a_sample_and_need_no_partner() -> None:
    rows = (row("a"), row("b"), row("a", "s1"), row("b", "s1"), row("blind", role="floor"))
    assert found(*rows) == {}
    assert set(found(*rows, row("a", "s2"))) == {"unpaired"}


def test_unknown_names_are_refused() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'rates'"):
        confounds(Results(), accept=["rate"])


def test_each_condition_is_told_once() -> None:
    other = RECORD | {
        "metrics": {"risk": {"spec_version": 1, "risk_horizon": 3.0}},
        "machine": {"processor": "generic"},
    }
    results = Results(runs=(row("a"), row("b", record=other)))
    assert [(f.kind, f.subject) for f in confounds(results)] == [
        ("metrics", "metrics.risk"), ("processor", "processor"),
    ]  # fmt: skip


def test_metrics_that_were_not_scored_are_not_compared() -> None:
    fewer = RECORD | {"metrics": {}}
    assert found(row("a"), row("b", record=fewer)) == {}


def test_every_kind_says_what_it_is() -> None:
    assert all(severity in ("error", "warning") and text for severity, text in KINDS.values())
