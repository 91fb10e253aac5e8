"""Goal seek: straight, blind, exact."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugin import Command, Observation, Pose
from crowdbot.plugins.planners.goal_seek import GOAL_SEEK, GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek, bearing, braking_speed, build
from tests.plugins.planners.world import LIMITS, World


def made(**parameters: float) -> GoalSeek:
    planner = build(GoalSeekSpec(**parameters))  # type: ignore[arg-type]
    planner.reset(World().task, LIMITS, {}, 0)
    return planner


def at(x: float, y: float, yaw: float) -> Observation:
    return Observation(
        t=0.0, pose=Pose(x, y, yaw), twist=(0.0, 0.0), goal=(0.0, 0.0), goal_zone=np.zeros((4, 2))
    )


def test_component() -> None:
    assert load_build(GOAL_SEEK) is build
    assert GoalSeekSpec.needs == ()


def test_straight_to_the_goal_at_full_speed() -> None:
    out = World().run(made())
    assert out.arrived
    assert max(abs(p.y) for p in out.path) == 0.0
    assert out.t == pytest.approx(42.5 / 0.65 + 0.65 / 2, abs=0.2)  # with the ramp at the start


def test_speed_is_a_fraction() -> None:
    assert made(speed=0.5).step(at(-10, 0, 0)) == Command(0.325, 0.0)


def test_collides_with_a_person_in_its_line() -> None:
    out = World([[20, 0, 0, 0]]).run(made())
    assert [person for _, person in out.contacts] == [0]
    assert out.arrived


@pytest.mark.parametrize("yaw", [math.pi, 2.0, -1.0])
def test_turns_in_place_first(yaw: float) -> None:
    command = made().step(at(-5, 0, yaw))
    assert command.v == 0.0
    assert command.w * -math.remainder(yaw, 2 * math.pi) > 0 or abs(yaw) == math.pi


@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(-10, 10))
def test_commands_are_within_limits_and_never_backwards(x: float, y: float, yaw: float) -> None:
    command = made().step(at(x, y, yaw))
    assert 0.0 <= command.v <= LIMITS.v_max
    assert abs(command.w) <= LIMITS.w_max


def test_stops_on_the_goal() -> None:
    world = World(goal=(8.0, 1.0))
    out = world.run(made(), time_limit=30.0)
    assert math.dist(world.pose[:2], (8.0, 1.0)) < 0.1
    assert world.twist == (0.0, 0.0)
    assert out.path[-1] == out.path[-100]
    assert max(p.x for p in out.path) < 8.1  # no overshoot


def test_bearing_and_braking() -> None:
    assert bearing(Pose(1, 1, math.pi / 2), (1, 3)) == pytest.approx((2.0, 0.0))
    assert bearing(Pose(0, 0, 3.0), (-1, -0.001))[1] == pytest.approx(math.pi + 0.001 - 3.0)
    assert braking_speed(0.5, 1.0) == 1.0
    assert braking_speed(-1.0, 1.0) == 0.0
