"""Oracle: what it does with the truth, in a world whose people avoid nobody."""

import math
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugin import Array, Observation, Pose, Truth
from crowdbot.plugins.planners.oracle.oracle import ORACLE, OracleSpec
from crowdbot.plugins.planners.oracle.oracle_build import build
from crowdbot.plugins.planners.people_mpc.giving_way_build import give_way
from tests.plugins.planners.world import PERSON, RADIUS, World, crowd


class KnownWorld(World):
    """The same, for planners that are told the truth: from which time to contact people notice."""

    notice, foreseen = 0.0, True

    def _foresee(self, steps: int, step: float, path: Array | None = None) -> Array:
        del path  # they avoid nobody
        times = step * np.arange(1, steps + 1)[:, np.newaxis, np.newaxis]
        return np.asarray(self.people[:, :2] + times * self.people[:, 2:])

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
            people_notice=np.full(len(self.people), self.notice),
            foresee=self._foresee if self.foreseen else None,
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


def test_it_keeps_its_way_where_a_person_gives_way() -> None:
    """People of this world avoid nobody: one who says so is met, one who does not is passed."""
    aside = {}
    for notice in (0.0, math.inf):
        world = KnownWorld([[9.0, 0.05, -1.0, 0.0]], start=Pose(2.5, 0.0, 0.0))
        world.notice = notice
        out = world.run(build(OracleSpec()), time_limit=2.5)
        aside[notice] = max(abs(p.y) for p in out.path)
    assert aside[math.inf] < 0.1
    assert aside[0.0] > 0.15


@pytest.mark.parametrize("notice", [0.0, 0.4, math.inf])
def test_people_give_way_who_notice(notice: float) -> None:
    """A person walks into a robot head-on: who notices in time passes it, others walk on."""
    dt, steps = 0.16, 40
    people = np.array([[4.0, 0.05, -1.0, 0.0, PERSON]])
    first = people.copy()
    times = dt * np.arange(1, steps + 1)
    predicted = np.column_stack([4.0 - times, np.full(steps, 0.05)])[:, np.newaxis]
    least = math.inf
    for n in range(steps):
        x = 0.5 * dt * (n + 1)
        robot = (x, 0.0, 0.5, 0.0, RADIUS)
        give_way(people, first, np.array([notice]), predicted, n, robot, dt)
        least = min(least, math.dist(people[0, :2], (x, 0.0)) - PERSON - RADIUS)
    if notice == 0.0:
        assert people[0, :2].tolist() == predicted[-1, 0].tolist()
        assert least < -0.3
    else:
        assert (least > 0.0) == (notice == math.inf)
        assert people[0, 1] > 0.1  # on the shorter side
        assert people[0, 2] == pytest.approx(-1.0, abs=0.05)  # on its own way again


def test_people_who_do_not_meet_the_robot_do_as_predicted() -> None:
    people = np.array([[4.0, 2.0, -1.0, 0.0, PERSON], [-1.0, 0.0, -1.0, 0.0, PERSON]])
    predicted = (people[:, :2] + 0.16 * people[:, 2:4])[np.newaxis]
    first = people.copy()
    give_way(people, first, np.full(2, math.inf), predicted, 0, (0.0, 0.0, 0.5, 0.0, RADIUS), 0.16)
    assert people[:, :2] == pytest.approx(predicted[0])
