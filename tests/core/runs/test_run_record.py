"""The record of a run: what is read is what was written, and which fields its id is the hash of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.runs.record_parts import IdentityHashes
from crowdbot.core.runs.run_record import ReferenceRecord, RunIdentity, RunRecord
from crowdbot.core.support.json_digest import digest
from crowdbot.errors import InputError
from tests.core.results.made_up_record import made_up_record

OTHER: dict[str, Any] = {
    "scenario": "s1", "suite": "other", "planner": "b", "step_budget": 0.1,
    "planner_memory": None, "seed": 1, "spec_hash": "x", "realisation_hash": "x",
    "versions": {"numpy": "3"}, "plugins": [{"name": "x"}],
}  # fmt: skip
RESULT: dict[str, Any] = {
    "trajectory_hash": "x", "status": "timeout", "goal_time": None, "wall_time": 2.0,
    "position": 3, "axes": {"a": "b"}, "machine": {"processor": "x"}, "recorded": "none",
    "role": "floor", "planner_process": "own", "live": None, "files": {"run.mcap": 1},
}  # fmt: skip


@pytest.mark.parametrize("name", OTHER)
def test_what_decides_what_happens_changes_the_id(name: str) -> None:
    assert made_up_record(**{name: OTHER[name]}).id() != made_up_record().id()


@pytest.mark.parametrize("name", RESULT)
def test_what_came_of_it_does_not(name: str) -> None:
    assert made_up_record(**{name: RESULT[name]}).id() == made_up_record().id()


def test_the_id_is_known_before_the_run() -> None:
    record = made_up_record(step_budget=0.5)
    hashes = IdentityHashes(spec=record.hashes.spec, realisation=record.hashes.realisation)
    known = RunIdentity(
        scenario=record.scenario, suite=record.suite, planner=record.planner, step_budget=0.5,
        seed=record.seed, hashes=hashes, versions=record.versions, plugins=record.plugins,
    )  # fmt: skip
    assert known.id() == record.id() == digest(known.document())


def test_what_is_written_is_read(tmp_path: Path) -> None:
    record = made_up_record(planner_memory=None, further={"x": [1, 2.5]})
    record.write(tmp_path)
    again = RunRecord.read(tmp_path)
    assert again == record
    assert again.document() == record.document()
    assert next(iter(again.document())) == "run_id"
    assert "toppled_time" not in again.document()
    assert again.document()["planner_memory"] is None
    assert again.document()["further"] == {"x": [1, 2.5]}


def test_what_is_malformed_is_named(tmp_path: Path) -> None:
    document = made_up_record().document()
    with pytest.raises(InputError, match="x: 'seed': input should be a valid integer"):
        RunRecord.parse(document | {"seed": "1"}, "x")
    assert RunRecord.find(tmp_path) is None


def test_keys_still_work_for_a_while() -> None:
    with pytest.warns(DeprecationWarning, match=r"use record\.status"):
        assert made_up_record()["status"] == "arrived"


def test_a_calibration_run_is_what_it_depends_on() -> None:
    """Also one whose robot toppled."""
    key = {"spec": "s", "versions": {}, "planner": {"kind": "dwa"}, "seed": 0}
    ending = {"status": "toppled", "reason": "", "goal_time": None, "toppled_time": 1.0,
              "sim_time": 1.0, "wall_time": 0.1}  # fmt: skip
    run_id = digest({"reference": "robot_alone", **key})
    document = {"run_id": run_id, "reference": "robot_alone", **key, **ending}
    record = ReferenceRecord.parse(document, "x")
    assert record.id() == record.run_id
