"""The document of a study: what it may say, and where its errors are."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.studies.document import read_study
from crowdbot.errors import SpecError
from tests.core.studies.study_cases import REGISTRY, STUDY, study_of, written


def test_people_are_numbered_and_conditions_keep_their_order(tmp_path: Path) -> None:
    study = study_of(tmp_path)
    assert study.spec.people == ("p01", "p02", "p03", "p04")
    assert list(study.spec.conditions) == ["alone", "blended"]
    assert len(study.digest) == 64
    named = study_of(tmp_path, STUDY.replace("participants: 4", "participants: [a1, a7]"))
    assert named.spec.people == ("a1", "a7")
    assert named.digest != study.digest


def test_everything_in_it_exists(tmp_path: Path) -> None:
    read_study(written(tmp_path), REGISTRY)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("participants: 4", "participants: [anna]", r"study.yaml:5:\d+: .*participants"),
        ("participants: 4", "participants: [p01, p01]", "same pseudonym"),
        ("participants: 4", "participants: 0", r"study.yaml:5:17"),
        ("title: Does", "titl: Does", r"study.yaml:4:3: .*titl.*did you mean 'title'"),
        ("planner: pass_through", "planner: pas_through", r"study.yaml:7:\d+: .*pass_through"),
        ("{kind: goal_seek}", "{kind: goal_seek, sped: 1}", r"study.yaml:8:\d+: .*'sped'"),
        ("scenario: tiny}", "scenario: tall}", r"study.yaml:10:\d+: .*0 scenarios of .*'tall'"),
        ("suite: tiny.yaml", "suite: tinny.yaml", r"study.yaml:10:\d+: .*tinny.yaml"),
        ("id: help", "id: help\n  order: latn", r"study.yaml:4:10: .*'latin'"),
        ("  title: Does help help?\n", "", r"study.yaml:3:3: .*missing field .title."),
    ],
)
def test_an_error_has_its_place(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in STUDY
    with pytest.raises(SpecError, match=rf"(?s){words}"):
        read_study(written(tmp_path, STUDY.replace(old, new)), REGISTRY)
