"""Suites that tell floors from baselines, and suites that do not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.audit import audit, read_audit, suspicion, write_audit
from crowdbot.errors import InputError
from tests.core.statistics.test_floors import results

GOOD = {"blind": [0.0] * 8, "still": [0.0] * 8, "known": [0.8] * 8, "seer": [1.0] * 8}


def test_a_good_suite() -> None:
    found = audit(results(GOOD))
    assert found.tells_apart
    assert [(p.better, p.worse, p.required) for p in found.pairs] == [
        ("known", "blind", True), ("known", "still", True), ("seer", "known", False),
    ]  # fmt: skip
    assert found.text == "suite tells floors from baselines in success no collision"


def test_one_floor_that_is_as_good_is_enough_to_fail() -> None:
    found = audit(results({**GOOD, "blind": [0.8] * 8}))
    assert not found.tells_apart
    assert [p.worse for p in found.failing] == ["blind"]
    assert "known over blind: +0" in found.text


def test_a_baseline_that_loses_is_not_told_apart_either() -> None:
    assert not audit(results({**GOOD, "blind": [1.0] * 8})).tells_apart


def test_a_floor_that_sees_is_held_against_those_that_do_not() -> None:
    """A baseline need not be ahead of it, but it has to be ahead of the blind ones itself."""
    careful = {**GOOD, "slow": [0.8] * 8}
    found = audit(results(careful), seeing=["slow"])
    assert found.tells_apart
    assert [(p.better, p.worse, p.required) for p in found.pairs] == [
        ("known", "blind", True), ("known", "still", True),
        ("slow", "blind", True), ("slow", "still", True),
        ("known", "slow", False), ("seer", "known", False),
    ]  # fmt: skip
    assert not audit(results(careful)).tells_apart
    worse = audit(results({**careful, "slow": [0.0] * 8}), seeing=["slow"])
    assert [(p.better, p.worse) for p in worse.failing] == [("slow", "blind"), ("slow", "still")]


def test_the_ceiling_decides_nothing() -> None:
    found = audit(results({**GOOD, "seer": [0.0] * 8}))
    assert found.tells_apart
    assert found.pairs[-1].verdict == "behind"


@pytest.mark.parametrize(
    ("left", "why"),
    [
        (("blind", "still"), "no baseline was run"),
        (("known", "seer"), "no floor was run"),
        (("seer",), "no floor was run"),
    ],
)
def test_what_is_missing_is_named(left: tuple[str, ...], why: str) -> None:
    found = audit(results({p: GOOD[p] for p in left}))
    assert not found.tells_apart
    assert why in found.text


def test_without_a_score_that_could_decide() -> None:
    found = audit(results(GOOD, metric="path_length"))
    assert (found.tells_apart, found.metric) == (False, "")
    assert "no score that could decide" in found.text


def test_runs_of_candidates_alone_cannot_be_audited() -> None:
    with pytest.raises(InputError, match="no run of a floor"):
        audit(results({"mine": [1.0] * 8}))


def test_it_is_read_as_it_was_written(tmp_path: Path) -> None:
    found = audit(results(GOOD))
    write_audit(tmp_path / "audit.json", found)
    assert read_audit(tmp_path / "audit.json") == found


@pytest.mark.parametrize(
    ("text", "says"),
    [("{", "Invalid JSON"), ("[]", "not an audit"), ('{"suite": "s"}', "tells_apart")],
)
def test_other_files_are_refused(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "audit.json").write_text(text)
    with pytest.raises(InputError, match=says):
        read_audit(tmp_path / "audit.json")
    with pytest.raises(InputError, match="cannot be read"):
        read_audit(tmp_path / "none.json")


def test_what_readers_are_told() -> None:
    runs = results(GOOD).runs
    assert suspicion(None, runs) == ""
    assert suspicion(audit(results(GOOD)), runs) == ""
    bad = audit(results({**GOOD, "blind": [1.0] * 8}))
    assert suspicion(bad, runs) == bad.text


def test_an_audit_of_another_version_of_the_suite_does_not_count() -> None:
    document = json.loads(audit(results(GOOD)).model_dump_json())
    document["scenarios"]["s3"] = "spec-of-old"
    old = type(audit(results(GOOD))).model_validate(document)
    assert "has changed since it was audited" in suspicion(old, results(GOOD).runs)
    others: Results = Results()
    assert not old.fits(others.runs)
