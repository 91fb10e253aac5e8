"""Trials of the original: config, order, control, sims, robots, endings and stages."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from crowdbot.core.exchange.trial.law import CONTROL_LAWS
from crowdbot.core.exchange.trial.sims import SIMS
from crowdbot.errors import SpecError
from tests.core.exchange.importing import FILES, document_of, imported, notes


def test_a_config_names_trials_which_become_a_suite() -> None:
    found = imported("config.xml")
    assert found.ids == ["every", "small"]
    trials = document_of(found)["matrix"]["trial"]
    assert list(trials) == ["every", "small"]


@pytest.mark.parametrize("order", [1, -1])
def test_files_that_are_given_and_named_are_read_once(order: int) -> None:
    files = ["config.xml", "trials/FileOrder.csv", "trials/every.xml", "trials/small.xml"]
    together, alone = imported(*files[::order]), imported("config.xml")
    assert sorted(together.ids) == sorted(alone.ids)
    assert together.report.counts() == alone.report.counts()


def test_left_and_right_are_kept() -> None:
    """Their x, y and clockwise degrees are our y, x and counter-clockwise radians."""
    scenario = document_of(imported("trials/small.xml"))["scenario"]
    start = scenario["robots"]["pepper"]["task"]["start"]
    assert start == pytest.approx([-6, 1, -math.pi / 2])
    person = scenario["crowd"]["agents"][0]
    assert (person["x"], person["y"]) == (0, 0)
    assert person["heading"] == pytest.approx(math.pi / 2)
    assert person["goals"] == [[5, 0], [-5, 2]]


def test_a_sim_sets_speed_policy_and_limits() -> None:
    crowd = document_of(imported("trials/small.xml"))["scenario"]["crowd"]
    person = crowd["agents"][0]
    assert (person["speed"], person["max_speed"], person["max_acceleration"]) == (1.4, 2, 1000)
    assert person["at_goal"] == "loop"
    assert person["height"] == pytest.approx(1.7 * 1.02)
    assert crowd["costs"]["ttca_dca"]["sigma_ttca"] == 1  # preset 1


def test_every_law_and_sim_is_read() -> None:
    found = imported("config.xml")
    read = {e.theirs.rpartition("/")[2] for e in found.report.entries}
    assert set(SIMS) - {"RosSimConfig", "SidoSimConfig"} <= read
    walked = {"LawControllerSpeedSideStep", "LawCamControlEditor"}
    assert set(CONTROL_LAWS) - walked <= read | {"LawFake"}
    crowd = document_of(found)["matrix"]["trial"]["every"]["crowd"]
    named = set(crowd["policies"])
    assert named == {"rvo2", "helbing", "tangent", "vision", "groups", "law_alone", "replay"}
    people = crowd["agents"]
    assert people[5]["group"] == 4
    assert people[6]["heading"] == pytest.approx(math.pi)  # looks at a point behind
    assert people[7]["goals"][0][0] == pytest.approx(0)  # straight on, to our left
    assert people[7]["goals"][0][1] > 500
    assert people[8]["policy"] == "replay"


def test_replayed_files_are_converted() -> None:
    (table,) = imported("config.xml").scenes[0].tables.values()
    assert table.startswith("t,id,x,y\n0.0,8,2.0,-1.0\n1.0,8,3.0,-1.0\n")


def test_endings_limit_the_robot() -> None:
    scenario = document_of(imported("config.xml"))["matrix"]["trial"]["every"]
    task = scenario["robots"]["pepper"]["task"]
    assert task["time_limit"] == 40
    zone = scenario["environment"]["zones"][task["goal"]["zone"]]
    assert zone["x"][0] == 9


def test_the_original_never_tells_people_how_a_robot_moves() -> None:
    response = document_of(imported("trials/small.xml"))["scenario"]["crowd"]["robot_response"]
    assert response == {"margin": 0.23, "velocity": "hidden", "shown_to_policies": True}


def test_every_part_has_a_fate() -> None:
    """Leave any attribute unknown, and it is in the report."""
    found = imported("config.xml")
    assert not [e for e in found.report.entries if e.note.startswith("no meaning")]


def test_an_unknown_part_is_named(tmp_path: Path) -> None:
    text = (FILES / "trials" / "small.xml").read_text()
    changed = tmp_path / "changed.xml"
    changed.write_text(text.replace('radius="0.33" visual', 'colour="red" radius="0.33" visual'))
    found = imported(changed)
    assert "no meaning" in notes(found, "left out")["Trial/agents/agent/TrialRegularAgent@colour"]


def test_people_who_overlap_keep_their_places_and_enter_in_turn(tmp_path: Path) -> None:
    text = (FILES / "trials" / "small.xml").read_text()
    begin, end = text.index("    <agent>"), text.index("  </agents>")
    three = tmp_path / "three.xml"
    three.write_text(text[:end] + 2 * text[begin:end] + text[end:])
    found = imported(three)
    people = document_of(found)["scenario"]["crowd"]["agents"]
    assert [(p["x"], p["y"], p.get("start_time", 0)) for p in people] == [
        (0, 0, 0), (0, 0, 0.001), (0, 0, 0.002),
    ]  # fmt: skip
    assert "milliseconds" in notes(found, "interpreted")["start"]


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('PolicyID="1"', 'PolicyID="9"', "no policy 9; there are: 0, 1, 2"),
        ("LawGoals", "LawGoal", "no controlLaw 'LawGoal'"),
        ('prefered_speed="1.4"', 'prefered_speed="fast"', "has to be a finite number"),
        ('<Goal x="0"', '<Goal u="0"', "'Goal' has no attribute 'x'"),
        ('test="greater" value="40"', 'test="equal" value="40"', "which is not known"),
        ('radius="0.3"', 'radius="-0.3"', "has to be from"),
    ],
)
def test_errors_have_a_place(tmp_path: Path, before: str, after: str, message: str) -> None:
    text = (FILES / "trials" / "small.xml").read_text()
    assert before in text
    changed = tmp_path / "changed.xml"
    changed.write_text(text.replace(before, after))
    with pytest.raises(SpecError) as caught:
        imported(changed)
    (one,) = caught.value.diagnostics
    assert message in one.message
    assert one.mark.line > 1
