"""Steering parts, by hand-computed cases and by what holds for all of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld, policy_of
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.steering.parts import SteeringParts
from crowdbot.core.crowd.steering.wander import E_FOLD, no_draws, wandering
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.steering import (
    LanesSpec,
    PersonalSpaceSpec,
    SteeringSpec,
    TimeGapSpec,
    WallPushSpec,
    WanderSpec,
)
from tests.examples import costly

FULL = Steering(
    SteeringSpec(
        time_gap=TimeGapSpec(),
        personal_space=PersonalSpaceSpec(),
        lanes=LanesSpec(),
        wall_push=WallPushSpec(),
        wander=WanderSpec(),
    )
)


class Straight:
    """Everybody keeps on at preferred speed towards the goal."""

    relaxation_time = 0.5

    def accelerations(self, view: CrowdView) -> Array:
        way = view.goal - view.position
        way = way / np.hypot(way[:, :1], way[:, 1:])
        wanted = view.agents.preferred_speed[:, np.newaxis] * way
        return np.asarray((wanted - view.velocity) / self.relaxation_time)


def seen(
    at: list[tuple[float, float]],
    velocity: list[tuple[float, float]],
    walls: Array | None = None,
    pillars: Array | None = None,
    avoided: float | None = None,
    time: float = 0.0,
) -> CrowdView:
    """People who want to go along x at 1.4 m/s."""
    agents = Agents.of(
        x=[p[0] for p in at],
        y=[p[1] for p in at],
        radius=0.2,
        avoided_radius=avoided,
        routes=[[(p[0] + 1000.0, p[1])] for p in at],
    )
    return CrowdView(
        agents=agents,
        position=np.array(at),
        velocity=np.array(velocity),
        goal=np.array([(p[0] + 1000.0, p[1]) for p in at]),
        present=np.ones(len(at), np.bool_),
        robot=np.zeros((0, 5)),
        walls=np.zeros((0, 4)) if walls is None else walls,
        dt=1.0 / 16.0,
        t=time,
        pillars=np.zeros((0, 3)) if pillars is None else pillars,
    )


def steered(steering: Steering, view: CrowdView, wanted: Array | None = None) -> Array:
    given_ = np.zeros_like(view.position) if wanted is None else wanted
    return SteeringParts(steering).steer(view, 0.5, given_)


@pytest.mark.parametrize(("ahead", "allowed"), [(0.9, 0.63), (1.27, 1.0), (0.27, 0.0), (0.1, 0.0)])
def test_time_gap_is_distance_ahead_less_room_over_time(ahead: float, allowed: float) -> None:
    view = seen([(0.0, 0.0), (ahead, 0.0)], [(1.4, 0.0), (1.4, 0.0)])
    found = steered(Steering(SteeringSpec(time_gap=TimeGapSpec())), view)
    assert found[0, 0] == pytest.approx(max((allowed - 1.4) / 0.5, -5.0))
    assert found[1].tolist() == [0.0, 0.0]  # nobody is ahead of the second


@pytest.mark.parametrize("side", [0.281, -0.281])
def test_time_gap_leaves_out_who_is_beside(side: float) -> None:
    view = seen([(0.0, 0.0), (0.6, side)], [(1.4, 0.0), (1.4, 0.0)])
    assert steered(Steering(SteeringSpec(time_gap=TimeGapSpec())), view)[0].tolist() == [0.0, 0.0]


def test_time_gap_is_nearly_off_towards_who_comes() -> None:
    view = seen([(0.0, 0.0), (0.6, 0.0)], [(1.4, 0.0), (-1.4, 0.0)])
    assert steered(Steering(SteeringSpec(time_gap=TimeGapSpec())), view)[0].tolist() == [0.0, 0.0]
    both = Steering(SteeringSpec(time_gap=TimeGapSpec(oncoming_time=1.0)))
    assert steered(both, view)[0, 0] == pytest.approx((0.33 - 1.4) / 0.5)


def test_time_gap_counts_pillars_and_leaves_who_steps_back() -> None:
    view = seen([(0.0, 0.0)], [(1.0, 0.0)], pillars=np.array([[0.77, 0.0, 0.1]]))
    part = Steering(SteeringSpec(time_gap=TimeGapSpec()))
    assert steered(part, view)[0, 0] == pytest.approx((0.5 - 1.0) / 0.5)
    back = np.array([[-4.0, 0.0]])  # to -1 m/s
    assert steered(part, view, back).tolist() == back.tolist()


def test_personal_space_by_hand() -> None:
    part = PersonalSpaceSpec(strength=1.0, reach=0.4, anticipation=0.5, behind=0.5)
    view = seen([(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (0.5, 0.0)])
    found = steered(Steering(SteeringSpec(personal_space=part)), view)
    # In half a second they are 0.75 m apart, discs 0.35 m; ahead of the first, behind the second.
    full = math.exp(-0.35 / 0.4)
    assert found[0] == pytest.approx([-full, 0.0])
    assert found[1] == pytest.approx([0.5 * full, 0.0])


def test_personal_space_never_looks_through_somebody() -> None:
    part = Steering(SteeringSpec(personal_space=PersonalSpaceSpec(strength=1.0)))
    view = seen([(0.0, 0.0), (0.5, 0.0)], [(2.0, 0.0), (-2.0, 0.0)])
    found = steered(part, view)
    assert found[0, 0] < 0.0 < found[1, 0]


COMES, GOES = (-1.0, 0.0), (1.0, 0.0)


def aside(part: LanesSpec, *others: tuple[tuple[float, float], tuple[float, float]]) -> float:
    """Acceleration to the left, m/s^2, of who walks along x from the origin."""
    at, v = zip(((0.0, 0.0), GOES), *others, strict=True)
    return float(steered(Steering(SteeringSpec(lanes=part)), seen(list(at), list(v)))[0, 1])


def test_lanes_by_hand() -> None:
    part = LanesSpec(strength=1.0, reach=2.0, half_width=0.6, follow=0.5)
    near, far = math.exp(-0.5), math.exp(-1.0)
    # Away from who comes, 0.15 m to the left.
    away = -0.75 * near
    assert aside(part, ((1.0, 0.15), COMES)) == pytest.approx(math.tanh(away))
    # Towards who goes ahead, 0.3 m to the right, by the share of those who come.
    towards = -0.5 * far * near / (near + far)
    found = aside(part, ((1.0, 0.15), COMES), ((2.0, -0.3), GOES))
    assert found == pytest.approx(math.tanh(away + towards))


def test_lanes_need_people_who_come() -> None:
    part = LanesSpec(strength=1.0)
    assert aside(part, ((1.0, 0.3), GOES), ((2.0, -0.1), (0.0, 0.0))) == 0.0
    assert aside(part, ((1.0, 0.61), COMES)) == 0.0  # beside
    assert aside(part, ((-1.0, 0.1), COMES)) == 0.0  # behind


@given(st.floats(0.1, 2.9), st.floats(0.01, 0.59), st.floats(0.1, 2.0))
def test_lanes_are_the_same_left_and_right(along: float, side: float, speed: float) -> None:
    part = LanesSpec()
    left = aside(part, ((along, side), (-speed, 0.0)), ((1.0, -side), GOES))
    right = aside(part, ((along, -side), (-speed, 0.0)), ((1.0, side), GOES))
    assert left == pytest.approx(-right, abs=1e-12)
    assert abs(left) <= part.strength


def test_wall_push_falls_off_with_the_gap() -> None:
    walls = np.array([[-5.0, 0.0, 5.0, 0.0]])
    part = Steering(SteeringSpec(wall_push=WallPushSpec(strength=2.0, reach=0.1)))
    view = seen([(0.0, 0.3), (0.0, -0.3), (0.0, 2.0)], [(0.0, 0.0)] * 3, walls)
    found = steered(part, view)
    assert found[0] == pytest.approx([0.0, 2.0 * math.exp(-1.0)])
    assert found[1] == pytest.approx([0.0, -2.0 * math.exp(-1.0)])
    assert found[2].tolist() == [0.0, 0.0]


def test_avoided_radius_is_what_parts_keep_clear_of() -> None:
    walls = np.array([[-5.0, 0.0, 5.0, 0.0]])
    part = Steering(SteeringSpec(wall_push=WallPushSpec(strength=2.0, reach=0.1)))
    found = steered(part, seen([(0.0, 0.35)], [(0.0, 0.0)], walls, avoided=0.25))
    assert found[0, 1] == pytest.approx(2.0 * math.exp(-1.0))


def test_wander_has_its_deviation_and_its_time() -> None:
    knots = np.arange(0.0, 60.0, 0.05)
    found = np.array(
        [[wandering(i, k, np.uint64(7), no_draws(1)[0]) for k in knots] for i in range(40)]
    )
    assert found.mean() == pytest.approx(0.0, abs=0.05)
    assert found.std() == pytest.approx(1.0, abs=0.05)
    lag = round(E_FOLD / 0.05)
    same = np.mean(found[:, :-lag] * found[:, lag:])
    assert same == pytest.approx(math.exp(-1.0), abs=0.06)


def test_the_memory_of_draws_changes_no_number() -> None:
    kept, key = no_draws(1)[0], np.uint64(7)
    for knots in (0.0, 0.3, 1.1, 0.2, 7.9, 8.0, 8.9, 9.0, 2.5):
        fresh = wandering(3, knots, key, no_draws(1)[0])
        assert wandering(3, knots, key, kept) == fresh


def test_wander_is_of_person_and_key_only() -> None:
    part = Steering(SteeringSpec(wander=WanderSpec()), key=3)
    one = steered(part, seen([(0.0, 0.0), (5.0, 0.0)], [(1.0, 0.0)] * 2, time=2.5))
    more = steered(part, seen([(3.0, 0.0), (9.0, 0.0), (1.0, 4.0)], [(1.0, 0.0)] * 3, time=2.5))
    assert one.tolist() == more[:2].tolist()
    other = steered(
        Steering(SteeringSpec(wander=WanderSpec()), key=4),
        seen([(0.0, 0.0), (5.0, 0.0)], [(1.0, 0.0)] * 2, time=2.5),
    )
    assert not np.allclose(one, other)
    assert not np.allclose(one[0], one[1])


@costly(50)
@given(
    st.lists(
        st.tuples(
            st.floats(-3, 3), st.floats(-2, 2), st.floats(-2, 2), st.floats(-2, 2)
        ),
        min_size=1,
        max_size=8,
    )
)  # fmt: skip
def test_parts_are_finite_within_the_limit_and_of_no_order(
    people: list[tuple[float, float, float, float]],
) -> None:
    walls = np.array([[-5.0, -2.0, 5.0, -2.0], [-5.0, 2.0, 5.0, 2.0]])
    at, v = [p[:2] for p in people], [p[2:] for p in people]
    view = seen(at, v, walls)
    found = steered(FULL, view)
    assert np.all(np.isfinite(found))
    assert np.all(np.hypot(found[:, 0], found[:, 1]) <= 5.0 + 1e-9)
    turned = seen(at[::-1], v[::-1], walls)
    turned = replace(turned, agents=replace(turned.agents, id=turned.agents.id[::-1].copy()))
    assert np.allclose(steered(FULL, turned)[::-1], found, rtol=1e-9, atol=1e-9)


def walk(steering: Steering, policy: object, avoided: float | None = None) -> Array:
    grid = np.array([(x, y) for x in np.arange(0.5, 10.0, 1.0) for y in (-1.0, 0.0, 1.0)])
    agents = Agents.of(
        x=grid[:, 0],
        y=grid[:, 1],
        preferred_speed=np.linspace(0.8, 1.8, len(grid)),
        radius=0.2,
        avoided_radius=avoided,
        routes=[[(x + 1e4, y)] for x, y in grid],
    )
    world = CrowdWorld(
        walls=np.array([[-5.0, -1.5, 15.0, -1.5], [-5.0, 1.5, 15.0, 1.5]]),
        periodic_boundary=(0.0, 10.0, -np.inf, np.inf),
        steering=steering,
    )
    engine = CrowdEngine(agents, world, policy)  # type: ignore[arg-type]
    flat = engine.initial_state()
    for _ in range(64):
        engine.advance(flat)
    return flat


def test_without_parts_nothing_changes() -> None:
    assert walk(Steering(), Straight()).tobytes() == walk(Steering(), Straight(), 0.2).tobytes()


def test_any_policy_can_have_them() -> None:
    for policy in (
        Straight(),
        policy_of({"kind": "velocity_space", "method": "global"}, {"a": {"kind": "orca"}}),
        policy_of(
            {"kind": "velocity_space", "method": "gradient"},
            {"a": {"kind": "power_law"}, "g": {"kind": "goal_reaching_force"}},
        ),
    ):
        plain, changed = walk(Steering(), policy), walk(FULL, policy)
        assert np.all(np.isfinite(changed))
        assert not np.allclose(plain, changed)


def test_who_has_a_time_gap_slows_down_in_a_crowd() -> None:
    def pace(flat: Array) -> float:
        return float(s.view(flat)[1][:, s.VX].mean())

    assert pace(walk(Steering(SteeringSpec(time_gap=TimeGapSpec())), Straight())) < pace(
        walk(Steering(), Straight())
    )


def test_a_run_that_goes_on_from_a_state_is_the_same() -> None:
    first = walk(FULL, Straight())
    again = walk(FULL, Straight())
    assert first.tobytes() == again.tobytes()


def test_discs_that_touch_are_smaller_than_those_that_are_avoided() -> None:
    policy = policy_of({"kind": "velocity_space", "method": "global"}, {"a": {"kind": "orca"}})
    narrow, wide = walk(Steering(), policy), walk(Steering(), policy, 0.35)
    assert not np.allclose(narrow, wide)
    with pytest.raises(ValueError, match="avoided_radius"):
        Agents.of(x=[0.0], y=[0.0], avoided_radius=-1.0)
