"""Ways of streams in the engine: areas, returning, walking on, queues, stays, arrivals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import ONWARD, REMOVE, RETURN, STOP
from crowdbot.core.crowd.goal_areas import (
    PLACE,
    PlaceRecord,
    area_fraction,
    into_area,
    point_in_area,
)
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.support.records import rows_of
from crowdbot.core.types.arrays import Array

AREA = (2.0, 4.0, 0.0)
_SIDES = st.tuples(st.floats(0.1, 5.0), st.floats(0.1, 5.0), st.floats(-3.0, 3.0))
_UNIT = st.floats(0.0, 1.0, exclude_max=True)


class Straight:
    """Everybody walks straight to the goal."""

    contact_stiffness = 0.0

    def velocities(self, view: CrowdView, dt: float) -> Array:  # noqa: ARG002
        to = view.goal - view.position
        distance = np.hypot(to[:, :1], to[:, 1:])
        arrived = distance < view.agents.radius[:, np.newaxis]
        pace = view.agents.preferred_speed[:, np.newaxis]
        return np.where(arrived, 0.0, pace * to / np.maximum(distance, 1e-9))


def engine(world: CrowdWorld | None = None, **given: Any) -> CrowdEngine:
    given = {"preferred_speed": 1.0, "radius": 0.2} | given
    return CrowdEngine(Agents.of(**given), world or CrowdWorld(), Straight())


def states(crowd: CrowdEngine, seconds: float) -> list[Array]:
    flat = crowd.initial_state()
    found = []
    for _ in range(round(seconds * 128)):
        crowd.advance(flat)
        found.append(s.view(flat)[1].copy())
    return found


def _area(width: float, height: float, turn: float) -> PlaceRecord:
    places = rows_of(1, PLACE)
    places["width"][:], places["height"][:], places["turn"][:] = width, height, turn
    return places[0]


@given(_SIDES, _UNIT, _UNIT, st.floats(0.0, 1.0))
def test_points_of_an_area_lie_in_it(
    sides: tuple[float, float, float], u: float, v: float, margin: float
) -> None:
    size = _area(*sides)
    x, y = point_in_area(3.0, -1.0, size, margin, u, v)
    assert into_area(x, y, 3.0, -1.0, size, margin) == pytest.approx((x, y))
    c, n = math.cos(sides[2]), math.sin(sides[2])
    a, b = c * (x - 3.0) + n * (y + 1.0), c * (y + 1.0) - n * (x - 3.0)
    assert abs(a) <= max(0.0, 0.5 * sides[0] - margin) + 1e-9
    assert abs(b) <= max(0.0, 0.5 * sides[1] - margin) + 1e-9


@given(_SIDES, st.floats(-6.0, 6.0), st.floats(-6.0, 6.0), st.floats(-6.0, 6.0))
@settings(max_examples=60)
def test_where_an_area_is_entered(
    sides: tuple[float, float, float], x0: float, y0: float, x1: float
) -> None:
    size, far = _area(*sides), 1e-6
    fraction = area_fraction(x0, y0, x1, 0.0, 0.0, 0.0, size)
    inside = [
        math.dist(into_area(x, y, 0.0, 0.0, size, 0.0), (x, y)) < far
        for k in np.linspace(0.0, 1.0, 200)
        for x, y in [(x0 + k * (x1 - x0), y0 - k * y0)]
    ]
    assert any(inside) <= (fraction <= 1.0)
    if fraction <= 1.0:
        at = x0 + fraction * (x1 - x0), y0 - fraction * y0
        assert math.dist(into_area(*at, 0.0, 0.0, size, 0.0), at) < far


def test_an_area_is_reached_where_it_is_entered() -> None:
    crowd = engine(x=[0.0], y=[0.0], routes=[[(6.0, 0.0)]], goal_areas=[[AREA]])
    rows = states(crowd, 7.0)[-1]
    assert rows[0, s.ARRIVED] == pytest.approx(5.0 / 1.0, abs=0.5)
    assert rows[0, s.ARRIVALS] == 1.0
    assert 5.0 < rows[0, s.X] < 7.2


def test_people_of_one_area_do_not_share_a_point() -> None:
    crowd = engine(
        x=[0.0] * 4, y=[0.0, 1.0, 2.0, 3.0], routes=[[(6.0, 0.0)]] * 4, goal_areas=[[AREA]] * 4
    )
    _, rows = s.view(crowd.initial_state())
    goals = rows[:, s.GOAL_X : s.GOAL_Y + 1]
    assert len(np.unique(goals, axis=0)) == 4


def test_a_group_goes_to_one_place_side_by_side() -> None:
    crowd = engine(
        x=[0.0] * 3, y=[0.0, 0.7, 9.0], routes=[[(60.0, 0.0)]] * 3,
        goal_areas=[[(8.0, 40.0, 0.0)]] * 3, group=[5, 5, -1],
    )  # fmt: skip
    _, rows = s.view(crowd.initial_state())
    goals = rows[:, s.GOAL_X : s.GOAL_Y + 1]
    assert 0.3 < math.dist(goals[0], goals[1]) < 0.9
    assert math.dist(goals[0], goals[2]) > 1.0


def test_who_returns_comes_in_at_the_origin_again() -> None:
    crowd = engine(
        x=[0.0], y=[0.0], routes=[[(3.0, 0.0)]], goal_areas=[[AREA]], at_goal=[RETURN],
        origins=[(-2.0, 0.0, 1.0, 2.0, 0.3)],
    )  # fmt: skip
    rows = states(crowd, 10.0)
    jumps = [i for i in range(1, len(rows)) if rows[i][0, s.JUMPS] > rows[i - 1][0, s.JUMPS]]
    assert len(jumps) >= 2
    size = _area(1.0, 2.0, 0.3)
    for i in jumps:
        at = rows[i][0, s.X], rows[i][0, s.Y]
        assert math.dist(into_area(*at, -2.0, 0.0, size, 0.0), at) < 0.02
    assert rows[-1][0, s.TRIP] == len(jumps)


def test_onward_never_ends_on_a_torus() -> None:
    world = CrowdWorld(periodic_boundary=(0.0, 5.0, 0.0, 5.0))
    crowd = engine(world, x=[1.0], y=[1.0], routes=[[(1.0, 1.0), (4.0, 1.3)]], at_goal=[ONWARD])
    rows = states(crowd, 20.0)
    angle = math.atan2(0.3, 3.0)
    ways = np.array([[r[0, s.VX], r[0, s.VY]] for r in rows])
    assert np.allclose(ways, [math.cos(angle), math.sin(angle)], atol=0.05)
    assert rows[-1][0, s.ARRIVALS] in (6.0, 7.0)
    assert 0.0 <= rows[-1][0, s.X] <= 5.0


def test_who_pauses_goes_on_afterwards() -> None:
    crowd = engine(
        x=[0.0], y=[0.0], routes=[[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)]], pauses=[[2.0, 1.0, 0.0]]
    )
    rows = states(crowd, 12.0)
    starts = [r[0, s.TRIP_START] for r in rows if r[0, s.ON_TRIP]]
    assert rows[0][0, s.ON_TRIP] == 0.0
    assert min(starts) == pytest.approx(2.0, abs=0.05)
    assert rows[-1][0, s.ARRIVALS] == 2.0
    still = [r for r in rows if r[0, s.ROUTE_POINT] == 1.0 and r[0, s.ON_TRIP] == 0.0]
    assert len(still) / 128 == pytest.approx(1.0, abs=0.05)


def test_a_queue_is_served_one_after_the_other() -> None:
    spots = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
    crowd = engine(
        x=[0.0, 1.0, 2.0], y=[0.0] * 3, at_goal=[REMOVE] * 3,
        routes=[[*spots[i::-1], (0.0, 5.0)] for i in range(3)],
        pauses=[[*([0.0] * i), 2.0, 0.0] for i in range(3)], ahead=[-1, 0, 1],
    )  # fmt: skip
    rows = states(crowd, 25.0)
    for before in rows:  # nobody passes anybody, and two are never at the counter
        left = np.array([2.0, 3.0, 4.0]) - before[:, s.ROUTE_POINT]
        assert np.all(np.diff(left) >= 0.0)
        at_counter = (np.hypot(before[:, s.X], before[:, s.Y]) < 0.3) & (before[:, s.WAITING] == 0)
        assert at_counter.sum() <= 1
    gone = [next(i for i, r in enumerate(rows) if r[k, s.WAITING] == s.GONE) for k in range(3)]
    assert np.all(np.diff(gone) > 2.0 * 128)


def test_who_finds_the_place_taken_enters_elsewhere_in_the_origin() -> None:
    crowd = engine(
        x=[0.0, 0.0], y=[0.0, 0.0], routes=[[(0.0, 0.0)], [(9.0, 0.0)]], at_goal=[STOP, STOP],
        start_time=[0.0, 1.0], origins=[(), (0.0, 0.0, 4.0, 4.0, 0.0)],
    )  # fmt: skip
    rows = states(crowd, 3.0)
    entered = next(r for r in rows if r[1, s.WAITING] == s.PRESENT)
    assert entered[1, s.TRIP_START] == pytest.approx(1.0, abs=0.2)
    assert math.hypot(entered[1, s.X], entered[1, s.Y]) >= 0.4


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"at_goal": [RETURN]}, "RETURN needs"),
        ({"at_goal": [ONWARD]}, "two points"),
        ({"pauses": [[1.0, 1.0]]}, "2 entries"),
        ({"ahead": [0]}, "earlier row"),
        ({"goal_areas": [[(-1.0, 1.0, 0.0)]]}, "negative"),
    ],
)
def test_ways_that_make_no_sense_are_refused(given: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        Agents.of(x=[0.0], y=[0.0], routes=[[(1.0, 0.0)]], **given)
