"""The suite of goals that are people: what it covers, and what its page says of it."""

from __future__ import annotations

import re

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.suite.expansion import Expansion
from tests.paths import ROOT

REGISTRY = discover(allow=())
PAGE = (ROOT / "docs" / "reference" / "suites" / "assistance.md").read_text()


@pytest.fixture(scope="module")
def suite() -> Expansion:
    return open_spec("assistance", REGISTRY)


def test_every_goal_is_a_person_and_every_kind_is_there(suite: Expansion) -> None:
    goals = [s.robots["robot"].task.person for s in suite.scenarios]
    assert 20 <= len(goals) <= 40
    assert {goal.kind for goal in goals if goal} == {"approach", "follow", "accompany", "lead"}
    assert {goal.knows for goal in goals if goal} == {"tracked", "told"}
    assert None not in goals


def test_the_page_lists_the_labels(suite: Expansion) -> None:
    listed = set(re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE))
    labels = {label for s in suite.scenarios for label in s.id.split("-")}
    assert labels == listed


def test_people_are_as_many_as_the_label_says(suite: Expansion) -> None:
    for scenario in suite.scenarios:
        place = scenario.id.split("-")[1]
        assert scenario.crowd is not None
        others = scenario.crowd.spawns.get("others")
        floor = 24.0 * (4.0 if place.startswith("corridor") else 10.0)
        density = 0.0 if others is None else (others.count or 0) / floor
        wanted = float(place.partition("_d")[2] or 0) / 100.0
        assert density == pytest.approx(wanted, abs=0.005)
