"""Several spawns, agents, a flow and robots: draws stay apart, people do too."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.crowd.agents import PORTAL
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.dsl.identity.population_inputs import population_inputs
from crowdbot.dsl.scenario.spawning import CLEAR_OF_ROBOT
from crowdbot.dsl.spec.areas import Area
from crowdbot.errors import InputError
from tests.core.population.spawning_cases import (
    AREAS,
    CROWD,
    REGISTRY,
    STANDING,
    columns,
    drawn,
    gaps,
    hall,
)

# ---------------------------------------------------------------------- independence
ONE: dict[str, Any] = {
    "area": {"centre": [30, 10], "size": [8, 8], "rotation": 0.4},
    "count": 9,
    "groups": [{"size": 1, "frequency": 1}, {"size": 3, "frequency": 1}],
    "goals": {"areas": ["n", "w"], "order": "linked", "count": 4},
    "speed": {"value": 1.2, "spread": 0.3},
    "radius": {"value": 0.25, "spread": 0.05},
    "start_time": {"value": 5, "spread": 5},
    "heading": "random",
}
CHANGES: list[dict[str, Any]] = [
    {},
    {"count": 5},
    {"mass": {"value": 70, "spread": 9}},
    {"radius": 0.1},
    {"groups": [{"size": 2, "frequency": 1}]},
    {"speed": 1.0},
    {"heading": 1.0},
    {"standing": False, "portals": ["a", "b"]},
]


@pytest.mark.parametrize("change", CHANGES, ids=lambda c: next(iter(c), "none"))
@pytest.mark.parametrize("name", ["a", "z"])
def test_another_spawn_changes_nothing(name: str, change: dict[str, Any]) -> None:
    alone = columns(drawn(7, one=ONE))
    both = drawn(7, one=ONE, **{name: STANDING | change})
    mine = slice(0, 9) if name > "one" else slice(len(both) - 9, None)
    assert columns(both, mine) == alone
    assert sorted(both.id) == list(range(len(both)))


@pytest.mark.parametrize(
    ("field", "value", "moved"),
    [
        ("speed", {"value": 1.2, "spread": 0.1}, {"speed"}),
        ("start_time", 3, {"start_time"}),
        ("mass", {"value": 70, "spread": 9}, {"mass"}),
        ("heading", 1.0, {"heading"}),
        ("goals", {"areas": ["n", "w"], "order": "random", "count": 4}, {"goals"}),
        ("goals", ONE["goals"] | {"at_goal": "remove"}, {"at_goal"}),
    ],
)
def test_a_field_changes_its_own_draws_alone(field: str, value: Any, moved: set[str]) -> None:
    before, after = columns(drawn(7, one=ONE)), columns(drawn(7, one=ONE | {field: value}))
    assert {name for name in before if before[name] != after[name]} == moved


def test_more_people_leave_the_first_where_they_were() -> None:
    few, many = drawn(3, s=STANDING | {"count": 8}), drawn(3, s=STANDING | {"count": 12})
    assert columns(many, slice(0, 8)) == columns(few)


def test_another_name_or_seed_is_another_draw() -> None:
    base = drawn(0, s=STANDING)
    assert not np.any(base.x == drawn(0, t=STANDING).x)
    assert not np.any(base.x == drawn(1, s=STANDING).x)


# --------------------------------------------------------------------------- together
def test_nobody_overlaps_with_anybody() -> None:
    agents = [
        {"id": i, "x": 3 + i, "y": 0, "goals": [[3 + i, 0]], "radius": 0.3} for i in (1, 2, 5)
    ]
    flow = {"direction": "in", "density": 0.25, "area": "box"}
    table = realise(
        hall({"flow": flow, "agents": agents, "spawns": {"s": STANDING, "t": STANDING}})
    )
    assert len(table) == 9 + 3 + 16
    assert np.all(gaps(table) >= table.radius[:, None] + table.radius - 1e-12)
    assert list(table.id) == list(range(28))
    assert [table.x[i] for i in (1, 2, 5)] == [4, 5, 8]


def test_spacing_holds_within_a_spawn_alone() -> None:
    """Three who keep 3 m apart fit between others who do not."""
    table = drawn(others=STANDING, spaced=STANDING | {"count": 3, "spacing": 3})
    assert np.min(gaps(table)[8:, 8:]) >= 3.0
    assert np.min(gaps(table)[:8, 8:]) < 3.0


def test_explicit_groups_keep_their_numbers() -> None:
    agents = [{"id": 0, "x": 20, "y": 0, "goals": [[9, 9]], "group": 4}]
    pairs = STANDING | {"groups": [{"size": 2, "frequency": 1}]}
    table = realise(hall({"agents": agents, "spawns": {"s": pairs, "t": pairs}}))
    assert sorted(set(table.group.tolist())) == list(range(4, 13))
    assert table.group[0] == 4


def test_people_keep_clear_of_robots() -> None:
    crowd = {"flow": {"direction": "in", "density": 0.5, "area": "box"}, "spawns": {"s": STANDING}}
    starts = [(4.0, 0.0), (7.0, 2.0)]
    for seed in range(10):
        table = realise(hall(crowd | {"seed": {"root": seed}}, *starts))
        for x, y in starts:
            assert np.all(np.hypot(table.x - x, table.y - y) >= CLEAR_OF_ROBOT)


def test_the_distance_to_robots_is_that_of_the_portals() -> None:
    from crowdbot.core.crowd import portals

    assert portals.CLEAR_OF_ROBOT == CLEAR_OF_ROBOT


def test_a_robot_moves_only_those_in_its_way() -> None:
    spawn = {"area": "hall", "count": 200, "standing": True, "radius": 0.2}
    without = realise(hall({"spawns": {"s": spawn}}))
    crowded = realise(hall({"spawns": {"s": spawn}}, (20.0, 0.0)))
    moved = (without.x != crowded.x) | (without.y != crowded.y)
    near = np.hypot(without.x - 20.0, without.y) < CLEAR_OF_ROBOT
    assert np.all(moved[near])
    assert np.count_nonzero(moved & ~near) <= 2


def test_a_full_area_says_how_many_fitted() -> None:
    area = {"centre": [20, 0], "size": [2, 3]}
    with pytest.raises(InputError, match=r"only (\d) of 14 people of spawn 's' fit into its area"):
        drawn(s={"area": area, "count": 14, "standing": True})


def test_explicit_agents_take_what_they_do_not_say_from_the_crowd() -> None:
    agents = [
        {"id": 3, "x": 1, "y": 2, "goals": [[1, 9]]},
        {"id": 4, "x": 5, "y": 5, "portals": ["b", "a"], "speed": 2, "radius": 0.1, "heading": 1},
    ]
    both, one = realise(hall({"agents": agents})), realise(hall({"agents": agents[:1]}))
    assert both.radius.tolist() == [0.33, 0.1]
    assert both.heading.tolist() == [math.pi / 2, 1.0]
    assert both.at_goal == ("stop", "portal")
    assert both.speed[0] == one.speed[0]
    assert 0.7 <= both.speed[0] <= 1.9
    assert both.speed[1] == 2.0


STREAM = {"area": "box", "count": 2, "portals": ["a", "b"]}
MIXED = {
    "spawns": {
        "s": STREAM,
        "t": STREAM | {"portals": ["b", "a"], "policy": "p"},
        "u": STANDING,
        "v": {"area": "box", "count": 1, "start_time": 0.5, "goals": {"areas": ["n"]}},
    },
    "policies": {"p": {"policy": CROWD["policy"], "costs": CROWD["costs"]}},
    "goal_areas": AREAS,
}


def test_the_engine_is_given_all_of_it() -> None:
    """Streams, policies, routes and start times find the agents that they belong to."""
    scenario = hall(MIXED)
    drawn = realise(scenario)
    engine = build_crowd(
        scenario, drawn, build_environment(REGISTRY, scenario.environment), REGISTRY
    )
    assert engine is not None
    agents = engine.agents
    for i in range(len(agents)):
        assert (agents.at_goal[i] == PORTAL) == (drawn.at_goal[i] == "portal")
        assert agents.policy[i] == (drawn.policy[i] == "p")
        route = agents.route[agents.first[i] : agents.first[i + 1]]
        assert route.tolist() == [list(point) for point in drawn.goals[i]]
        if drawn.at_goal[i] == "portal":
            box = build_environment(REGISTRY, scenario.environment).portals[drawn.portals[i][0]]
            assert engine.world.entrance[agents.flow[i]].tolist() == list(box)
    assert agents.start_time.tolist().count(0.5) == 1
    times, positions = engine.run(2.0)
    assert times[-1] == 2.0
    assert np.isnan(positions[0]).any(axis=1).sum() == 1
    assert np.isfinite(positions[-1]).all()


def test_a_stream_that_the_engine_knows_runs() -> None:
    scenario = hall({"spawns": {"s": STREAM}})
    engine = build_crowd(
        scenario, realise(scenario), build_environment(REGISTRY, scenario.environment), REGISTRY
    )
    assert engine is not None
    assert len(engine.agents) == 2
    assert engine.world.out.tolist() == [[40, 41, -5, 5]]


@pytest.mark.parametrize(
    ("start", "counts"),
    [((1.5, 0.0), True), ((0.5, 0.0), False), ((5.0, 0.0), True), ((30.0, 10.0), False)],
)
def test_a_lock_knows_which_robots_move_people(start: tuple[float, float], counts: bool) -> None:
    alone, met = hall({"spawns": {"s": STANDING}}), hall({"spawns": {"s": STANDING}}, start)
    assert (population_inputs(met) != population_inputs(alone)) == counts
    if not counts:
        assert realise(met).hash == realise(alone).hash


@given(st.floats(-30, 30), st.floats(-30, 30), st.floats(-7, 7))
def test_the_distance_to_an_area_is_that_to_its_nearest_point(
    x: float, y: float, rotation: float
) -> None:
    area = Area(centre=(1.0, 2.0), size=(6.0, 3.0), rotation=rotation)
    grid = [area.point(u, v) for u in np.linspace(-3, 3, 41) for v in np.linspace(-1.5, 1.5, 21)]
    near = min(math.dist((x, y), point) for point in grid)
    assert near - 0.12 <= area.distance(x, y) <= near + 1e-9


@pytest.mark.parametrize(("point", "goal"), [("random", "ahead"), ("offset", "random")])
def test_the_points_of_portals_reach_the_engine(point: str, goal: str) -> None:
    scenario = hall({"spawns": {"s": STREAM}, "exit_point": point, "goal_point": goal})
    engine = build_crowd(
        scenario, realise(scenario), build_environment(REGISTRY, scenario.environment), REGISTRY
    )
    assert engine is not None
    assert (engine.world.exit_point, engine.world.goal_point) == (point, goal)
