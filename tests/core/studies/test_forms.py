"""Forms: all scales and items of the questionnaires, and what counts as an answer."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.studies.forms import checked_answers, questions_of, weights_of
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, USE_ITEMS
from crowdbot.errors import InputError
from tests.core.studies.study_cases import STUDY, study_of


def test_the_forms_ask_everything(tmp_path: Path) -> None:
    study = study_of(tmp_path)
    tlx, weights, use = (questions_of(kind, study) for kind in ("nasa_tlx", "weights", "use"))
    assert tuple(q.name for q in tlx) == TLX_SCALES
    assert all([m for m, _ in q.marks] == [str(k) for k in range(0, 101, 5)] for q in tlx)
    assert len({q.name for q in weights}) == 15
    assert [q.name for q in use] == [
        f"{d}_{k}" for d, n in USE_ITEMS.items() for k in range(1, n + 1)
    ]
    assert len({q.title for q in use}) == 30


def test_only_marks_are_answers_and_none_is_left_out(tmp_path: Path) -> None:
    questions = questions_of("nasa_tlx", study_of(tmp_path))
    given = dict.fromkeys(TLX_SCALES, "50") | {"effort": "51", "other": "5"}
    del given["frustration"]
    answers, open_ones = checked_answers(questions, given)
    assert answers == dict.fromkeys(TLX_SCALES[:4], "50")
    assert open_ones == ["effort", "frustration"]


def test_weights_are_counts_of_choices(tmp_path: Path) -> None:
    questions = questions_of("weights", study_of(tmp_path))
    found = weights_of({q.name: q.marks[0][0] for q in questions})
    assert found == dict(zip(TLX_SCALES, (5.0, 4.0, 3.0, 2.0, 1.0, 0.0), strict=True))


def test_the_wording_of_use_may_be_that_of_a_file(tmp_path: Path) -> None:
    text = STUDY.replace("id: help", "id: help\n  use_wording: use.txt")
    (tmp_path / "use.txt").write_text("\n".join(f"Item {k}." for k in range(1, 31)) + "\n")
    assert questions_of("use", study_of(tmp_path, text))[29].title == "Item 30."
    (tmp_path / "use.txt").write_text("One.\n")
    with pytest.raises(InputError, match=r"use.txt: 1 lines; USE has 30 items"):
        questions_of("use", study_of(tmp_path, text))
