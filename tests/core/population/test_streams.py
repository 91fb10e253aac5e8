"""What streams are drawn to: numbers, places, ways, arrivals; the table that keeps them."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.population.arrivals import arrival_times
from crowdbot.core.population.realisation import COLUMNS, Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.population.stream_routes import border_to_border
from crowdbot.dsl.scenario.agent_tables import join_tables, split_tables
from crowdbot.dsl.scenario.stream import Arrivals
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.outlines import along
from crowdbot.errors import InputError
from tests.core.population.spawning_cases import AREAS, REGISTRY, gaps, hall

EAST: dict[str, Any] = {"kind": "through", "origin": "a", "destination": "b", "start": "hall"}
LINE: dict[str, Any] = {"kind": "queue", "line": [[10, 0], [20, 0]], "destination": "b"}
TORUS: dict[str, Any] = {
    "kind": "floor",
    "border": "torus",
    "area": {"x": [0, 20], "y": [0, 10]},
    "zones": {"all": {"x": [0, 20], "y": [0, 10]}},
}


def drawn(environment: dict[str, Any] | None = None, /, **streams: dict[str, Any]) -> Realisation:
    scenario = hall({"streams": streams, "goal_areas": AREAS})
    if environment is not None:
        document = scenario.model_dump(mode="json") | {"environment": environment}
        document["crowd"]["goal_areas"] = {}
        scenario = REGISTRY.scenario_model.model_validate(document)
    return realise(scenario)


def test_two_streams_keep_their_own_numbers_and_clear_of_each_other() -> None:
    table = drawn(east=EAST | {"count": 30}, west=EAST | {"origin": "b", "density": 0.0125})
    assert len(table) == 50
    assert gaps(table).min() >= 0.66 - 1e-9
    assert set(table.at_goal) == {"return"}
    assert {o[0] for o in table.origin} == {-0.5, 40.5}


def test_a_stream_does_not_move_another() -> None:
    alone, both = (
        drawn(east=EAST | {"count": 5}),
        drawn(east=EAST | {"count": 5}, north=EAST | {"count": 3}),
    )
    assert both.x[:5].tolist() == alone.x.tolist()
    assert both.speed[:5].tolist() == alone.speed.tolist()


@pytest.mark.parametrize("lanes", [2, 5])
def test_lanes_are_kept(lanes: int) -> None:
    table = drawn(east=EAST | {"count": 20, "lanes": {"of": lanes, "use": [0, lanes - 1]}})
    width = 40.0 / lanes
    lane = np.floor((table.y + 20.0) / width).astype(int)
    assert set(lane.tolist()) == {0, lanes - 1}
    for i, way in enumerate(table.goals):  # the goal lies in the same share of its own area
        assert math.floor((way[-1][1] + 5.0) / (10.0 / lanes)) == lane[i]


def test_arrivals_come_in_order_and_leave() -> None:
    poisson = EAST | {"start": None, "arrivals": {"rate": 0.5, "until": 100}}
    table = drawn(east=poisson, bus=poisson | {"arrivals": {"times": [7, 3, 3]}})
    bus = table.start_time[:3].tolist()
    assert bus == [3.0, 3.0, 7.0]
    later = table.start_time[3:]
    assert np.all(np.diff(later) >= 0.0)
    assert later[-1] < 100.0
    assert 25 < len(later) < 80
    assert set(table.at_goal) == {"remove"}


@given(st.floats(0.05, 5.0), st.floats(1.0, 60.0), st.integers(0, 2**31))
@settings(max_examples=30)
def test_a_later_end_adds_arrivals_and_moves_none(rate: float, until: float, seed: int) -> None:
    short = arrival_times(Arrivals(rate=rate, until=until), np.random.default_rng(seed))
    longer = arrival_times(Arrivals(rate=rate, until=until + 9), np.random.default_rng(seed))
    assert longer[: len(short)] == short
    assert all(until <= t < until + 9 for t in longer[len(short) :])


def test_steady_arrivals() -> None:
    rng = np.random.default_rng(0)
    assert arrival_times(Arrivals(every=2.0, begin=1.0, until=7.0), rng) == [1.0, 3.0, 5.0]


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ({"rate": 1.0}, "until"),
        ({"rate": 1.0, "every": 1.0, "until": 3.0}, "one of"),
        ({"times": (1.0,), "until": 3.0}, "belong"),
        ({}, "one of"),
    ],
)
def test_arrivals_that_contradict_themselves(wrong: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        Arrivals(**wrong)


def test_everybody_has_a_direction_of_his_own() -> None:
    table = drawn(TORUS, any={"kind": "directions", "area": "all", "density": 0.2})
    angle = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in table.goals]
    assert len(table) == 40
    assert set(table.at_goal) == {"onward"}
    assert np.hypot(np.cos(angle).mean(), np.sin(angle).mean()) < 0.4
    assert np.allclose(table.heading, angle)


@given(st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(-3.1, 3.1), st.integers(0, 10**6))
@settings(max_examples=60)
def test_walks_from_border_to_border_stay_inside(
    u: float, v: float, turn: float, seed: int
) -> None:
    area = Area(centre=(4.0, -2.0), size=(8.0, 4.0), rotation=turn)
    rng = np.random.default_rng(seed)
    way = border_to_border(area, area.point(u, v), 0.3, (), rng)
    assert way.at_goal == "loop"
    for point in way.goals:
        a, b = area.own(*point)
        assert abs(a) <= 3.4 + 1e-9
        assert abs(b) <= 1.4 + 1e-9
    assert all(math.dist(p, q) > 0.5 for p, q in zip(way.goals, way.goals[1:], strict=False))


def test_a_queue_stands_in_its_line_and_moves_up() -> None:
    table = drawn(line=LINE | {"count": 4, "gap": 1.0, "service": 5.0})
    assert table.x.tolist() == pytest.approx([10.0, 11.0, 12.0, 13.0])
    assert [len(way) for way in table.goals] == [2, 3, 4, 5]
    assert all(p[-2] == 5.0 and set(p[:-2]) <= {0.0} and p[-1] == 0.0 for p in table.pauses)
    assert len(set(table.queue.tolist())) == 1
    assert table.heading[1:].tolist() == pytest.approx([math.pi] * 3)


def test_who_joins_a_queue_comes_to_its_end() -> None:
    table = drawn(line=LINE | {"arrivals": {"every": 4, "until": 11}, "gap": 1.0})
    assert table.x.tolist() == pytest.approx([20.0] * 3)
    assert {len(way) for way in table.goals} == {12}


@given(st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=2, max_size=5))
def test_places_on_a_line_are_on_it(line: list[tuple[float, float]]) -> None:
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(line))
    places = list(along(line, 0.7))
    assert abs(len(places) - (length / 0.7 + 1)) <= 1.0 + 1e-6
    assert places[0] == pytest.approx(line[0])


def test_talkers_stand_in_circles_and_look_inwards() -> None:
    talk = {"kind": "talking", "count": 8, "area": "box", "groups": [{"size": 4, "frequency": 1}]}
    table = drawn(talk=talk)
    for number in (0, 1):
        members = np.flatnonzero(table.group == number)
        middle = np.array([table.x[members].mean(), table.y[members].mean()])
        to = np.arctan2(middle[1] - table.y[members], middle[0] - table.x[members])
        assert np.allclose(np.cos(table.heading[members] - to), 1.0)
    assert gaps(table).min() >= 0.9 - 1e-9


def test_strolling_groups_share_their_areas_and_pauses() -> None:
    stroll = {
        "kind": "wandering", "area": "box", "count": 4, "areas": ["n", "e"],
        "pause": {"value": 3, "spread": 1}, "groups": [{"size": 2, "frequency": 1}],
    }  # fmt: skip
    table = drawn(stroll=stroll)
    assert table.goals[0] == table.goals[1] != table.goals[2]
    assert table.pauses[0] == table.pauses[1]
    assert all(2.0 <= p <= 4.0 for p in table.pauses[0])


def test_too_many_people_are_refused() -> None:
    with pytest.raises(InputError, match="stream 'full'"):
        drawn(full=EAST | {"start": "box", "count": 80})


def test_the_table_reads_back_and_tables_of_others_lack_its_columns() -> None:
    stream = drawn(east=EAST | {"count": 3}, line=LINE | {"count": 3}).to_csv()
    plain = realise(hall({"spawns": {"s": {"area": "box", "count": 2, "standing": True}}})).to_csv()
    assert Realisation.from_csv(stream).to_csv() == stream
    assert plain.splitlines()[0] == ",".join(COLUMNS)
    for tables in ({"a": plain, "b": stream}, {"b": stream, "a": plain}):
        split = split_tables(join_tables(tables), "x")
        assert {name: split[name] for name in tables} == tables


@pytest.mark.parametrize(
    ("column", "cell", "why"),
    [
        ("origin", "1 2", "5 numbers"),
        ("goal_areas", "1 2 3;1 2 3", "one entry"),
        ("pauses", "nan", "finite"),
        ("queue", "x", "invalid literal"),
    ],
)
def test_cells_that_are_wrong_are_told(column: str, cell: str, why: str) -> None:
    rows = drawn(east=EAST | {"count": 1}, line=LINE | {"count": 1}).to_csv().splitlines()
    place = rows[0].split(",").index(column)
    cells = rows[1].split(",")
    cells[place] = cell
    with pytest.raises(InputError, match=f"line 2: .*{why}"):
        Realisation.from_csv("\n".join([rows[0], ",".join(cells), *rows[2:]]))
