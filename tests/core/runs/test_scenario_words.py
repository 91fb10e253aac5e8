"""A replay says what the words of a scenario's name mean."""

from __future__ import annotations

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.scenario_words import scenario_words
from crowdbot.core.scenarios.library import open_spec
from tests.core.results.made_up_record import made_up_record

REGISTRY = discover(allow=())
TOLD = {
    "challenge-2026#in-d020-attentive-n01": (
        "in: people walk the robot's way; d020: 0.255 people per m² where they start; attentive: "
        "all people notice the robot in time; n01: the first draw of people, others have other "
        "people"
    ),
    "challenge-2026#counter-d040-late-n09": (
        "counter: people come towards the robot; d040: 0.51 people per m² where they start; late: "
        "40% of people notice the robot only 0.7 s before they would touch it; n09: the ninth draw "
        "of people, others have other people"
    ),
    "challenge-2026#both-d020-never-n02": (
        "both: people walk in both directions; d020: 0.255 people per m² where they start; never: "
        "10% of people take no notice of the robot while it moves, 40% of the others notice it "
        "only 0.7 s before they would touch it; n02: the second draw of people, others have other "
        "people"
    ),
    "challenge-2020#in-d0125-slow-c01-r02": (
        "in: people walk the robot's way; d0125: 0.125 people per m² where they start; slow: "
        "people like to walk at 0.8 ± 0.03 m/s; c01: avoiding others early has the weight 1 "
        "(ttca_dca); r02: people avoid others early within 2 m (ttca_dca)"
    ),
    "challenge-2021#shed_both-d020-usual": (
        "shed_both: a hall with gates and low walls: people go both ways; d020: 0.2 people per m² "
        "where they start; usual: people like to walk at 1.34 ± 0.26 m/s"
    ),
}


@pytest.mark.parametrize("name", TOLD)
def test_words_are_plain(name: str) -> None:
    suite, _, wanted = name.partition("#")
    found = open_spec(suite, REGISTRY)
    (scenario,) = (s for s in found.scenarios if s.id == wanted)
    entry = found.entry(scenario)
    words = {axis: list(texts) for axis, texts in entry.words.items()}
    record = made_up_record(axes=dict(entry.axes), axis_words=words, density=None)
    assert scenario_words(record, scenario) == f"In this scenario's name, {TOLD[name]}."
    seen = record.model_copy(update={"density": 0.2031})
    assert "where they start, 0.2 in this run" in scenario_words(seen, scenario)


def test_without_words_nothing_is_said() -> None:
    scenario = open_spec("challenge-2026", REGISTRY).scenarios[0]
    assert scenario_words(made_up_record(), scenario) == ""
    assert scenario_words(made_up_record(axes={"density": "d040"}), scenario) == ""
