"""Kinds of people: shares, numbers of each look, and that one person does not move another."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.dsl.scenario.people_kinds import USUAL_BODIES
from tests.core.population.spawning_cases import hall

MIX: dict[str, Any] = {
    "adults": {"share": 2},
    "kids": {"look": "child"},
    "chairs": {"look": "wheelchair_user", "radius": {"mean": 0.42, "std": 0.02}},
    "runners": {"speed": {"mean": 2.8, "std": 0.1}, "height": {"value": 1.9, "spread": 0.05}},
}
SPAWN: dict[str, Any] = {"area": "hall", "portals": ["a", "b"]}


def drawn(crowd: dict[str, Any]) -> Realisation:
    return realise(hall({"people": MIX} | crowd))


@pytest.mark.slow
def test_shares_and_sizes() -> None:
    table = drawn({"spawns": {"all": SPAWN | {"count": 400}}})
    look = np.array(table.look)
    share = {name: np.mean(look == name) for name in ("adult", "child", "wheelchair_user")}
    assert share == pytest.approx({"adult": 0.6, "child": 0.2, "wheelchair_user": 0.2}, abs=0.07)
    kids = look == "child"
    assert table.height[kids].mean() == pytest.approx(USUAL_BODIES["child"].height[0], abs=0.03)
    assert set(table.radius[kids].tolist()) == {0.20}
    assert set(table.radius[look == "adult"].tolist()) == {0.33}
    chairs = table.radius[look == "wheelchair_user"]
    assert chairs.min() >= 0.37
    assert chairs.max() <= 0.47
    assert chairs.std() > 0.01
    assert table.speed[look == "wheelchair_user"].max() < 1.3
    runners = table.speed > 2.4
    assert np.all((table.height[runners] >= 1.85) & (table.height[runners] <= 1.95))
    assert np.all(table.leg_length < table.height)
    assert table.phase.std() > 1.0


def test_who_a_person_is_does_not_depend_on_how_many_follow() -> None:
    few, many = (drawn({"spawns": {"all": SPAWN | {"count": n}}}) for n in (5, 12))
    for name in ("look", "height", "radius", "mass", "phase"):
        assert list(getattr(few, name)) == list(getattr(many, name)[:5])


@pytest.mark.parametrize(
    "crowd",
    [
        {"flow": {"direction": "in", "density": 0.00625, "area": "hall"}},
        {"streams": {"s": {"kind": "through", "origin": "a", "destination": "b", "start": "hall",
                           "count": 10}}},
        {"spawns": {"s": SPAWN | {"count": 10}}},
    ],
)  # fmt: skip
def test_flows_streams_and_spawns_are_mixed(crowd: dict[str, Any]) -> None:
    table = drawn(crowd)
    assert len(set(table.look)) > 1
    assert Realisation.from_csv(table.to_csv()).to_csv() == table.to_csv()
    plain = realise(hall(crowd))
    assert plain.radius.tolist() == [0.33] * 10
    assert "look" not in plain.to_csv().splitlines()[0]


def test_a_stream_may_be_of_some_kinds_only() -> None:
    stream = {"kind": "through", "origin": "a", "destination": "b", "start": "hall", "count": 9}
    table = drawn({"streams": {"school": stream | {"people": "kids", "body": {"mass": 31.0}}}})
    assert set(table.look) == {"child"}
    assert set(table.mass.tolist()) == {31.0}


def test_numbers_of_a_spawn_are_kept() -> None:
    table = drawn({"spawns": {"s": SPAWN | {"count": 9, "radius": 0.25, "mass": 60.0}}})
    assert set(table.radius.tolist()) == {0.25}
    assert set(table.mass.tolist()) == {60.0}


def test_an_explicit_agent_has_the_usual_body_of_its_look() -> None:
    agents = [
        {"id": 0, "x": 5, "y": 0, "goals": [[9, 0]], "look": "wheelchair_user"},
        {"id": 1, "x": 7, "y": 0, "goals": [[9, 0]], "look": "child", "radius": 0.3, "height": 1.1},
        {"id": 2, "x": 3, "y": 0, "goals": [[3, 0], [9, 0]], "pauses": [2, 0]},
    ]
    table = realise(hall({"agents": agents}))
    assert table.radius.tolist() == [0.40, 0.3, 0.33]
    assert table.height.tolist() == [1.30, 1.1, 0.0]
    assert table.mass[:2].tolist() == [92.0, 25.5]
    assert table.pauses == ((), (), (2.0, 0.0))
