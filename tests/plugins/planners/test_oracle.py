"""Oracle: what it does with the truth, in a world whose people avoid nobody."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugin import Array, Observation, Pose, Truth
from crowdbot.plugins.planners import oracle_rollout_build as rollout
from crowdbot.plugins.planners.oracle import ORACLE, OracleSpec
from crowdbot.plugins.planners.oracle_build import build
from tests.plugins.planners.world import PERSON, RADIUS, World, crowd


class KnownWorld(World):
    """The same, for planners that are told the truth."""

    def _observe(self) -> Observation:
        v, w = self.twist
        yaw = self.pose.yaw
        truth = Truth(
            pose=self.pose,
            velocity=(v * math.cos(yaw), v * math.sin(yaw), w),
            people=self.people[:, :2].copy(),
            people_velocity=self.people[:, 2:].copy(),
            people_radius=np.full(len(self.people), PERSON),
            people_id=np.arange(len(self.people)),
        )
        return replace(super()._observe(), truth=truth)


def test_component() -> None:
    assert load_build(ORACLE) is build
    assert (OracleSpec.role, OracleSpec.privileged) == ("ceiling", True)


def test_alone_it_is_as_fast_as_can_be() -> None:
    out = KnownWorld().run(build(OracleSpec()), stop_at=20.0)
    assert out.arrived
    assert out.t < 17.5 / 0.65 + 1.5
    assert max(abs(p.y) for p in out.path) < 0.05


@pytest.mark.slow
def test_it_gets_out_of_the_way_of_those_who_do_not() -> None:
    for y in (0.0, 0.2, -0.3):
        out = KnownWorld([[20.0, y, -1.4, 0.0]]).run(build(OracleSpec()), stop_at=20.0)
        assert out.arrived
        assert not out.contacts


@pytest.mark.slow
def test_walls_are_not_people_and_count_all_the_same() -> None:
    door = np.array([[12.0, -5.0, 12.0, 0.5], [12.0, 1.6, 12.0, 5.0]])
    world = KnownWorld(walls=door, start=Pose(6.0, 0.8, 0.0))
    out = world.run(build(OracleSpec()), stop_at=16.0, time_limit=40.0)
    assert out.arrived
    assert out.least_wall_gap > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_through_fifty_who_avoid_nobody(seed: int) -> None:
    people = crowd(seed, 50, (0.8, 1.6), (1, -1))
    out = KnownWorld(people, seed=seed).run(build(OracleSpec()))
    assert out.arrived
    assert len(out.contacts) <= 6


def test_stops_at_the_goal() -> None:
    world = KnownWorld(goal=(6.0, 0.0))
    world.run(build(OracleSpec()), time_limit=15.0)
    assert math.dist(world.pose[:2], (6.0, 0.0)) < 0.2
    assert abs(world.twist[0]) < 1e-3


def test_same_run_twice() -> None:
    people = crowd(3, 50, (0.8, 1.6), (1, -1))
    planner = build(OracleSpec())
    first = KnownWorld(people).run(planner, time_limit=8.0)
    again = KnownWorld(people).run(planner, time_limit=8.0)
    assert first.commands == again.commands


def test_it_turns_to_the_goal_before_it_drives() -> None:
    """A robot that looks away has nothing to gain by standing as it is."""
    world = KnownWorld(start=Pose(10.0, 0.0, math.pi))
    out = world.run(build(OracleSpec()), stop_at=12.0, time_limit=12.0)
    assert out.arrived
    assert min(p.x for p in out.path) > 9.5


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_a_hit_is_where_discs_meet(seed: int) -> None:
    """A rollout straight on against a plain loop in numpy: the first step in which discs touch."""
    rng = np.random.default_rng(seed)
    people = np.column_stack([
        rng.uniform(-3, 3, (4, 2)), rng.uniform(-1.5, 1.5, (4, 2)), np.full(4, PERSON),
    ])  # fmt: skip
    p = rollout_parameters()
    mean, hit, speed, _, aside = rollout.roll(
        people,
        np.empty((0, 2)),
        p,
        np.empty((0, 2)),
        (0.0, 0.0, 0.0, 0.5, 0.0),
        (50.0, 0.0),
        0.5,
        0.0,
    )
    times = rollout.STEP * np.arange(0, round(p[rollout.HORIZON] / rollout.STEP) + 1)
    place = np.column_stack([0.5 * times, np.zeros(len(times))])
    at = people[None, :, :2] + times[:, None, None] * people[None, :, 2:4]
    gap = np.hypot(*(at - place[:, None]).transpose(2, 0, 1)).min(axis=1) - PERSON - RADIUS
    near = np.flatnonzero(gap[1:] < min(p[rollout.MARGIN], gap[0] - 1e-3))
    if gap[0] - 1e-3 >= p[rollout.MARGIN]:  # what is too near already may come apart first
        expected = times[1:][near[0]] if len(near) else p[rollout.HORIZON]
        assert hit == pytest.approx(expected)
        made = 0.5 * np.minimum(times[1:], hit)
        assert mean == pytest.approx(50.0 - made.mean())
    assert speed == pytest.approx(0.5)
    assert aside == 0.0


def rollout_parameters() -> Array:
    """Of the challenge's robot."""
    p = np.zeros(rollout.PARAMETERS)
    p[rollout.A_MAX], p[rollout.ALPHA_MAX], p[rollout.V_MAX], p[rollout.W_MAX] = 1.0, 2.0, 0.65, 3.1
    p[rollout.HORIZON], p[rollout.TURN_TIME], p[rollout.RADIUS] = 4.0, 1.0, RADIUS
    p[rollout.MARGIN], p[rollout.COMFORT] = 0.1, 0.6
    return p
