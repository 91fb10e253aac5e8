"""Planners of robots with outlines other than discs: gaps, manoeuvres, and ways aside."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate, translate  # type: ignore[import-untyped]
from shapely.geometry import LineString, MultiPoint, Point, Polygon  # type: ignore[import-untyped]

import crowdbot.plugins.planners.dwa.parameters_build as entries
import crowdbot.plugins.planners.dwa.rollouts_build as rollout
import crowdbot.plugins.planners.dwa.window_build as window
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.simulate import simulate
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.plugin import Array, Pose, RobotBody, RobotLimits
from crowdbot.plugins.planners.dwa.cost_build import evaluate
from crowdbot.plugins.planners.dwa.dead_ends.legs_build import Legs
from crowdbot.plugins.planners.dwa.dead_ends.manoeuvre_build import manoeuvre
from crowdbot.plugins.planners.shared.local_map_build import islands
from crowdbot.plugins.planners.shared.robot_outline_build import (
    core_gap,
    core_of,
    nearest_to_core,
    swept_half_width,
)

BOX = np.array([[0.55, 0.35], [-0.55, 0.35], [-0.55, -0.35], [0.55, -0.35]])
CAPSULE = np.array([[0.051, 0.0], [-0.515, 0.0]])
REACH = math.hypot(0.55, 0.35)


def body(
    footprint: Array | None,
    radius: float,
    drive: Literal["differential", "holonomic"] = "differential",
) -> RobotBody:
    return RobotBody(
        drive=drive, radius=radius, footprint=footprint, front=0.55, back=0.5, half_width=0.35
    )


def test_what_a_robot_says_becomes_its_core() -> None:
    core, rounding = core_of(None, body(BOX[::-1], REACH))  # clockwise, as some are told
    assert rounding == 0.0
    assert core_gap(core, 0.0, 0.0) == pytest.approx(-0.35)
    assert core_of(None, body(CAPSULE, 0.4))[1] == 0.4
    assert [len(core_of(*given)[0]) for given in ((0.3, body(BOX, 1.0)), (None, None))] == [0, 0]
    assert swept_half_width(None, body(BOX, REACH)) == 0.35
    assert swept_half_width(None, body(BOX, REACH, "holonomic")) == 0.55


@given(st.booleans(), st.lists(st.tuples(*[st.floats(-2.0, 2.0)] * 2), min_size=1, max_size=20),
       st.tuples(*[st.floats(-1.0, 1.0)] * 2), st.floats(-7.0, 7.0))  # fmt: skip
def test_gaps_are_those_of_shapely(
    box: bool, where: list[tuple[float, float]], at: tuple[float, float], angle: float
) -> None:
    core, shape = (BOX, Polygon(BOX)) if box else (CAPSULE, LineString(CAPSULE))
    placed = translate(rotate(shape, angle, origin=(0, 0), use_radians=True), *at)
    gaps = [placed.distance(Point(p)) or -placed.boundary.distance(Point(p)) for p in where]
    least = min(gaps) if box else min(placed.distance(Point(p)) for p in where)
    found = nearest_to_core(np.array(where).T.copy(), core, *at, angle, float(
        np.hypot(*core.T).max()))  # fmt: skip
    assert found == pytest.approx(least, abs=1e-9)


def parameters() -> Array:
    p = np.zeros(entries.PARAMETERS)
    p[entries.A_MAX], p[entries.ALPHA_MAX], p[entries.HORIZON] = 1.0, 2.0, 2.5
    p[entries.TURN_TIME], p[entries.MARGIN], p[entries.COMFORT] = 1.0, 0.06, 0.4
    p[entries.V_MAX], p[entries.W_MAX], p[entries.PERIOD], p[entries.REACH] = (
        1.5,
        1.5,
        0.0625,
        REACH,
    )
    return p


@settings(max_examples=60)
@given(st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_what_rollouts_of_a_box_know_of_each_other_changes_none(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, speeds = rng.uniform(-2.5, 2.5, (count, 2)), rng.uniform(-1.0, 1.0, (count, 2))
    p, now = parameters(), (0.3, 0.2, 0.1)
    ahead = rollout.foreseen(cloud, speeds, p)
    known = rollout.rollouts(ahead)
    for target in rng.uniform(-1.0, 1.0, (30, 3)):
        given_ = tuple(target.tolist())
        shared = rollout.roll(ahead, p, BOX, now, given_, *known)
        assert shared == rollout.roll(ahead, p, BOX, now, given_, *rollout.rollouts(ahead))


def test_a_long_robot_does_not_turn_into_what_stands_beside_it() -> None:
    beside = np.array([[0.5, 0.45]])
    p, zero = parameters(), (0.0, 0.0, 0.0)
    for turn, index in ((-1.0, 0), (1.0, -1)):  # its front swings away from it, or into it
        wish = np.array([[0.0, turn]])
        found = evaluate(beside, 0.0 * beside, p, BOX, zero, wish, 0.0, 0.0, zero)
        assert found[0] == index


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.0, 1.5), st.floats(-4.0, 4.0))
def test_ways_aside_keep_to_what_the_drive_can(
    v: float, vy: float, top: float, direction: float
) -> None:
    rates = np.array([0.3, 0.0])
    found = window.candidates_aside((v, vy), 0.275, top, 6, direction, rates)
    assert np.all(np.hypot(found[:, 0] - v, found[:, 2] - vy) <= 0.275 + 1e-12)
    assert np.all(np.hypot(found[:, 0], found[:, 2]) <= max(top, math.hypot(v, vy)) + 1e-12)
    assert set(found[:, 1]) == {0.3, 0.0}


def test_a_sideways_rollout_goes_where_its_velocity_points() -> None:
    nothing = rollout.foreseen(np.empty((0, 2)), np.empty((0, 2)), parameters())
    x, y, angle, hit, _ = rollout.roll(
        nothing, parameters(), BOX, (0.3, 0.0, 0.4), (0.3, 0.0, 0.4), *rollout.rollouts(nothing)
    )
    assert (x, y, angle, hit) == pytest.approx((0.75, 1.0, 0.0, 2.5))


def wall_with_door(width: float) -> Array:
    """Both faces of a wall 0.2 m thick at x = 2 m, the door in the middle."""
    ys = np.arange(0.5 * width, 2.5, 0.03)
    half = np.concatenate([[[x, y] for y in ys] for x in (1.9, 2.1)])
    return np.concatenate([half, half * (1.0, -1.0)])


@pytest.mark.parametrize("pose", [(0.7, -0.4, 0.3), (1.0, 1.1, -1.6), (0.3, 0.07, 2.8)])
def test_a_manoeuvre_leads_through_the_door_and_touches_nothing(
    pose: tuple[float, float, float],
) -> None:
    wall = wall_with_door(0.9)
    legs = manoeuvre(wall, pose, (4.0, 0.0), BOX, 0.0, REACH, 0.04)
    assert legs[-1, 1] > 2.7
    x, y, yaw = *pose[:2], legs[0, 3]
    for kind, *end in legs.tolist()[1:]:
        turn = math.remainder(end[2] - yaw, 2.0 * math.pi)
        assert (turn == 0.0) == (kind != 0.0)
        ahead = (end[0] - x) * math.cos(yaw) + (end[1] - y) * math.sin(yaw)
        assert ahead * kind > 0.0 or kind == 0.0
        for s in np.linspace(0.0, 1.0, 20):
            placed = rotate(Polygon(BOX), yaw + s * turn, origin=(0, 0), use_radians=True)
            at = x + s * (end[0] - x), y + s * (end[1] - y)
            assert translate(placed, *at).distance(MultiPoint(wall)) > 0.02
        x, y, yaw = end


def test_there_is_no_manoeuvre_through_a_door_that_is_too_narrow() -> None:
    shut = np.concatenate([wall_with_door(0.7), [[x, y] for x in np.arange(-2.5, 2.0, 0.1)
                                                 for y in (-2.4, 2.4)],
                           [[-2.5, y] for y in np.arange(-2.4, 2.4, 0.1)]])  # fmt: skip
    assert len(manoeuvre(shut, (0.0, 0.0, 0.0), (4.0, 0.0), BOX, 0.0, REACH, 0.04)) == 0


def test_legs_are_driven_to_their_ends() -> None:
    """A unicycle that does as it is told: turn, ahead, back."""
    limits = RobotLimits(v_min=-1.5, v_max=1.5, w_max=1.5, a_max=1.0, alpha_max=2.0)
    legs = Legs()
    legs.begin(np.array([[0, 0, 0, 1.0], [1, 0.54, 0.84, 1.0], [-1, 0.27, 0.42, 1.0]]), 0.0)
    x, y, yaw = 0.0, 0.02, 0.0
    for _ in range(400):
        v, w = legs.velocity(Pose(x, y, yaw), limits)
        x, y, yaw = x + v * math.cos(yaw) / 16, y + v * math.sin(yaw) / 16, yaw + w / 16
    assert not legs
    assert legs.velocity(Pose(x, y, yaw), limits) == (0.0, 0.0)
    assert math.dist((x, y), (0.27, 0.42)) < 0.05


def test_small_things_that_stand_alone_are_islands() -> None:
    wall = np.array([[x, 2.0] for x in np.arange(-2.0, 2.0, 0.2)])
    legs = np.array([[0.5, 0.1], [0.5, -0.1]])
    assert islands(np.concatenate([wall, legs]), 0.25, 0.6).tolist() == [[0.5, 0.0]]


DOOR = """\
crowdbot: 1
scenario:
  id: door
  extends: ["builtin:parts/smart_wheelchair.yaml"]
  environment:
    kind: floor
    area: {x: [0 m, 12 m], y: [-3 m, 3 m]}
    blocks:
      north: {corners: [[5.9 m, 0.45 m], [6.1 m, 0.45 m], [6.1 m, 3 m], [5.9 m, 3 m]]}
      south: {corners: [[5.9 m, -3 m], [6.1 m, -3 m], [6.1 m, -0.45 m], [5.9 m, -0.45 m]]}
    zones: {start: {x: [0 m, 3 m], y: [-3 m, 3 m]}, goal: {x: [9 m, 11 m], y: [-2 m, 2 m]}}
  robots.robot.model.width: 0.7 m
  robots.robot.task: {start: [2 m, 0 m, 0 deg], goal: {zone: goal}, time_limit: 45 s}
"""
PERSON = """\
crowdbot: 1
scenario:
  id: aside
  extends: ["builtin:parts/pepper.yaml"]
  environment:
    kind: floor
    area: {x: [0 m, 12 m], y: [-3 m, 3 m]}
    zones: {start: {x: [0 m, 3 m], y: [-3 m, 3 m]}, goal: {x: [7 m, 11 m], y: [-2 m, 2 m]}}
  robots.robot.task: {start: [2 m, 0 m, 0 deg], goal: {zone: goal}, time_limit: 25 s}
  crowd:
    agents: [{id: 0, x: 5 m, y: 0 m, goals: [[5 m, 0 m]]}]
    speed: {mean: 1.2 m/s, std: 0 m/s}
    policy: {kind: velocity_space}
    costs: {mid_term: {kind: ttca_dca, weight: 20, range: 5 m}}
"""


def run(folder: Path, text: str, *sets: str) -> tuple[str, Trajectories]:
    file = folder / "one.yaml"
    file.write_text(text)
    registry = discover()
    scenario = open_spec(str(file), registry, sets).scenarios[0]
    done = simulate(
        scenario, registry, out=folder, planner="dwa",
        options=RunOptions(references=False, replay=False),
    )  # fmt: skip
    return done.status, done.trajectories


@pytest.mark.slow
@pytest.mark.parametrize(
    "start", ["[2 m, 0 m, 0 deg]", "[2 m, 1.5 m, 0 deg]", "[4.5 m, 0.3 m, 20 deg]"]
)
def test_a_wheelchair_gets_through_a_door_without_contact(tmp_path: Path, start: str) -> None:
    """0.7 m x 1.1 m through 0.9 m, straight on, from aside, and askew right before it."""
    status, done = run(tmp_path, DOOR, f"robots.robot.task.start={start}")
    assert status == "arrived"
    assert done.contacts is None or len(done.contacts.t0) == 0


@pytest.mark.slow
def test_pepper_goes_sideways_around_a_person_without_contact(tmp_path: Path) -> None:
    status, done = run(tmp_path, PERSON)
    assert status == "arrived"
    assert done.contacts is None or len(done.contacts.t0) == 0
    robot = done.robot
    assert robot is not None
    vx, vy = np.gradient(robot.x, done.t), np.gradient(robot.y, done.t)
    aside = np.cos(robot.theta) * vy - np.sin(robot.theta) * vx
    assert np.abs(aside).max() > 0.2  # m/s to the side
    assert np.abs(robot.theta).max() < 0.5  # it went on looking ahead
