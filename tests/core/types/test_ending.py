"""The table of endings: what commands, pages, statistics and records read of it."""

from __future__ import annotations

import copy
import json

import pytest

from crowdbot.core.types.ending import (
    ATTEMPTED,
    COMPLETE,
    Ending,
    ending_style,
    has_failed,
    of_several,
    shown,
)


def test_an_ending_is_the_word_that_files_have() -> None:
    assert json.loads(json.dumps([Ending.TOPPLED])) == ["toppled"]
    counts: dict[str, int] = {Ending.TOPPLED: 1}
    assert counts["toppled"] == 1
    assert type(str(Ending.TOPPLED)) is str
    assert copy.deepcopy(Ending.TOPPLED) is Ending.TOPPLED  # pickled like this for processes


def test_the_words_of_files_that_exist_stay() -> None:
    written = ["arrived", "timeout", "toppled", "planner_failed"]
    assert [ending for ending in COMPLETE if ending in written] == written  # more may be between
    assert (*COMPLETE, "people_alone", "failed") == ATTEMPTED


def test_people_alone_have_a_column_only_where_there_are_such_runs() -> None:
    assert shown({"arrived": 3}) == (*COMPLETE, "failed")
    assert shown({"people_alone": 1}) == ATTEMPTED


@pytest.mark.parametrize(
    ("word", "failed"),
    [("planner_failed", True), ("failed", True), ("toppled", False), ("?", False)],
)
def test_what_counts_as_failed(word: str, *, failed: bool) -> None:
    assert has_failed(word) == failed


def test_an_ending_says_what_decided_the_run_or_why_searches_for_it() -> None:
    silent = {e for e in COMPLETE if not e.happened} - {Ending.ARRIVED, Ending.TIMEOUT}
    assert not silent, f"crowdbot why cannot explain {silent}: say what happened"


@pytest.mark.parametrize("ending", Ending)
def test_each_has_its_texts_and_a_colour_of_its_own(ending: Ending) -> None:
    assert ending.past
    assert "{" not in ending.sentence.format(t=1.0)
    assert len({one.colour for one in Ending}) == len(Ending)
    assert f'[data-ending="{ending}"] {{ --ending: {ending.colour}; }}' in ending_style()


@pytest.mark.parametrize(
    ("statuses", "ending"),
    [
        (("arrived", "arrived"), Ending.ARRIVED),
        (("arrived", "timeout"), Ending.TIMEOUT),
        (("toppled", "timeout", "arrived"), Ending.TOPPLED),
        (("toppled", "planner_failed"), Ending.PLANNER_FAILED),
        (("interrupted", "planner_failed"), Ending.INTERRUPTED),
    ],
)
def test_the_ending_of_several_robots(statuses: tuple[str, ...], ending: Ending) -> None:
    assert of_several(statuses) == ending
