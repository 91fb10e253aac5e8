"""Progress: step by step, kept, and never of another study."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot.core.studies.progress import open_progress
from crowdbot.core.studies.steps import steps_of
from crowdbot.errors import InputError, UnknownNameError
from tests.core.studies.study_cases import STUDY, study_of


def test_the_steps_of_a_participant(tmp_path: Path) -> None:
    text = STUDY.replace("  consent", "  practice: {suite: tiny.yaml, scenario: tiny}\n  consent")
    study = study_of(tmp_path, text.replace("id: help", "id: help\n  welcome: Hello."))
    names = [step.name for step in steps_of(study, "p02")]
    assert names == [
        "001-consent", "002-welcome", "003-practice-blended", "004-trial-blended-1",
        "005-nasa_tlx-blended", "006-weights-blended", "007-use-blended", "008-practice-alone",
        "009-trial-alone-1", "010-nasa_tlx-alone", "011-use-alone", "012-end",
    ]  # fmt: skip
    assert [s.shown for s in steps_of(study, "p02") if s.kind == "trial"] == ["A", "B"]


def test_steps_come_in_turn_and_stay_done(tmp_path: Path) -> None:
    study, data = study_of(tmp_path), tmp_path / "data"
    progress = open_progress(study, data, "p01")
    first, second = progress.steps[:2]
    with pytest.raises(InputError, match="'001-consent' comes before '002-trial-alone-1'"):
        progress.finish(second, {})
    progress.finish(first, {"driver": "person"})
    progress.finish(first, {"driver": "another"})  # the page was sent twice
    again = open_progress(study, data, "p01")
    assert again.current() == second
    assert again.done()["001-consent"]["driver"] == "person"
    assert (data.stat().st_mode & 0o077) == 0  # answers of people
    assert [p.name for p in (data / "p01" / "steps").iterdir()] == ["001-consent.json"]


def test_a_folder_is_that_of_one_study(tmp_path: Path) -> None:
    data = tmp_path / "data"
    open_progress(study_of(tmp_path), data, "p01")
    with pytest.raises(InputError, match="the document differs from it"):
        open_progress(study_of(tmp_path, STUDY.replace("Does help help", "Does it")), data, "p01")
    with pytest.raises(UnknownNameError, match="p1"):
        open_progress(study_of(tmp_path), data, "p1")
    (data / "study.json").write_text("{")
    with pytest.raises(InputError, match=r"study.json: damaged"):
        open_progress(study_of(tmp_path), data, "p01")


def test_a_damaged_step_is_named(tmp_path: Path) -> None:
    progress = open_progress(study_of(tmp_path), tmp_path / "data", "p01")
    progress.finish(progress.steps[0], {})
    file = tmp_path / "data" / "p01" / "steps" / "001-consent.json"
    assert json.loads(file.read_text())["kind"] == "consent"
    file.write_text("{")
    with pytest.raises(InputError, match=r"001-consent.json: damaged"):
        progress.current()
