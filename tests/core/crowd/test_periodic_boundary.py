"""The periodic boundary: wrapping, images across borders, goals; pillars beside it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.periodic_boundary import images
from crowdbot.core.crowd.response.parameters import Human
from tests.core.crowd.crowd_reference import Array, agents_of
from tests.core.crowd.crowd_worlds import TICKS, Straight, ToGoal, rows, walkers

BOX = (0.0, 20.0, -5.0, 5.0)
NOWHERE = np.zeros((0, 4))


def _toric(agents: Agents, **changes: object) -> CrowdEngine:
    """Walkers of the challenge's kind on a periodic floor."""
    given = {
        "periodic_boundary": BOX,
        "walls": NOWHERE,
        "entrance": NOWHERE,
        "out": NOWHERE,
        **changes,
    }
    return walkers(agents, **given)


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 9.0))
@settings(max_examples=40)
def test_images_are_everything_within_reach_of_the_floor(seed: int, reach: float) -> None:
    """Against the endless plane, tiled by hand."""
    rng = np.random.default_rng(seed)
    discs = np.column_stack([rng.uniform(0, 20, 9), rng.uniform(-5, 5, 9), rng.normal(size=(9, 3))])
    tiled = set()
    for nx in (-1, 0, 1):
        for ny in (-1, 0, 1):
            for d in discs:
                x, y = d[0] + 20.0 * nx, d[1] + 10.0 * ny
                away = math.hypot(max(0.0, -x, x - 20.0), max(0.0, -5.0 - y, y - 5.0))
                if (nx or ny) and away < reach:
                    tiled.add((x, y, *d[2:].tolist()))
    assert {tuple(row) for row in images(discs, BOX, reach).tolist()} == tiled
    axes = {tuple(row) for row in images(discs, BOX, reach, diagonal=False).tolist()}
    assert axes == {i for i in tiled if 0.0 <= i[0] <= 20.0 or -5.0 <= i[1] <= 5.0}


def test_an_infinite_side_has_no_images() -> None:
    discs = np.array([[0.1, 3.0, 1.0, 0.0, 0.33]])
    found = images(discs, (0.0, 20.0, -math.inf, math.inf), 2.0)
    assert found.tolist() == [[20.1, 3.0, 1.0, 0.0, 0.33]]


def test_people_wrap_and_that_is_a_jump() -> None:
    agents = Agents.of(
        x=[19.5, 0.5, 10.0], y=[0.0, 1.0, 4.5], preferred_speed=1.0,
        routes=[[(90.0, 0.0)], [(-90.0, 1.0)], [(10.0, 90.0)]],
    )  # fmt: skip
    engine = CrowdEngine(agents, CrowdWorld(periodic_boundary=BOX), Straight())
    flat = engine.initial_state()
    for _ in range(TICKS):
        engine.advance(flat)
    assert rows(flat)[:, [s.X, s.Y]] == pytest.approx(
        np.array([[0.5, 0.0], [19.5, 1.0], [10.0, -4.5]])
    )
    assert list(rows(flat)[:, s.JUMPS]) == [1.0, 1.0, 1.0]
    assert list(rows(flat)[:, s.ARRIVALS]) == [0.0] * 3


def _route(route: list[tuple[float, float]], seconds: float, **changes: object) -> Array:
    agents = Agents.of(x=18.0, y=0.0, preferred_speed=1.0, routes=[route], **changes)  # type: ignore[arg-type]
    engine = CrowdEngine(agents, CrowdWorld(periodic_boundary=BOX), ToGoal())
    flat = engine.initial_state()
    for _ in range(int(seconds * TICKS)):
        engine.advance(flat)
    last: Array = rows(flat)[0]
    return last


@pytest.mark.slow
def test_goals_are_points_of_the_endless_plane() -> None:
    """A goal beyond the border is reached on the other side; one on the floor by no short cut."""
    assert _route([(25.0, 0.0)], 6.9)[s.ARRIVALS] == 1.0
    assert _route([(25.0, 0.0)], 6.5)[s.ARRIVALS] == 0.0
    assert _route([(2.0, 0.0)], 10.0)[s.ARRIVALS] == 0.0
    assert _route([(2.0, 0.0)], 16.0)[s.ARRIVALS] == 1.0
    there = _route([(25.0, 0.0), (25.0, 3.0)], 12.0)
    assert there[s.ARRIVALS] == 2.0
    assert there[[s.X, s.Y]] == pytest.approx([5.0, 3.0], abs=0.4)


@pytest.mark.slow
def test_laps_around_a_periodic_floor() -> None:
    """One point beyond the border, again and again: 20 m a lap after the first 7 m."""
    assert _route([(25.0, 0.0)], 60.0, at_goal=3)[s.ARRIVALS] == 3.0


@pytest.mark.slow
def test_the_original_does_not_move_goals() -> None:
    agents = Agents.of(x=18.0, y=0.0, preferred_speed=1.0, routes=[[(25.0, 0.0)]])
    engine = CrowdEngine(agents, CrowdWorld(periodic_boundary=BOX, parity=True), ToGoal())
    flat = engine.initial_state()
    for _ in range(60 * TICKS):
        engine.advance(flat)
    assert rows(flat)[0, s.ARRIVALS] == 0.0
    assert rows(flat)[0, s.GOAL_X] == 25.0


@pytest.mark.parametrize("shift", [(0.0, 0.0), (7.3, 0.0), (0.0, 3.1), (13.0, -4.0)])
def test_the_border_is_nowhere(shift: tuple[float, float]) -> None:
    """A crowd shifted on a periodic floor walks as before: nobody notices where the border is."""
    rng = np.random.default_rng(3)
    grid = [(1.0 + 2.0 * c, -4.0 + 2.0 * r) for c in range(10) for r in range(5)]
    at = np.array(grid) + rng.uniform(-0.5, 0.5, (50, 2))
    heading = rng.integers(0, 2, 50) * 2.0 - 1.0

    def run(offset: tuple[float, float]) -> Array:
        moved = at + offset
        low, size = np.array([0.0, -5.0]), np.array([20.0, 10.0])
        place = low + np.mod(moved - low, size)
        agents = Agents.of(
            x=place[:, 0], y=place[:, 1], preferred_speed=1.2,
            routes=[[(x + 900.0 * h, y)] for (x, y), h in zip(place, heading, strict=True)],
        )  # fmt: skip
        engine = _toric(agents)
        flat = engine.initial_state()
        for _ in range(3 * TICKS):
            engine.advance(flat)
        return np.asarray(low + np.mod(rows(flat)[:, : s.Y + 1] - offset - low, size))

    apart = np.abs(run(shift) - run((0.0, 0.0)))
    apart = np.minimum(apart, np.array([20.0, 10.0]) - apart)
    assert np.mean(np.hypot(*apart.T) < 1e-6) > 0.9  # exact ties may go either way


def test_people_push_each_other_across_the_border_and_the_corner() -> None:
    agents = agents_of(np.array([[0.1, 4.9], [19.9, -4.9], [10.0, 0.0]]), 0.0)
    for parity, pushed in ((False, True), (True, False)):
        engine = CrowdEngine(
            Agents.of(x=agents.x, y=agents.y, preferred_speed=0.0, routes=[[]] * 3),
            CrowdWorld(periodic_boundary=BOX, parity=parity), ToGoal(contact_stiffness=62.5),
        )  # fmt: skip
        flat = engine.initial_state()
        engine.advance(flat)
        push = rows(flat)[:, s.PUSH_X : s.PUSH_Y + 1]
        assert np.any(push) == pushed
        assert push.sum(axis=0) == pytest.approx([0.0, 0.0])
        if pushed:
            gap = math.hypot(0.2, 0.2)
            assert np.hypot(*push[0]) == pytest.approx(62.5 * (0.66 - gap))
            assert push[0, 0] > 0.0 > push[0, 1]


class Spy(Straight):
    """Remembers what it was shown."""

    def accelerations(self, view: CrowdView) -> Array:
        self.others = view.others(3.0)
        return np.zeros_like(view.position)


def test_a_policy_sees_robots_pillars_and_images() -> None:
    spy = Spy()
    agents = Agents.of(x=[1.0, 10.0], y=0.0, start_time=[0.0, 0.0], routes=[[(9.0, 0.0)]] * 2)
    shown = Human(shown_to_policies=True)
    world = CrowdWorld(periodic_boundary=BOX, pillars=np.array([5.0, 1.0, 0.4]), response=shown)
    engine = CrowdEngine(agents, world, spy)
    flat = engine.initial_state()
    engine.advance(flat, np.array([[7.0, 2.0, 0.1, 0.2, 0.178, 0.428]]))
    assert spy.others.tolist() == [
        [7.0, 2.0, 0.1, 0.2, 0.428], [5.0, 1.0, 0.0, 0.0, 0.4], [21.0, 0.0, 1.4, 0.0, 0.33],
    ]  # fmt: skip


def test_people_walk_around_pillars() -> None:
    """A stream through three pillars: nobody enters one by more than people overlap."""
    rng = np.random.default_rng(1)
    n = 40
    agents = Agents.of(
        x=np.arange(n) * 0.4, y=rng.uniform(-3.0, 3.0, n), preferred_speed=1.2,
        routes=[[(900.0, 0.0)]] * n,
    )  # fmt: skip
    pillars = np.array([[18.5, -2.0, 0.5], [19.0, 0.2, 0.3], [18.0, 2.2, 0.8]])
    engine = walkers(agents, pillars=pillars, walls=np.array([[0.0, -5, 90, -5], [90, 5, 0, 5.0]]))
    flat = engine.initial_state()
    deepest = -9.0
    for _ in range(30 * TICKS):
        engine.advance(flat)
        at = rows(flat)[:, : s.Y + 1]
        away = np.hypot(*(at[:, None] - pillars[:, :2]).transpose(2, 0, 1)) - pillars[:, 2]
        deepest = max(deepest, float(np.max(0.33 - away)))
    assert deepest < 0.25
    assert np.mean(rows(flat)[:, s.X] > 25.0) > 0.95


def test_standing_people_are_pushed_off_a_pillar() -> None:
    agents = Agents.of(x=[0.5], y=[0.0], preferred_speed=0.0, routes=[[]])
    engine = CrowdEngine(
        agents, CrowdWorld(pillars=np.array([[0.0, 0.0, 0.4]])), ToGoal(contact_stiffness=62.5)
    )
    flat = engine.initial_state()
    for _ in range(TICKS):
        engine.advance(flat)
    assert rows(flat)[0, s.X] > 0.6
