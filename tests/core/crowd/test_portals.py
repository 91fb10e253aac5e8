"""Leaving through one portal, coming back through the other."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.portals import CLEAR_OF_ROBOT, entry_fraction
from tests.core.crowd.crowd_worlds import ENTRANCE, OUT, TICKS, rows, straight

RADIUS = 0.33


@pytest.mark.parametrize(
    ("x0", "x1", "expected"),
    [(49.0, 51.0, 0.5), (49.9, 50.1, 0.5), (49.75, 50.0, 1.0), (50.2, 50.4, 0.0), (49.0, 49.9, 2)],
)
def test_entry_fraction(x0: float, x1: float, expected: float) -> None:
    assert entry_fraction(OUT, x0, 0.0, x1, 0.0) == pytest.approx(expected)


def test_entry_fraction_beside_and_through() -> None:
    assert entry_fraction(OUT, 49.0, 6.0, 51.0, 6.0) > 1.0
    assert entry_fraction(OUT, 49.0, 0.0, 53.0, 0.0) == pytest.approx(0.25)
    assert entry_fraction(OUT, 49.0, 5.5, 51.0, 4.5) == pytest.approx(0.5)
    assert entry_fraction(OUT, 50.5, 0.0, 50.5, 0.0) == 0.0


def test_arrival_time_is_interpolated() -> None:
    """49.9 m on a straight line at 1.3 m/s, whatever the tick."""
    engine = straight(np.array([[40.0, 0.3], [44.0, -2.0]]), 1.3)
    flat = engine.initial_state()
    expected = (50.0 - rows(flat)[:, s.X]) / rows(flat)[:, s.VX]
    while flat[s.TRIPS] < 2:
        engine.advance(flat)
    people = rows(flat)
    assert people[:, s.ARRIVED] == pytest.approx(expected, abs=1e-9)
    assert np.all(people[:, s.TRIP_START] >= people[:, s.ARRIVED])
    assert np.all(people[:, s.TRIP_START] - people[:, s.ARRIVED] <= 1.0 / TICKS + 1e-12)
    assert list(people[:, s.TRIP]) == [1.0, 1.0]


def test_re_entry_starts_a_new_trip() -> None:
    engine = straight(np.array([[49.9, 0.0]]), 1.2)
    flat = engine.initial_state()
    goal = rows(flat)[0, s.GOAL_X : s.GOAL_Y + 1].copy()
    while flat[s.TRIPS] < 1:
        engine.advance(flat)
    (person,) = rows(flat)
    assert ENTRANCE[0] + RADIUS <= person[s.X] <= ENTRANCE[1] - RADIUS
    assert ENTRANCE[2] + RADIUS <= person[s.Y] <= ENTRANCE[3] - RADIUS
    new = person[s.GOAL_X : s.GOAL_Y + 1]
    assert not np.allclose(new, goal)
    assert OUT[0] + RADIUS <= new[0] <= OUT[1] - RADIUS
    assert OUT[2] + RADIUS <= new[1] <= OUT[3] - RADIUS
    velocity = person[s.VX : s.VY + 1]
    assert np.hypot(*velocity) == pytest.approx(1.2)
    assert np.cross([*velocity, 0.0], [*(new - person[: s.Y + 1]), 0.0])[2] == pytest.approx(0.0)


def _crowd_at_the_exit(count: int, seed: int) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(46.0, 49.9, count), rng.uniform(-4.6, 4.6, count)])


@pytest.mark.parametrize("robot", [None, (-0.5, 0.0), (0.6, 2.0)])
def test_nobody_is_lost_and_nobody_enters_on_somebody(robot: tuple[float, float] | None) -> None:
    engine = straight(_crowd_at_the_exit(60, 1))
    robots = np.zeros((0, 6)) if robot is None else np.array([[*robot, 0, 0, 0.178, 0.428]])
    flat = engine.initial_state()
    waited = 0
    for _ in range(9 * TICKS):
        trips = rows(flat)[:, s.TRIP].copy()
        engine.advance(flat, robots)
        people = rows(flat)
        assert len(people) == 60
        present = people[:, s.WAITING] == 0.0
        waited += int(np.sum(~present))
        for i in np.flatnonzero(people[:, s.TRIP] != trips):
            others = present & (np.arange(60) != i)
            gap = np.hypot(*(people[others, : s.Y + 1] - people[i, : s.Y + 1]).T)
            assert np.min(gap, initial=9.0) >= 2.0 * RADIUS
            for r in robots:
                assert np.hypot(*(people[i, : s.Y + 1] - r[:2])) >= CLEAR_OF_ROBOT
    assert np.all(np.isfinite(flat))
    assert flat[s.TRIPS] >= 60
    assert waited > 0  # sixty people at once do not find room in one tick


def test_a_blocked_entrance_makes_people_wait() -> None:
    """Robots all over the in-portal: whoever leaves stays outside and enters when they go."""
    engine = straight(np.array([[49.9, 0.0], [49.9, 2.0], [20.0, 0.0]]))
    blocked = np.array([[-0.5, y, 0.0, 0.0, 0.178, 0.428] for y in np.arange(-5.0, 5.1, 0.5)])
    flat = engine.initial_state(robots=21)
    for _ in range(TICKS):
        engine.advance(flat, blocked)
    people = rows(flat)
    assert list(people[:, s.WAITING]) == [1.0, 1.0, 0.0]
    assert list(people[:, s.TRIP]) == [0.0, 0.0, 0.0]
    frozen = people[:2, s.X : s.VY + 1].copy()
    assert np.all(people[:2, s.ATTEMPT] > 40)
    engine.advance(flat, blocked)
    assert np.array_equal(rows(flat)[:2, s.X : s.VY + 1], frozen)
    engine.advance(flat)
    assert list(rows(flat)[:, s.WAITING]) == [0.0, 0.0, 0.0]
    assert list(rows(flat)[:, s.TRIP]) == [1.0, 1.0, 0.0]
    assert list(rows(flat)[:, s.ATTEMPT][:2]) != [0.0, 0.0]


def test_people_outside_touch_nobody_and_are_not_seen() -> None:
    engine = straight(np.array([[49.9, 0.0], [40.0, 0.0]]), 1.2)
    flat = engine.initial_state(robots=22)
    blocked = np.array([[-0.5, y, 0.0, 0.0, 0.178, 0.428] for y in np.arange(-5.0, 5.1, 0.5)])
    for _ in range(TICKS):
        engine.advance(flat, blocked)
    gone = rows(flat)[0, : s.Y + 1].copy()
    on_top = np.concatenate([blocked, [[*gone, 0.0, 0.0, 0.178, 0.428]]])
    for _ in range(16):
        engine.advance(flat, on_top)
    for robot in range(22):
        felt, touches = s.contact_with(flat, robot)
        assert touches[0, s.TOUCHING] == touches[0, s.TOUCHES] == 0.0
        assert not np.any(felt[s.ROBOT_JX : s.PEOPLE_JY + 1])
