"""Who the goal is: numbers, groups, and people drawn from the crowd's seed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.assistance.target import Target, find_targets
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import from_source, realise
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError
from tests.core.assistance.people import REGISTRY, about, standing

AGENTS = [
    standing(0, 4.0, 2.0, 0.0),
    standing(7, 8.0, -0.5, math.pi / 2, group=3),
    standing(8, 8.0, 0.5, -math.pi / 2, group=3),
]
HALL = {"area": "floor", "count": 6, "standing": True, "groups": [{"size": 2, "frequency": 1.0}]}
NORTH = {"kind": "through", "origin": "floor", "destination": "exit", "count": 3}
CROWD = {"spawns": {"hall": HALL}, "streams": {"north": NORTH}}


def target(scenario: Scenario) -> Target:
    parts = build_environment(REGISTRY, scenario.environment)
    return find_targets(scenario, parts, realise(scenario, parts))["robot"]


def test_an_agent_and_a_group() -> None:
    one = target(about({"kind": "approach", "person": {"agent": 7}}, AGENTS))
    assert one.id.tolist() == [7]
    assert one.task().radius == 0.25
    pair = target(about({"kind": "approach", "person": {"group": 3}}, AGENTS))
    assert pair.id.tolist() == [7, 8]
    assert pair.task().radius == pytest.approx(0.75)
    assert np.isnan(pair.at_start.heading[0])  # they face each other


@pytest.mark.parametrize("who", [{"spawn": "hall"}, {"stream": "north"}])
def test_one_is_drawn_by_the_crowd_s_seed(who: dict[str, str]) -> None:
    goal = {"kind": "approach", "person": who}
    scenarios = [about(goal, AGENTS, crowd={**CROWD, "seed": {"root": root}}) for root in range(12)]
    (field, name), found = *who.items(), [target(s) for s in scenarios]
    for scenario, one in zip(scenarios, found, strict=True):
        assert len(one.id) == 1
        assert one.id[0] in from_source(scenario, None, f"{field} {name}")
    assert [t.id[0] for t in found] == [target(s).id[0] for s in scenarios]
    assert len({int(t.id[0]) for t in found}) > 1


def test_the_group_of_the_one_who_is_drawn() -> None:
    goal = {"kind": "approach", "person": {"spawn": "hall", "whole_group": True}}
    assert len(target(about(goal, AGENTS, crowd=CROWD)).id) == 2


def test_people_of_sources_are_all_who_are_drawn() -> None:
    scenario = about({"kind": "approach", "person": {"agent": 0}}, AGENTS, crowd=CROWD)
    sources = [from_source(scenario, None, s) for s in ("stream north", "spawn hall")]
    assert sorted(sum(sources, [0, 7, 8])) == sorted(realise(scenario).id.tolist())
    assert [len(s) for s in sources] == [3, 6]


def test_one_who_is_not_there() -> None:
    with pytest.raises(InputError, match="no such person is there at the start"):
        target(about({"kind": "approach", "person": {"agent": 5}}, AGENTS))
