"""Parts of the MPC that need no library: constraints, starts, braking, a missing library."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.errors import PluginError
from crowdbot.plugin import Array
from crowdbot.plugins.planners.mpc.constraints_build import constrain, poses_of
from crowdbot.plugins.planners.shared.braking_build import AroundRobot, can_brake
from crowdbot.plugins.planners.shared.optional_build import library
from crowdbot.plugins.planners.shared.starts_build import STARTS, moved_on, starts
from tests.plugins.planners.world import LIMITS

DISC = np.array([[0.0, 0.0, 0.3]])
LONG = np.array([[0.4, 0.0, 0.3], [-0.4, 0.0, 0.3]])
NOBODY, NOTHING = np.zeros((0, 5)), np.zeros((0, 2))


def _rows(world: AroundRobot, yaw: float = 0.0, people: int = 2, planes: int = 2) -> Array:
    poses = np.array([[0.0, 0.0, yaw]])
    rows: Array = constrain(world, poses, 0.5, (0.1, 0.2), people, planes)[0]
    return rows


def test_a_library_that_is_missing_is_named_with_its_extra() -> None:
    with pytest.raises(PluginError, match=r"'mpc' needs the library no_such: .*crowdbot\[mpc\]"):
        library("mpc", "no_such.part", "mpc")


def test_people_are_where_they_will_be_and_those_with_the_least_gap_come_first() -> None:
    people = np.array([[2.0, 0.0, 0.0, 0.0, 0.2], [3.0, 1.0, -4.0, 0.0, 0.2], [9.0, 0, 0, 0, 0.2]])
    rows = _rows(AroundRobot(people, NOTHING, DISC))
    assert rows[0] == pytest.approx([1.0, 1.0, 0.0, 0.0, 0.3 + 0.2 + 0.1 + 0.5 * 0.2])
    assert rows[1, :2] == pytest.approx([2.0, 0.0])
    alone = _rows(AroundRobot(people[2:], NOTHING, DISC))
    assert (alone[:, 4] < -100.0).all()


def test_the_disc_of_a_long_robot_that_is_nearest_is_constrained() -> None:
    people = np.array([[0.0, -1.5, 0.0, 0.0, 0.2]])
    rows = _rows(AroundRobot(people, NOTHING, LONG), yaw=0.5 * math.pi)
    assert rows[0, 2] == -0.4


def test_half_planes_keep_off_both_walls_of_a_corridor() -> None:
    along = np.linspace(-2.0, 2.0, 41)
    walls = np.concatenate([np.column_stack([along, np.full(41, y)]) for y in (-0.9, 0.8)])
    planes = _rows(AroundRobot(NOBODY, walls, DISC))[2:]
    assert planes[:, 1] == pytest.approx([-1.0, 1.0])
    assert planes[:, 4] == pytest.approx([0.3 + 0.1 - 0.8, 0.3 + 0.1 - 0.9])


def test_poses_of_a_plan_drive_an_arc_and_sideways() -> None:
    quarter = np.full((8, 2), [1.0, 1.0])
    x, y, yaw = poses_of((0.0, 0.0, 0.0), quarter, math.pi / 16.0)[-1]
    assert (x, y) == pytest.approx((1.0, 1.0), abs=0.01)
    assert yaw == pytest.approx(0.5 * math.pi)
    aside = poses_of((0.0, 0.0, 0.5 * math.pi), np.array([[0.0, 0.0, 1.0]]), 0.5)
    assert aside[0] == pytest.approx([-0.5, 0.0, 0.5 * math.pi])


def _brakes(v: float, people: np.ndarray, points: np.ndarray, *, from_speed: float = 1.0) -> bool:
    state = (0.0, 0.0, 0.0, from_speed, 0.0, 0.0)
    world = AroundRobot(people, points, DISC)
    return bool(can_brake(world, state, (v, 0.0, 0.0), (1.0, 2.0), (0.2, 0.05)))


def test_it_can_brake_before_a_wall_only_from_far_enough() -> None:
    """From 1 m/s it needs 0.2 m while the command holds, and at most 0.5 m to stop."""
    assert _brakes(1.0, NOBODY, np.array([[1.15, 0.0]]))
    assert not _brakes(1.0, NOBODY, np.array([[0.85, 0.0]]))
    assert _brakes(0.0, NOBODY, np.array([[0.85, 0.0]]))


def test_who_comes_towards_it_needs_more_room_and_who_walks_away_none() -> None:
    there = np.array([[1.2, 0.0, 0.0, 0.0, 0.1]])
    coming, going = there.copy(), there.copy()
    coming[0, 2], going[0, 2] = -1.0, 1.0
    assert _brakes(1.0, there, NOTHING)
    assert not _brakes(1.0, coming, NOTHING)
    assert _brakes(1.0, going, NOTHING)


def test_starting_plans_keep_limits_and_slew_and_go_to_both_sides() -> None:
    state = (0.0, 0.0, 0.0, 0.3, 0.0, 0.0)
    plans = starts(state, (9.0, 0.0), LIMITS, (12, 2), 0.25, LIMITS.v_max)
    assert plans.shape == (STARTS, 12, 2)
    before = np.concatenate([np.full((STARTS, 1, 2), [0.3, 0.0]), plans[:, :-1]], axis=1)
    change = np.abs(plans - before).reshape(-1, 2).max(axis=0)
    assert (change <= np.array([LIMITS.a_max, LIMITS.alpha_max]) * 0.25 + 1e-9).all()
    ends = [poses_of((0.0, 0.0, 0.0), plan, 0.25)[-1, 1] for plan in plans]
    assert max(ends) == pytest.approx(-min(ends))
    assert max(ends) > 0.5


def test_a_plan_moves_on_between_its_stages_and_keeps_its_end() -> None:
    plan = np.array([[0.0, 1.0], [1.0, 1.0], [2.0, 3.0]])
    assert moved_on(plan, 0.5).tolist() == [[0.5, 1.0], [1.5, 2.0], [2.0, 3.0]]
    assert moved_on(plan, 9.0).tolist() == [[2.0, 3.0]] * 3
