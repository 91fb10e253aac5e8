"""Pushes between people, contact with the robot, and what is recorded of contacts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.pedestrian_contact import PLACED, push_apart
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.geometry.segment_grid import segment_grid
from crowdbot.core.support.records import rows_in, rows_of
from tests.core.crowd.crowd_reference import Array, agents_of
from tests.core.crowd.crowd_worlds import TICKS, rows, unmoved, walkers

DT = 1.0 / TICKS
NO_WALLS, NO_DISCS = np.zeros((0, 4)), np.zeros((0, 3))


def _people(position: list[tuple[float, float]]) -> Array:
    found = np.zeros((len(position), s.AGENT_COLUMNS))
    found[:, s.X : s.Y + 1] = position
    return found


def _push_apart(
    people: Array,
    radius: ArrayLike,
    order: NDArray[np.int64],
    walls: Array,
    discs: Array,
    stiffness: ArrayLike,
    dissipation: float = 0.0,
) -> None:
    traits = rows_of(len(people), TRAITS)
    traits["radius"][:], traits["push"][:] = radius, stiffness
    placed, room = rows_of(len(people), PLACED), np.zeros(len(people))
    grid = segment_grid(walls, float(np.max(radius)))
    push_apart(
        rows_in(people, s.PERSON), traits, order, walls, *grid, discs, len(discs), dissipation,
        placed, room,
    )  # fmt: skip


def _push(people: Array, radius: float = 0.33, walls: Array | None = None) -> Array:
    order = np.argsort(people[:, s.X], kind="stable")
    segments = NO_WALLS if walls is None else walls
    _push_apart(people, radius, order, segments, NO_DISCS, 62.5)
    return people[:, s.PUSH_X : s.PUSH_Y + 1]


def test_two_people_push_each_other_apart() -> None:
    found = _push(_people([(0.0, 0.0), (0.5, 0.0)]))
    assert found == pytest.approx(np.array([[-10.0, 0.0], [10.0, 0.0]]))


NUMBERS = st.floats(0, 2).filter(lambda x: x == 0.0 or x > 1e-100)


@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=2, max_size=12))
@settings(max_examples=60)
def test_pushes_balance_and_match_all_pairs(position: list[tuple[float, float]]) -> None:
    found = _push(_people(position))
    assert np.sum(found, axis=0) == pytest.approx(np.zeros(2), abs=1e-9)
    at = np.array(position)
    expected = np.zeros_like(at)
    for i, j in np.argwhere(~np.eye(len(at), dtype=bool)):
        offset = at[i] - at[j]
        distance = float(np.hypot(*offset))
        if distance * distance > 0.0 and distance < 0.66:
            expected[i] += 62.5 * (0.66 - distance) * offset / distance
    assert found == pytest.approx(expected, abs=1e-6)


def test_people_of_different_size_are_found() -> None:
    people = _people([(0.0, 0.0), (0.9, 0.0), (0.2, 3.0)])
    order = np.argsort(people[:, s.X], kind="stable")
    _push_apart(people, [0.2, 0.8, 0.2], order, NO_WALLS, NO_DISCS, 10.0)
    assert people[0, s.PUSH_X] == pytest.approx(-1.0)
    assert people[1, s.PUSH_X] == pytest.approx(1.0)


def test_a_wall_pushes_back() -> None:
    wall = np.array([[-5.0, 0.0, 5.0, 0.0]])
    assert _push(_people([(0.0, 0.23)]), walls=wall)[0] == pytest.approx([0.0, 6.25])
    assert _push(_people([(0.0, 0.4)]), walls=wall)[0] == pytest.approx([0.0, 0.0])


def test_a_pillar_pushes_by_each_agents_own_stiffness() -> None:
    people = _people([(1.0, 0.0), (-1.0, 0.0), (0.0, 3.0)])
    pillar = np.array([[0.0, 0.0, 0.8]])
    _push_apart(people, 0.33, np.array([1, 2, 0]), NO_WALLS, pillar, [10.0, 20.0, 30.0])
    assert people[:, s.PUSH_X] == pytest.approx([1.3, -2.6, 0.0])
    assert people[:, s.PUSH_Y] == pytest.approx([0.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("speed", "expected"), [(0.2, 16.0), (0.0, 10.0), (-0.2, 4.0), (-1.0, 0.0)]
)
def test_contact_that_closes_is_stiffer_and_never_pulls(speed: float, expected: float) -> None:
    people = _people([(0.0, 0.0), (0.5, 0.0)])
    people[0, s.VX] = speed
    _push_apart(people, 0.33, np.array([0, 1]), NO_WALLS, NO_DISCS, 62.5, 3.0)
    assert people[:, s.PUSH_X] == pytest.approx([-expected, expected])


@settings(deadline=None, max_examples=20)
@given(st.floats(0.2, 2.0), st.floats(0.2, 2.0), st.sampled_from([62.5, 125.0, 250.0]))
def test_people_with_dissipation_part_slowly(first: float, second: float, stiffness: float) -> None:
    """Two who meet head-on at any speed part at most at the inverse, and slower than they met."""
    people = _people([(0.0, 0.0), (0.67, 0.0)])
    people[:, s.VX] = first, -second
    for _ in range(2 * TICKS):
        _push_apart(people, 0.33, np.array([0, 1]), NO_WALLS, NO_DISCS, stiffness, 3.0)
        people[:, s.VX] += people[:, s.PUSH_X] * DT
        people[:, s.X] += people[:, s.VX] * DT
    parting = people[1, s.VX] - people[0, s.VX]
    assert 0.0 < parting < min(1.0 / 3.0, first + second) + 0.05
    assert np.sum(people[:, s.VX]) == pytest.approx(first - second)


def test_who_runs_into_a_wall_or_a_pillar_does_not_bounce_off() -> None:
    wall, pillar = np.array([[1.0, -5.0, 1.0, 5.0]]), np.array([[1.5, 0.0, 0.5]])
    for walls, discs in ((wall, NO_DISCS), (NO_WALLS, pillar)):
        people = _people([(0.66, 0.0)])
        people[:, s.VX] = 1.6
        for _ in range(2 * TICKS):
            _push_apart(people, 0.33, np.array([0]), walls, discs, 62.5, 3.0)
            people[:, s.VX] += people[:, s.PUSH_X] * DT
            people[:, s.X] += people[:, s.VX] * DT
        assert -1.0 / 3.0 - 0.02 < people[0, s.VX] < 0.0


def _robot(x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> Array:
    return np.array([[x, y, vx, vy, 0.178, 0.428]])


def test_impulses_balance_and_people_take_theirs() -> None:
    """A robot at rest, run over by a person: momentum lost by one is what the other got."""
    engine = unmoved((10.0, 0.1), 1.2)
    flat = engine.initial_state()
    felt, _ = s.contact_with(flat)
    before = rows(flat)[0, s.VX : s.VY + 1].copy()
    robot = _robot(10.6, 0.0)
    for _ in range(TICKS // 4):
        engine.advance(flat, robot)
        robot[0, 2:4] += np.array([felt[s.ROBOT_FX], felt[s.ROBOT_FY]]) * DT / 6.3
        robot[0, :2] += robot[0, 2:4] * DT
    (person,) = rows(flat)
    gained = 6.3 * robot[0, 2:4]
    lost = 75.0 * (before - person[s.VX : s.VY + 1])
    assert np.hypot(*gained) > 5.0
    assert gained == pytest.approx(lost, rel=1e-9)
    assert felt[s.ROBOT_JX : s.ROBOT_JY + 1] == pytest.approx(gained, rel=1e-12)
    assert felt[s.PEOPLE_JX : s.PEOPLE_JY + 1] == pytest.approx(-gained, rel=1e-12)


def _touch(engine: CrowdEngine, robot: Array, ticks: int) -> Array:
    flat = engine.initial_state()
    for _ in range(ticks):
        engine.advance(flat, robot)
    return flat


def test_the_book_of_one_contact() -> None:
    """An immovable robot and a person who walks into it and bounces off."""
    engine = unmoved((10.0, 0.0), 1.0)
    flat = engine.initial_state()
    x0, (vx, vy) = rows(flat)[0, s.X], rows(flat)[0, s.VX : s.VY + 1]
    reach = 0.33 + 0.178
    robot = _robot(x0 + 1.0 * vx + reach, 1.0 * vy)
    for _ in range(3 * TICKS):
        engine.advance(flat, robot)
    felt, (person,) = s.contact_with(flat)
    assert felt[s.CONTACTS] == person[s.TOUCHES] == 1.0
    assert person[s.TOUCHING] == 0.0
    assert person[s.TOUCH_START] == pytest.approx(1.0, abs=0.5 * DT)
    half_period = math.pi * math.sqrt(75.0 / 30000.0)
    assert person[s.TOUCH_END] - person[s.TOUCH_START] == pytest.approx(half_period, rel=0.15)
    assert person[s.TOUCH_SPEED] == pytest.approx(1.0, rel=1e-6)
    assert 75.0 < person[s.TOUCH_IMPULSE] < 150.0  # between no and full restitution
    assert person[s.TOUCH_PEAK] == pytest.approx(math.sqrt(75.0 * 30000.0), rel=0.2)


def test_one_contact_is_counted_once_while_bodies_stay_close() -> None:
    """Gaps below the release gap do not end a contact."""
    engine = unmoved((10.0, 0.0), 1e-9)
    flat = engine.initial_state()
    reach = 0.33 + 0.178
    for k in range(64):
        gap = -0.001 if k % 8 < 4 else 0.04
        rows(flat)[0, s.X : s.VY + 1] = (10.0, 0.0, 0.0, 0.0)
        engine.advance(flat, _robot(10.0 + reach + gap, 0.0))
    felt, touches = s.contact_with(flat)
    assert felt[s.CONTACTS] == 0.0
    assert touches[0, s.TOUCHING] == 1.0
    engine.advance(flat, _robot(12.0, 0.0))
    assert felt[s.CONTACTS] == 1.0


def test_forces_never_pull() -> None:
    engine = unmoved((10.0, 0.0), 1e-9)
    flat = engine.initial_state()
    rows(flat)[0, s.VX] = -6.0  # apart, fast enough to turn the damping over
    engine.advance(flat, _robot(10.5, 0.0))
    assert s.contact_with(flat)[0][s.ROBOT_FX] == 0.0


def test_coincident_centres_are_finite() -> None:
    engine = walkers(agents_of(np.array([[10.0, 0.0], [10.0, 0.0], [20.0, -5.0]])))
    flat = _touch(engine, _robot(10.0, 0.0), TICKS)
    assert np.all(np.isfinite(flat))
