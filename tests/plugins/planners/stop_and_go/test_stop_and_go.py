"""Stop and go: never touches what stands, waits, goes on."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugins.planners.stop_and_go.stop_and_go import STOP_AND_GO, StopAndGoSpec
from crowdbot.plugins.planners.stop_and_go.stop_and_go_build import (
    build,
    safe_speed,
    time_to_contact,
)
from tests.plugins.planners.world import LIMITS, PERSON, RADIUS, Outcome, World

SPEC = StopAndGoSpec(person_radius=PERSON)
STRAIGHT = StopAndGoSpec(most_aside=0.0, person_radius=PERSON)


def test_component() -> None:
    assert load_build(STOP_AND_GO) is build
    assert StopAndGoSpec.needs == ("lidar",)


def test_alone_it_is_goal_seek() -> None:
    out = World().run(build(SPEC))
    assert out.arrived
    assert max(abs(p.y) for p in out.path) == 0.0
    assert out.t < 66.5


def test_stands_before_a_standing_person() -> None:
    world = World([[20, 0.1, 0, 0]])
    out = world.run(build(STRAIGHT), time_limit=40.0)
    assert not out.contacts
    assert world.twist[0] == pytest.approx(0.0, abs=1e-3)
    # The nearest point of the person before the robot is PERSON before its centre line.
    assert SPEC.front_margin - 0.05 < out.least_gap < SPEC.front_margin + 0.03


@pytest.mark.slow
@settings(max_examples=15)
@given(st.floats(-0.6, 0.6), st.floats(0.1, 1.0))
def test_never_touches_what_stands(y: float, speed: float) -> None:
    spec = StopAndGoSpec(speed=speed, most_aside=0.0, person_radius=PERSON)
    out = World([[5, y, 0, 0]]).run(build(spec), time_limit=12.0, stop_at=7.0)
    assert not out.contacts
    assert out.arrived == (abs(y) > RADIUS + SPEC.side_margin + PERSON) or speed < 0.7


def test_steps_aside_where_there_is_room() -> None:
    """Somebody who does not look passes; who waits for him in the way is walked into."""
    aside, straight = (
        World([[8.0, 0.5, -1.0, 0.0]]).run(build(spec), time_limit=12.0, stop_at=6.0)
        for spec in (SPEC, STRAIGHT)
    )
    assert aside.arrived
    assert not aside.contacts
    assert max(abs(p.y) for p in aside.path) > 0.1
    assert straight.contacts
    assert aside.t < straight.t - 1.0


def test_waits_where_there_is_no_room_beside() -> None:
    row = [[5.0, y, 0, 0] for y in np.arange(-4.8, 4.9, 0.8)]
    world = World(row)
    out = world.run(build(SPEC), time_limit=20.0)
    assert not out.contacts
    assert world.pose.x < 5.0
    assert world.twist[0] == pytest.approx(0.0, abs=1e-3)


def test_brakes_smoothly() -> None:
    out = World([[10, 0, 0, 0]]).run(build(STRAIGHT), time_limit=20.0)
    assert commanded_jerks(out) <= LIMITS.a_max / 16 + 0.03


def commanded_jerks(out: Outcome) -> float:
    """Largest fall of the commanded speed from one step to the next, m/s."""
    v = np.array([c.v for c in out.commands])
    return float(np.max(v[:-1] - v[1:]))


def test_goes_on_when_the_way_is_free() -> None:
    """Somebody walks across, slowly, and does not look."""
    out = World([[8.0, -2.0, 0.0, 0.25]]).run(build(STRAIGHT), time_limit=40.0, stop_at=12.0)
    speed = np.diff([p.x for p in out.path]) * 128
    assert not out.contacts
    assert out.arrived
    assert speed[len(speed) // 4 :].min() == pytest.approx(0.0, abs=0.02)  # it did wait


def test_walls_beside_it_do_not_count() -> None:
    walls = np.array([[-1.0, -0.4, 20.0, -0.4], [-1.0, 0.4, 20.0, 0.4]])
    assert World(walls=walls).run(build(SPEC), time_limit=20.0, stop_at=10.0).arrived


def test_logs_its_room() -> None:
    out = World([[6, 0, 0, 0]]).run(build(SPEC), time_limit=1.0)
    assert out.logged["stop_and_go/room"][0] == pytest.approx(
        3.5 - PERSON - RADIUS - SPEC.front_margin, abs=0.02
    )


@given(st.floats(-5, 100), st.floats(0, 3), st.floats(0.1, 5), st.floats(0, 1))
def test_safe_speed_is_the_largest_that_stops_in_time(
    room: float, approach: float, a: float, lag: float
) -> None:
    v = safe_speed(np.array([room]), np.array([approach]), a, lag)[0]
    if room <= approach * lag:
        assert v == 0.0
    else:
        stands = lag + v / a
        assert v * lag + v * v / (2 * a) + approach * stands == pytest.approx(room, abs=1e-9)


def speed_at_contact(spec: StopAndGoSpec) -> float:
    """Of the robot, when somebody who does not look walks straight into it, m/s."""
    out = World([[12.0, 0.1, -1.3, 0.0]]).run(build(spec), time_limit=8.0)
    (time, _), *_ = out.contacts
    k = round(time * 128)
    return (out.path[k].x - out.path[k - 1].x) * 128


def test_stands_when_somebody_who_does_not_look_walks_into_it() -> None:
    assert speed_at_contact(STRAIGHT) < 0.05
    assert speed_at_contact(STRAIGHT.model_copy(update={"look_back": 0.0})) > 0.2


def test_gets_out_of_the_way_of_somebody_who_does_not_look() -> None:
    """He is seen early enough only with ``look_ahead``; the boxes are as short as its braking."""
    early, late = (
        World([[12.0, 0.1, -1.3, 0.0]]).run(build(spec), time_limit=12.0, stop_at=6.0)
        for spec in (SPEC, SPEC.model_copy(update={"look_ahead": 0.0}))
    )
    assert early.arrived
    assert not early.contacts
    assert early.t < late.t or late.contacts


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(-2, 2), st.floats(-2, 2), st.floats(-1.5, 1.5))
def test_time_to_contact_is_when_discs_first_touch(
    x: float, y: float, vx: float, vy: float, heading: float
) -> None:
    """Beside the same motions in small steps; what is behind, or inside and leaving, never is."""
    speed, radius = 0.65, 0.3
    at, going = np.array([[x, y]]), np.array([[vx, vy]])
    found = time_to_contact(at, going, speed, heading, radius)
    ahead = np.array([np.cos(heading), np.sin(heading)])
    t = np.linspace(0.0, 20.0, 20001)[:, np.newaxis]
    away = np.hypot(*(at + t * (going - speed * ahead)).T)
    if at @ ahead <= 0.0 or away.min() > radius + 1e-3:
        assert found == np.inf or found > 20.0
    elif away[0] > radius and away.min() < radius - 1e-3:
        assert found == pytest.approx(t[np.argmax(away <= radius), 0], abs=2e-3)
