"""What a spawn draws: places, groups, parameters, routes."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crowdbot.core.population.draws import Streams
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import group_reach
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.population.spawns import SpawnSampler
from crowdbot.dsl.checks.agents import overlapping
from crowdbot.dsl.checks.spawns import most_points
from crowdbot.dsl.spec.areas import Area
from tests.core.population.spawning_cases import AREAS, LINKS, STANDING, drawn, gaps, groups, hall


@settings(max_examples=60)
@given(
    st.tuples(st.floats(10, 30), st.floats(-8, 8)),
    st.tuples(st.floats(4, 10), st.floats(4, 10)),  # people placed at random must fit
    st.floats(-7, 7),
    st.integers(1, 12),
    st.none() | st.floats(0.1, 0.5),
    st.floats(0.0, 0.19),
    st.integers(0, 2**63 - 1),
)
def test_bodies_lie_inside_and_apart(
    centre: tuple[float, float],
    size: tuple[float, float],
    rotation: float,
    count: int,
    spacing: float | None,
    spread: float,
    seed: int,
) -> None:
    area = {"centre": centre, "size": size, "rotation": rotation}
    spawn = {
        "area": area,
        "count": count,
        "standing": True,
        "radius": {"value": 0.2, "spread": spread},
    } | ({"spacing": spacing} if spacing else {})
    table = drawn(seed, s=spawn)
    assert len(table) == count
    assert np.all(np.abs(table.radius - 0.2) <= spread + 1e-12)
    turn = np.array([[math.cos(rotation), math.sin(rotation)],
                     [-math.sin(rotation), math.cos(rotation)]])  # fmt: skip
    u, v = turn @ (np.stack([table.x, table.y]) - np.array(centre)[:, None])
    assert np.all(np.abs(u) <= size[0] / 2 - table.radius + 1e-6)
    assert np.all(np.abs(v) <= size[1] / 2 - table.radius + 1e-6)
    assert np.all(gaps(table) >= max(spacing or 0.0, 0.0) - 1e-12)
    assert np.all(gaps(table) >= table.radius[:, None] + table.radius - 1e-12)
    assert Realisation.from_csv(table.to_csv()).hash == table.hash


def test_places_are_even_over_a_turned_area() -> None:
    area = {"centre": [20, 0], "size": [12, 6], "rotation": 1.0}
    own = Area.model_validate(area)
    points = []
    for seed in range(150):
        table = drawn(seed, s={"area": area, "count": 8, "standing": True, "radius": 0.05})
        points += [own.own(x, y) for x, y in zip(table.x, table.y, strict=True)]
    u, v = np.array(points).T
    counts, _, _ = np.histogram2d(u, v, bins=(4, 2), range=[(-6, 6), (-3, 3)])
    assert np.all(np.abs(counts - 150) < 4.5 * math.sqrt(150))


def test_density_counts_people_on_the_area() -> None:
    area = {"centre": [20, 0], "size": [8, 5], "rotation": 0.7}
    assert len(drawn(s={"area": area, "density": 0.25, "standing": True})) == 10


@settings(max_examples=40)
@given(st.integers(1, 30), st.lists(st.integers(1, 6), min_size=1, max_size=3), st.integers(0, 99))
def test_groups_are_near_and_go_to_goals_beside_each_other(
    count: int, sizes: list[int], seed: int
) -> None:
    spawn = {
        "area": {"centre": [20, 0], "size": [20, 20]},
        "count": count,
        "groups": [{"size": size, "frequency": 1} for size in sizes],
        "goals": {"areas": ["n", "e"], "order": "random", "count": 3},
        "radius": 0.2,
    }
    table, cut = drawn(seed, s=spawn), 0
    alone = table.group < 0
    for members in groups(table):
        cut += len(members) not in sizes
        first = members[0]
        away = np.hypot(table.x[members] - table.x[first], table.y[members] - table.y[first])
        assert np.all(away <= group_reach(len(members), 0.4) + 1e-12)
        for stop in np.array([table.goals[i] for i in members]).swapaxes(0, 1):
            apart = np.hypot(*(stop[:, np.newaxis] - stop).T) + 9.0 * np.eye(len(members))
            assert apart.min() == pytest.approx(2.5 * 0.2)  # neighbours on a circle
            assert np.ptp(np.hypot(*(stop - stop.mean(axis=0)).T)) < 1e-9
        assert len(members) > 1
    if 1 not in sizes:
        cut += int(np.count_nonzero(alone))
    assert cut <= 1
    routes = [table.goals[g[0]] for g in groups(table)]
    routes += [table.goals[i] for i in np.flatnonzero(alone)]
    assert len(set(routes)) == len(routes)


def test_sizes_of_groups_follow_their_frequencies() -> None:
    frequencies = [{"size": 1, "frequency": 6}, {"size": 3, "frequency": 2}]
    spawn = {"area": "hall", "count": 800, "standing": True, "radius": 0.1, "groups": frequencies}
    table = drawn(s=spawn)
    threes, ones = len(list(groups(table))), int(np.count_nonzero(table.group < 0))
    assert threes / (threes + ones) == pytest.approx(0.25, abs=4 * math.sqrt(0.19 / 530))


class Recorder(Occupancy):
    """An occupancy that remembers the order in which people were added."""

    def __init__(self) -> None:
        super().__init__([])
        self.order: list[float] = []

    def add(self, x: float, y: float, radius: float) -> None:
        self.order.append(x)
        super().add(x, y, radius)


def test_larger_groups_choose_first() -> None:
    sizes = [{"size": 1, "frequency": 1}, {"size": 4, "frequency": 1}, {"size": 2, "frequency": 1}]
    spawn = {"area": "hall", "count": 40, "standing": True, "groups": sizes, "radius": 0.1}
    scenario, occupancy = hall({"spawns": {"s": spawn}}), Recorder()
    assert scenario.crowd is not None
    sampler = SpawnSampler(
        "s", scenario.crowd.spawns["s"], scenario, scenario.crowd, Streams(0, "")
    )
    rows = sampler.rows(occupancy, 0)
    members = Counter(row["group"] for row in rows)
    size = {row["x"]: members[row["group"]] if row["group"] >= 0 else 1 for row in rows}
    came = [size[x] for x in occupancy.order]
    assert came == sorted(came, reverse=True)
    assert len(set(came)) > 2
    assert [size[row["x"]] for row in rows] != came


@settings(max_examples=30)
@given(st.floats(0.5, 2.0), st.floats(0.0, 0.4), st.integers(0, 99))
def test_spread_is_a_bound_and_is_used(value: float, spread: float, seed: int) -> None:
    draw = {"value": value, "spread": spread}
    names = ("mass", "max_speed", "max_acceleration", "start_time", "speed")
    table = drawn(seed, s=STANDING | {"count": 20, **dict.fromkeys(names, draw)})
    for name in names:
        found = getattr(table, name)
        assert np.all(np.abs(found - value) <= spread + 1e-12)
        assert spread < 1e-3 or np.ptp(found) > 0.5 * spread
    assert spread < 1e-3 or not np.array_equal(table.mass, table.max_speed)


def test_speeds_are_truncated() -> None:
    speed = {"mean": 1.0, "std": 0.1}
    table = drawn(s={"area": "hall", "count": 600, "standing": True, "radius": 0.1, "speed": speed})
    assert np.all(np.abs(table.speed - 1.0) <= 0.3)
    assert np.mean(table.speed) == pytest.approx(1.0, abs=0.02)
    assert np.std(table.speed) == pytest.approx(0.1, rel=0.15)


def test_what_is_left_out_is_the_crowds() -> None:
    body = {"radius": 0.2, "mass": 60, "max_speed": 2, "max_acceleration": 4}
    table = realise(hall({"body": body, "spawns": {"s": STANDING}}))
    for name, value in body.items():
        assert set(getattr(table, name)) == {value}
    assert set(table.start_time) == {0.0}
    assert set(table.policy) == {""}


# ------------------------------------------------------------------------------- routes
def name_of(point: tuple[float, float]) -> str:
    inside = [
        name
        for name, goal in AREAS.items()
        if all(
            abs(w) <= s / 2 + 1e-9
            for w, s in zip(Area.model_validate(goal["area"]).own(*point), (2, 1), strict=True)
        )
    ]
    assert len(inside) == 1
    return inside[0]


def routes(seed: int, **goals: Any) -> list[str]:
    table = drawn(seed, s={"area": "box", "count": 12, "goals": goals})
    return ["".join(map(name_of, route)) for route in table.goals]


def test_fixed_goals_cycle() -> None:
    assert set(routes(1, areas=["n", "e", "s"])) == {"nes"}
    assert set(routes(1, areas=["n", "e"], count=5)) == {"nenen"}
    assert set(routes(1, areas=["n", "e"], count=1)) == {"n"}


def test_random_goals_are_any() -> None:
    found = [r for seed in range(30) for r in routes(seed, areas=["n", "e", "s"], order="random")]
    counts = np.array([sum(r[i] == a for r in found) for i in range(3) for a in "nes"])
    assert np.all(np.abs(counts - 120) < 5 * math.sqrt(80))
    assert any(r[0] == r[1] for r in found)


@settings(max_examples=30)
@given(st.integers(2, 9), st.integers(0, 10**6))
def test_linked_goals_follow_links_and_do_not_turn_back(count: int, seed: int) -> None:
    for route in routes(seed, areas=["n", "s"], order="linked", count=count):
        assert len(route) == count
        assert route[0] in "ns"
        for one, other in pairwise(route):
            assert other in LINKS[one]
        for before, here, after in zip(route, route[1:], route[2:], strict=False):
            assert after != before or LINKS[here] == [before]


def test_a_linked_loop_walks_back() -> None:
    for route in routes(4, areas=["n"], order="linked", count=4, at_goal="loop"):
        assert len(route) == 6
        assert route[4:] == route[2:0:-1]


def test_goals_are_spread_over_their_area() -> None:
    table = drawn(s={"area": "hall", "count": 300, "radius": 0.1, "goals": {"areas": ["e"]}})
    own = Area.model_validate(AREAS["e"]["area"])
    u, v = np.array([own.own(*route[0]) for route in table.goals]).T
    assert u.min() < -0.9
    assert u.max() > 0.9
    assert abs(np.mean(v)) < 5 * (1 / math.sqrt(12)) / math.sqrt(300)


def test_headings() -> None:
    walk = {"area": "box", "count": 5, "goals": {"areas": ["n"]}}
    table = drawn(walk=walk)
    goal = np.array([route[0] for route in table.goals])
    assert np.allclose(table.heading, np.arctan2(goal[:, 1] - table.y, goal[:, 0] - table.x))
    assert set(drawn(walk=walk | {"heading": "90 deg"}).heading) == {math.pi / 2}
    turned = drawn(walk=walk | {"heading": "random", "area": "hall", "count": 40}).heading
    assert len(set(turned)) == 40
    assert np.all(np.abs(turned) <= math.pi)
    stream = {"area": "box", "count": 3, "portals": ["b", "a"]}
    assert set(drawn(stream=stream).heading) == {math.pi}


def test_at_goal_and_portals() -> None:
    table = drawn(
        a={"area": "box", "count": 1, "portals": ["b", "a"]},
        b={"area": "box", "count": 1, "goals": {"areas": ["n"], "at_goal": "remove"}},
        c={"area": "box", "count": 1, "standing": True},
    )
    assert table.at_goal == ("portal", "remove", "stop")
    assert table.portals == (("b", "a"), ("", ""), ("", ""))
    assert table.goals[0] == ()
    assert table.goals[2] == ((table.x[2], table.y[2]),)


def test_a_policy_is_drawn_evenly() -> None:
    spawn = {"area": "hall", "count": 300, "radius": 0.1, "standing": True, "policy": ["p", "q"]}
    policy = {"policy": {"kind": "velocity_space"}, "costs": {"reflex": {"kind": "rvo"}}}
    table = realise(hall({"spawns": {"s": spawn}, "policies": {"p": policy, "q": policy}}))
    assert set(table.policy) == {"p", "q"}
    assert abs(table.policy.count("p") - 150) < 4.5 * math.sqrt(75)


# ------------------------------------------------------------------------------- bounds
@settings(max_examples=200)
@given(st.lists(st.tuples(st.integers(0, 40), st.integers(0, 40), st.integers(1, 5)), max_size=25))
def test_overlaps_are_found(found: list[tuple[int, int, int]]) -> None:
    discs = [(x / 8, y / 8, r / 8) for x, y, r in found]
    wanted = {
        k
        for k in range(len(discs))
        if any(
            math.dist(discs[i][:2], discs[k][:2]) < discs[i][2] + discs[k][2] - 1e-9
            for i in range(k)
        )
    }
    pairs = list(overlapping(discs))
    assert {k for _, k in pairs} == wanted
    assert all(i < k for i, k in pairs)


@settings(max_examples=100)
@given(st.floats(0.5, 20), st.floats(0.5, 20), st.floats(0.2, 2.0), st.floats(0.0, 0.2))
def test_the_bound_on_people_holds_for_the_densest_rows(
    a: float, b: float, spacing: float, margin: float
) -> None:
    """Rows of a triangular lattice; the bound must not be below them, nor far above for many."""
    w, h = a - 2 * margin, b - 2 * margin
    assume(min(w, h) > 0)
    rows = math.floor(h / (spacing * math.sqrt(3) / 2) + 1e-12) + 1
    full = math.floor(w / spacing + 1e-12) + 1
    short = math.floor(max(w - spacing / 2, -1) / spacing + 1e-12) + 1
    lattice = (rows + 1) // 2 * full + rows // 2 * short
    bound = most_points((a, b), margin, spacing)
    assert bound >= lattice
    assert bound <= 2 * w * h / (math.sqrt(3) * spacing**2) + (w + h) / spacing + 1.001


def test_a_body_that_just_fits() -> None:
    assert most_points((0.66, 0.66), 0.33, 0.66) == 1
    assert most_points((0.65, 2.0), 0.33, 0.66) == 0
    assert most_points((0.66, 1.32), 0.33, 0.66) == 2
