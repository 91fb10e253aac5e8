"""A replay says what the words of a scenario's name mean."""

from __future__ import annotations

from crowdbot.core.runs.replayed import scenario_words
from tests.core.results.made_up_record import made_up_record


def test_words_are_told_in_one_sentence() -> None:
    record = made_up_record(
        axes={"density": "d040", "attention": "late", "draw": "n01"},
        axis_words={
            "density": ["flow density", "0.51 1/m²"],
            "attention": ["robot response", "reaction yield, late fraction 0.4"],
        },
    )
    assert scenario_words(record) == (
        "In this scenario's name, d040: flow density 0.51 1/m²; late: robot response reaction "
        "yield, late fraction 0.4; n01: one of several draws of its people."
    )


def test_without_words_nothing_is_said() -> None:
    assert scenario_words(made_up_record()) == ""
    assert scenario_words(made_up_record(axes={"density": "d040"})) == ""
