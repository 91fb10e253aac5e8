from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from crowdbot.core.population.realisation import COLUMNS, Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError


@cache
def _suite(*overrides: str) -> Expansion:
    return open_spec("challenge-2020", discover(), overrides)


def _scenario(id_: str = "in-d0125-slow-c01-r02", *overrides: str) -> Scenario:
    return pick(_suite(*overrides), id_)


def _drawn(id_: str = "in-d0125-slow-c01-r02", *overrides: str) -> Realisation:
    return realise(_scenario(id_, *overrides))


@pytest.mark.parametrize(("density", "count"), [("d0125", 50), ("d0250", 100), ("d0500", 200)])
@pytest.mark.parametrize("speed", ["slow", "fast", "dispersed"])
def test_everybody_has_a_place_and_a_pace(density: str, count: int, speed: str) -> None:
    scenario = _scenario(f"counter-{density}-{speed}-c20-r05")
    drawn = realise(scenario)
    assert list(drawn.id) == list(range(count))
    assert np.all((drawn.x >= 5.33) & (drawn.x <= 44.67))
    assert np.all(np.abs(drawn.y) <= 4.67)
    gap = np.hypot(drawn.x[:, None] - drawn.x, drawn.y[:, None] - drawn.y) + 9.0 * np.eye(count)
    assert np.min(gap) >= 0.66
    assert scenario.crowd is not None
    assert scenario.crowd.speed is not None
    mean, std = scenario.crowd.speed.mean, scenario.crowd.speed.std
    assert np.all(np.abs(drawn.speed - mean) <= 3.0 * std)
    assert np.mean(drawn.speed) == pytest.approx(mean, abs=4.0 * std / np.sqrt(count))
    assert 0.6 * std < np.std(drawn.speed) < 1.4 * std


def test_places_are_spread_over_the_zone() -> None:
    x = np.concatenate([_drawn(f"{f}-d0500-{s}-c01-r02").x for f in ("in", "counter")
                        for s in ("slow", "fast", "dispersed")])  # fmt: skip
    counts, _ = np.histogram(x, bins=8, range=(5.0, 45.0))
    assert np.all(np.abs(counts - 150) < 5.0 * np.sqrt(150.0))


def test_the_same_scenario_is_the_same_crowd() -> None:
    one, two = _drawn(), _drawn()
    assert one.hash == two.hash
    assert one.to_csv() == two.to_csv()
    assert one.x.tobytes() == two.x.tobytes()


@pytest.mark.slow
def test_which_axes_draw_other_people() -> None:
    """Cost parameters share the crowd; flow, density and speed do not: 18 draws of 162."""
    hashes: dict[tuple[str, ...], set[str]] = {}
    for scenario in _suite().scenarios:
        hashes.setdefault(tuple(scenario.id.split("-")[:3]), set()).add(realise(scenario).hash)
    assert len(hashes) == 18
    assert all(len(h) == 1 for h in hashes.values())
    assert len(set.union(*hashes.values())) == 18


def test_another_seed_is_another_crowd() -> None:
    base = _drawn()
    other = _drawn("in-d0125-slow-c01-r02", "crowd.seed.root=1")
    assert other.hash != base.hash
    assert other.goal_key != base.goal_key
    assert not np.any(other.x == base.x)


@pytest.mark.slow
def test_streams_are_independent() -> None:
    """A wider spread of speeds leaves everybody where he was."""
    base, other = _drawn(), _drawn("in-d0125-slow-c01-r02", "crowd.speed.std=0.2 m/s")
    assert np.array_equal(base.x, other.x)
    assert base.goal_key == other.goal_key
    assert not np.array_equal(base.speed, other.speed)


def test_attention_is_drawn_for_each_whoever_else_is_there() -> None:
    few, many = _drawn(), _drawn("in-d0125-slow-c01-r02", "crowd.flow.density=0.5 1/m^2")
    assert np.array_equal(many.attention[:50], few.attention)
    assert np.mean(many.attention < 0.4) == pytest.approx(0.4, abs=0.1)
    assert np.all((many.attention >= 0.0) & (many.attention < 1.0))
    assert not np.any(_drawn("in-d0125-fast-c01-r02").attention == few.attention)


def test_how_many_are_late_moves_nobody_in_the_table() -> None:
    other = _drawn("in-d0125-slow-c01-r02", "crowd.robot_response.late_fraction=0.1")
    assert other.hash == _drawn().hash


@pytest.mark.parametrize("given", [None, 0.25])
def test_an_explicit_agent_may_have_its_own_attention(given: float | None) -> None:
    words = "" if given is None else f", attention: {given}"
    agents = f"crowd.agents=[{{id: 900, x: 2, y: 3, speed: 1, goals: [[9, 3]]{words}}}]"
    drawn = _drawn("in-d0125-slow-c01-r02", agents)
    assert (drawn.attention[drawn.id == 900] == 0.25) == (given is not None)
    assert np.array_equal(drawn.attention[:50], _drawn().attention)


def test_without_a_crowd_the_table_is_empty() -> None:
    drawn = _drawn("in-d0125-slow-c01-r02", "crowd=null")
    assert len(drawn.id) == len(drawn.x) == 0
    assert drawn.to_csv() == ",".join(COLUMNS) + "\n"


def test_the_table_reads_back_exactly() -> None:
    drawn = _drawn()
    again = Realisation.from_csv(drawn.to_csv())
    assert again.hash == drawn.hash
    assert again.x.tobytes() == drawn.x.tobytes()
    assert again.portals == drawn.portals


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("id,x", "id,z", "line 1: an agents table has the columns"),
        ("\n1,", "\none,", "line 3: invalid literal"),
        ("portal,", "stay,", "line 2: unknown at_goal 'stay'"),
        ("75.0", "nan", "line 2: numbers must be finite"),
    ],
)
def test_a_broken_table_names_its_line(old: str, new: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Realisation.from_csv(_drawn().to_csv().replace(old, new, 1))


@pytest.mark.parametrize("std", ["0 m/s", "5 m/s"])
def test_extreme_speeds_stay_positive(std: str) -> None:
    drawn = _drawn("in-d0125-slow-c01-r02", f"crowd.speed.std={std}")
    assert np.all(drawn.speed >= 0.05 * 0.8)


def test_too_many_people_is_an_error() -> None:
    with pytest.raises(InputError, match=r"only \d+ of 1200 people fit"):
        _drawn("in-d0125-slow-c01-r02", "crowd.flow.density=3 1/m^2")


@pytest.mark.parametrize(("density", "there", "back"), [("0.25", 50, 50), ("0.1275", 26, 25)])
def test_both_ways_is_half_each_way(density: str, there: int, back: int) -> None:
    drawn = _drawn(
        "in-d0250-slow-c01-r02", "crowd.flow.direction=both", f"crowd.flow.density={density}"
    )
    ways = list(zip(drawn.portals, drawn.heading.tolist(), strict=True))
    assert ways.count((("a", "b"), 0.0)) == there
    assert ways.count((("b", "a"), np.pi)) == back
    assert len(ways) == there + back


def test_the_direction_of_a_flow_moves_nobody_who_has_the_same_seed() -> None:
    one, other = (
        _drawn("in-d0250-slow-c01-r02", f"crowd.flow.direction={way}") for way in ("in", "both")
    )
    assert one.x.tobytes() == other.x.tobytes()
    assert one.speed.tobytes() == other.speed.tobytes()
    assert one.attention.tobytes() == other.attention.tobytes()
    assert one.hash != other.hash
