"""Start times, waypoints, and what happens at the end of a route; trips as they are recorded."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import LOOP, PORTAL, REMOVE, STOP, Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.routes import reach_fraction
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.sim.crowd_only import run_crowd
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import ENTRANCE, OUT, TICKS, ToGoal, rows

RADIUS = 0.33
NO_PUSH = ToGoal()


class Trips:
    """Takes the place of a recording."""

    def __init__(self) -> None:
        self.trips: list[tuple[Any, ...]] = []
        self.x: list[Array] = []
        self.jumps: list[Array] = []

    def state(
        self, t: float, robot: None, agents: Array, jump: Array, *, goals: Array | None
    ) -> None:
        assert goals is not None
        assert t >= 0.0
        assert robot is None
        self.x.append(agents[0])
        self.jumps.append(jump)

    def trip(self, *row: Any) -> None:
        self.trips.append(row)

    def flush(self) -> None:
        pass


def _record(agents: Agents, seconds: float, world: CrowdWorld | None = None) -> Trips:
    trips = Trips()
    engine = CrowdEngine(agents, world or CrowdWorld(), NO_PUSH)
    run_crowd(engine, RunLog(cast(RecordingWriter, trips), agents.id), seconds, 16.0)
    return trips


@given(st.tuples(*[st.floats(-3, 3)] * 4), st.floats(0.05, 1.0))
def test_reach_fraction_is_the_first_moment_within_the_radius(
    ends: tuple[float, float, float, float], radius: float
) -> None:
    x0, y0, x1, y1 = ends
    found = reach_fraction(x0, y0, x1, y1, 0.0, 0.0, radius)
    share = np.linspace(0.0, 1.0, 2001)
    away = np.hypot(x0 + share * (x1 - x0), y0 + share * (y1 - y0))
    # A way that only grazes the circle enters it or does not, as numbers are rounded.
    surely, perhaps = (np.flatnonzero(away <= radius + off) for off in (-1e-9, 1e-9))
    if len(surely):
        assert found <= share[surely[0]] + 1e-9
    if len(perhaps):
        assert found >= share[perhaps[0]] - 1.0 / 2000.0 - 1e-9
    elif found <= 1.0:  # between two of the samples
        at = np.hypot(x0 + found * (x1 - x0), y0 + found * (y1 - y0))
        assert at == pytest.approx(radius, abs=1e-6)


def test_waypoints_are_trips_one_after_the_other() -> None:
    agents = Agents.of(x=0.0, y=0.0, preferred_speed=1.0, routes=[[(3.0, 0.0), (5.0, 0.0)]])
    found = _record(agents, 8.0)
    first, second = found.trips
    assert first == (0, 0.0, pytest.approx(3.0 - RADIUS, abs=1e-9), True)
    assert second[1] == first[2]
    assert second == (0, first[2], pytest.approx(5.0 - RADIUS, abs=1e-9), True)
    assert not np.any(found.jumps)
    assert found.x[-1][0] == pytest.approx(5.0 - RADIUS, abs=0.2)  # brakes at 5 m/s^2


def test_a_trip_that_is_not_finished_is_recorded_as_such() -> None:
    agents = Agents.of(x=0.0, y=0.0, preferred_speed=1.0, routes=[[(3.0, 0.0), (50.0, 0.0)]])
    assert _record(agents, 4.0).trips[1] == (0, pytest.approx(2.67), 4.0, False)


@pytest.mark.parametrize("start", [0.0, 0.5, 1.0, 2.0 + 1e-6, 3.999])
def test_agents_enter_at_their_start_time(start: float) -> None:
    """At the first tick that is not earlier; absent before, no trip before."""
    agents = Agents.of(x=0.0, y=0.0, preferred_speed=1.0, start_time=start, routes=[[(2.0, 0.0)]])
    found = _record(agents, 7.0)
    entered = np.ceil(start * TICKS) / TICKS
    ((_, t0, t1, reached),) = found.trips
    assert t0 == entered
    assert reached
    assert t1 - t0 == pytest.approx(2.0 - RADIUS, abs=1e-9)
    here = np.isfinite(np.array(found.x)[:, 0])
    assert list(here) == list(np.arange(len(here)) / 16.0 >= entered)
    assert not np.any(np.array(found.jumps)[1:])


def test_whoever_has_not_started_at_the_end_made_no_trip() -> None:
    agents = Agents.of(x=0.0, y=0.0, start_time=[9.0], routes=[[(2.0, 0.0)]])
    assert _record(agents, 3.0).trips == []


def test_late_starters_wait_while_their_place_is_taken() -> None:
    agents = Agents.of(
        x=[0.0, 0.2], y=0.0, preferred_speed=1.0, start_time=[0.0, 0.05],
        routes=[[(9.0, 0.0)], [(9.0, 3.0)]],
    )  # fmt: skip
    engine = CrowdEngine(agents, CrowdWorld(), NO_PUSH)
    flat = engine.initial_state()
    while rows(flat)[1, s.WAITING] != s.PRESENT:
        assert rows(flat)[1, s.WAITING] == s.NOT_YET
        engine.advance(flat)
        assert flat[s.TICK] < 3 * TICKS
    gap = np.hypot(*(rows(flat)[0, : s.Y + 1] - rows(flat)[1, : s.Y + 1]))
    assert gap >= 2.0 * RADIUS
    assert rows(flat)[1, s.TRIP_START] == flat[s.TICK] / TICKS
    assert rows(flat)[1, s.TRIP_START] == pytest.approx(0.2 + 2.0 * RADIUS, abs=2.0 / TICKS)


def test_a_robot_on_the_place_is_waited_for() -> None:
    agents = Agents.of(x=0.0, y=0.0, start_time=0.1, routes=[[(9.0, 0.0)]])
    engine = CrowdEngine(agents, CrowdWorld(), NO_PUSH)
    flat, robot = engine.initial_state(), np.array([[0.5, 0.0, 0.0, 0.0, 0.178, 0.428]])
    for _ in range(TICKS):
        engine.advance(flat, robot)
    assert rows(flat)[0, s.WAITING] == s.NOT_YET
    engine.advance(flat)
    assert rows(flat)[0, s.WAITING] == s.PRESENT


def test_two_who_want_the_same_place_enter_in_the_order_of_ids() -> None:
    entered = []
    for ids in ([4, 2], [2, 4]):
        agents = Agents.of(
            id=ids, x=0.0 * np.ones(2), y=0.0, start_time=0.5, preferred_speed=1.0,
            routes=[[(9.0, 0.0)]] * 2,
        )  # fmt: skip
        engine = CrowdEngine(agents, CrowdWorld(), NO_PUSH)
        flat = engine.initial_state()
        while not np.any(rows(flat)[:, s.WAITING] == s.PRESENT):
            engine.advance(flat)
        entered.append(agents.id[rows(flat)[:, s.WAITING] == s.PRESENT].tolist())
    assert entered == [[2], [2]]


def test_removed_agents_are_gone_for_good() -> None:
    agents = Agents.of(
        x=[0.0, 0.0], y=[0.0, 5.0], preferred_speed=1.0, at_goal=[REMOVE, STOP],
        routes=[[(1.0, 0.0)], [(1.0, 5.0)]],
    )  # fmt: skip
    found = _record(agents, 3.0)
    assert [t[3] for t in found.trips] == [True, True]
    here = np.isfinite(np.array(found.x))
    assert not np.any(here[-1, 0])
    assert np.all(here[:, 1])
    assert np.all(np.diff(here[:, 0].astype(int)) <= 0)


def test_loops_go_on_for_ever() -> None:
    agents = Agents.of(
        x=0.0, y=0.0, preferred_speed=1.0, at_goal=LOOP, routes=[[(2.0, 0.0), (0.0, 0.0)]]
    )
    trips = _record(agents, 30.0).trips
    assert len(trips) > 12
    assert [t[3] for t in trips] == [True] * (len(trips) - 1) + [False]
    assert [a[2] for a in trips[:-1]] == [b[1] for b in trips[1:]]


@pytest.mark.parametrize("end", [STOP, LOOP, REMOVE])
@pytest.mark.parametrize("route", [[], [(0.0, 0.0)], [(0.1, 0.0)], [(0.0, 0.0)] * 3])
def test_a_goal_at_the_own_position(end: int, route: list[tuple[float, float]]) -> None:
    """A finite number of trips of no length, then rest."""
    agents = Agents.of(x=0.0, y=0.0, at_goal=end, routes=[route])
    trips = _record(agents, 2.0).trips
    assert len(trips) == len(route)
    assert all(t1 - t0 <= 3.0 / TICKS and reached for _, t0, t1, reached in trips)


def test_agents_who_are_pushed_off_their_goal_come_back() -> None:
    agents = Agents.of(x=0.0, y=0.0, preferred_speed=1.0, routes=[[(2.0, 0.0)]])
    engine = CrowdEngine(agents, CrowdWorld(), NO_PUSH)
    flat = engine.initial_state()
    for tick in range(8 * TICKS):
        if tick == 4 * TICKS:
            rows(flat)[0, s.Y] = 1.5
        engine.advance(flat)
    assert np.hypot(*(rows(flat)[0, : s.Y + 1] - [2.0, 0.0])) <= RADIUS + 0.01
    assert flat[s.TRIPS] == 1.0


def test_several_pairs_of_portals() -> None:
    """Two streams, against each other, each with portals of its own."""
    world = CrowdWorld(
        entrance=np.array([[-1.0, 0, -5, 0], [50, 51, 0, 5]]),
        out=np.array([[50.0, 51, -5, 0], [-1, 0, 0, 5]]),
    )
    agents = Agents.of(
        x=[48.0, 2.0, 47.0, 3.0], y=[-2.0, 2.0, -4.0, 4.0], preferred_speed=1.5,
        flow=[0, 1, 0, 1], at_goal=PORTAL,
    )  # fmt: skip
    engine = CrowdEngine(agents, world, NO_PUSH)
    flat = engine.initial_state()
    assert np.all(np.sign(rows(flat)[:, s.VX]) == [1, -1, 1, -1])
    for _ in range(6 * TICKS):
        engine.advance(flat)
    people = rows(flat)
    assert list(people[:, s.ARRIVALS]) == [1.0] * 4
    assert np.all(people[[0, 2], s.X] < 7.0)
    assert np.all(people[[1, 3], s.X] > 43.0)
    assert np.all(people[[0, 2], s.GOAL_Y] < 0.0)
    assert np.all(people[[1, 3], s.GOAL_Y] > 0.0)


@pytest.mark.parametrize("y", [-4.9, -2.0, 0.0, 3.7])
def test_kept_offset(y: float) -> None:
    """In at the same offset as out, as far as the body fits into the portal."""
    world = CrowdWorld(entrance=ENTRANCE, out=OUT, exit_point="offset")
    engine = CrowdEngine(Agents.of(x=49.99, y=y, preferred_speed=1.0), world, Straight())
    flat = engine.initial_state()
    rows(flat)[0, s.VX : s.VY + 1] = 1.0, 0.0
    while flat[s.TRIPS] < 1.0:
        engine.advance(flat)
    (person,) = rows(flat)
    assert person[s.Y] == pytest.approx(np.clip(y, -5.0 + RADIUS, 5.0 - RADIUS), abs=1e-6)
    assert person[s.X] == pytest.approx(ENTRANCE[0] + RADIUS, abs=0.02)
    assert person[s.JUMPS] == 1.0


@pytest.mark.parametrize("y", [-4.9, -2.0, 0.0, 3.7])
def test_a_goal_straight_ahead(y: float) -> None:
    """Of where the trip starts, at first and after each way through the portals."""
    world = CrowdWorld(entrance=ENTRANCE, out=OUT, goal_point="ahead")
    engine = CrowdEngine(Agents.of(x=49.0, y=y, preferred_speed=1.0), world, Straight())
    flat = engine.initial_state()
    (person,) = rows(flat)
    assert person[s.GOAL_Y] == pytest.approx(np.clip(y, -5.0 + RADIUS, 5.0 - RADIUS), abs=1e-9)
    assert OUT[0] <= person[s.GOAL_X] <= OUT[1]
    while flat[s.TRIPS] < 1.0 or rows(flat)[0, s.WAITING] != s.PRESENT:
        engine.advance(flat)
    (person,) = rows(flat)
    assert person[s.GOAL_Y] == pytest.approx(person[s.Y], abs=1e-9)
    assert abs(person[s.Y] - y) > 0.05  # it came in somewhere else


class Straight:
    contact_stiffness = 0.0

    def accelerations(self, view: Any) -> Array:
        return np.zeros_like(view.position)


def test_what_makes_no_sense_is_refused() -> None:
    walker = Agents.of(x=0.0, y=0.0, routes=[[(1.0, 0.0)]])
    with pytest.raises(ValueError, match="portals"):
        CrowdEngine(Agents.of(x=0.0, y=0.0), CrowdWorld(), NO_PUSH)
    with pytest.raises(ValueError, match="flow 1"):
        CrowdEngine(
            Agents.of(x=0.0, y=0.0, flow=1), CrowdWorld(entrance=ENTRANCE, out=OUT), NO_PUSH
        )
    with pytest.raises(ValueError, match="policy 2 of 1"):
        CrowdEngine(Agents.of(x=0.0, y=0.0, policy=2, routes=[[]]), CrowdWorld(), NO_PUSH)
    with pytest.raises(ValueError, match="periodic_boundary"):
        CrowdWorld(periodic_boundary=(1.0, 0.0, 0.0, 1.0))
    with pytest.raises(ValueError, match="1 entrances for 0 exits"):
        CrowdWorld(entrance=ENTRANCE)
    with pytest.raises(ValueError, match="walls must have 4 columns"):
        CrowdWorld(walls=np.array([[0.0, 1.0, 2.0]]))
    with pytest.raises(ValueError, match="2 routes for 1 agents"):
        Agents.of(x=0.0, y=0.0, routes=[[], []])
    for columns in ({"x": np.nan}, {"radius": 0.0}, {"preferred_speed": -1.0}, {"at_goal": 7}):
        with pytest.raises(ValueError, match=next(iter(columns))):
            Agents.of(**{"x": 0.0, "y": 0.0, "routes": [[]], **columns})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="id of its own"):
        Agents.of(id=[3, 3], x=[0.0, 1.0], y=0.0)
    assert len(walker) == 1


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=15)
def test_every_trip_begins_when_the_last_one_ended(seed: int) -> None:
    """Random routes and start times: trips of an agent are a chain within its presence."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 12))
    routes = [
        [(float(x), float(y)) for x, y in rng.uniform(-4, 4, (rng.integers(1, 4), 2))]
        for _ in range(n)
    ]
    agents = Agents.of(
        x=rng.uniform(-4, 4, n), y=rng.uniform(-4, 4, n), preferred_speed=rng.uniform(0.3, 2.0, n),
        start_time=np.maximum(0.0, rng.uniform(-2.0, 4.0, n)), routes=routes,
        at_goal=rng.integers(STOP, LOOP + 1, n), id=rng.permutation(n) + 5,
    )  # fmt: skip
    found = _record(agents, 12.0)
    for i in range(n):
        mine = [t for t in found.trips if t[0] == agents.id[i]]
        for (_, _, end, reached), (_, start, _, _) in pairwise(mine):
            assert reached
            assert start == end
        assert all(0.0 <= t0 <= t1 <= 12.0 for _, t0, t1, _ in mine)
        if mine:
            assert mine[0][1] >= agents.start_time[i]
        if agents.at_goal[i] != LOOP:
            assert len(mine) <= len(routes[i])
