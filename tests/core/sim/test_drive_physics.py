"""Responses of the drives in closed form, odometry on a square, pushing at walls, slipping."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from crowdbot.core.sim.control.force import moved
from crowdbot.core.sim.plant import floor_of
from crowdbot.core.support.ticks import TICK
from crowdbot.dsl.identity.canonical import canonical_bytes
from tests.core.sim.sim_worlds import Drive, alone, constant, rig

pytestmark = pytest.mark.slow

MODES = ("kinematic", "force", "differential_drive")
MIDDLE = "robots.robot.task.start=[25, 0, 0]"
BEFORE_WALL = "robots.robot.task.start=[25, 4.3, {}]"
QUICK = ("robots.robot.model.max_acceleration=100", "robots.robot.model.max_yaw_acceleration=500")
BELIEVED = 0.035 / 0.0352
NOTCH = 2.0 * math.pi / 2578.33


def _speeds(mode: str, v: float) -> list[float]:
    world = rig(alone(MIDDLE, f"robots.robot.control={mode}"), constant(v))
    return [r.vx for _, r in world.track(0.875, TICK)]


@pytest.mark.parametrize("v", [0.5, -0.3])
def test_step_response(v: float) -> None:
    """Commands rise by 1 m/s^2, one tick late. A kinematic base has them; a force takes it there
    in one tick; wheels held by d = 1 N m s follow as m r^2/2d = 4 ms tells, integrated implicitly.
    """
    wanted = [math.copysign(min(abs(v), k * TICK), v) for k in range(112)]
    assert _speeds("kinematic", v) == pytest.approx(wanted, abs=1e-12)
    assert _speeds("force", v) == pytest.approx(wanted, abs=1.5e-3)
    world = rig(alone(MIDDLE), constant(v))
    mass, _ = moved(world.plant)
    share = TICK / (mass * 0.0352**2 / 2.0)
    assert mass == pytest.approx(6.45, abs=0.01)
    speed, expected = 0.0, []
    for goal in wanted:
        speed = (speed + share * goal) / (1.0 + share)
        expected.append(speed)
    assert _speeds("differential_drive", v) == pytest.approx(expected, abs=2e-3)


def _square(t: float) -> tuple[float, float]:
    """1 m, a quarter turn to the left, four times."""
    if t >= 12.0:
        return 0.0, 0.0
    return (0.5, 0.0) if t % 3.0 < 2.0 else (0.0, 0.5 * math.pi)


def test_odometry_drifts_on_a_square_as_its_radius_tells() -> None:
    """Wheels of 0.0352 m that are taken for 0.035 m shorten sides and turns by 0.57 %: the square
    does not close, by a vector that follows. Whole notches cost two of them in heading.
    """
    world = rig(alone(MIDDLE, "robots.robot.control=kinematic", *QUICK), Drive(_square))
    robot = world.advance(13.0).robot()
    assert math.hypot(robot.x - 25.0, robot.y) < 1e-9  # it did drive a square
    x, y, yaw = world.memory.readings["odometry"][-1].values[:3]
    corner = BELIEVED * 0.5 * math.pi
    legs = [[math.cos(k * corner), math.sin(k * corner)] for k in range(4)]
    expected = BELIEVED * np.sum(legs, axis=0)
    assert 0.015 < float(np.hypot(*expected)) < 0.03
    heading = 2.0 * NOTCH * 0.035 / 0.23
    assert math.remainder(yaw - 4.0 * corner, 2.0 * math.pi) == pytest.approx(0.0, abs=heading)
    assert np.array([x - 25.0, y]) == pytest.approx(expected, abs=4.0 * heading)


@pytest.mark.parametrize("mode", ["force", "differential_drive"])
def test_odometry_of_rolling_wheels_is_dead_reckoning(mode: str) -> None:
    """The same way with slew limits: what the body did, shortened by the radius, step by step."""
    world = rig(alone(MIDDLE, f"robots.robot.control={mode}"), Drive(_square))
    track = [r for _, r in world.track(13.0, TICK)]
    x = y = yaw = 0.0
    for before, after in itertools.pairwise(track):
        turn = math.remainder(after.yaw - before.yaw, 2.0 * math.pi)
        middle = before.yaw + 0.5 * turn
        dx, dy = after.x - before.x, after.y - before.y
        way = BELIEVED * (dx * math.cos(middle) + dy * math.sin(middle))
        x += way * math.cos(yaw + 0.5 * BELIEVED * turn)
        y += way * math.sin(yaw + 0.5 * BELIEVED * turn)
        yaw += BELIEVED * turn
    found = world.memory.readings["odometry"][-1].values
    assert math.remainder(found[2] - yaw, 2.0 * math.pi) == pytest.approx(0.0, abs=0.01)
    assert found[:2] == pytest.approx([25.0 + x, y], abs=0.02)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("yaw", [0.5 * math.pi, 0.25 * math.pi, -1.25 * math.pi])
def test_pushing_at_a_wall_neither_tips_nor_tunnels(mode: str, yaw: float) -> None:
    """Full speed, head-on and at 45 degrees from either side, for 4 s."""
    world = rig(
        alone(BEFORE_WALL.format(yaw), f"robots.robot.control={mode}"), constant(0.65)
    )  # fmt: skip
    track = [r for _, r in world.track(4.0)]
    assert max(r.y for r in track) < 5.0 - 0.178 + 0.01
    assert max(r.tilt for r in track) < math.radians(3.0)
    assert max(abs(r.z - track[0].z) for r in track) < 0.01
    assert track[-1].y == pytest.approx(5.0 - 0.178, abs=5e-3)
    world.own.logger.walls.finish()
    first = world.memory.contacts[0]
    assert first["agent"] == -1
    assert first["bearing"] == pytest.approx(
        math.remainder(0.5 * math.pi - yaw, 2.0 * math.pi), abs=0.05
    )


@pytest.mark.parametrize("mode", MODES)
def test_a_contact_goes_on_until_the_last_tick(mode: str) -> None:
    """Forces are read while the plant takes its step, which the last tick does not have."""
    limit = "robots.robot.task.time_limit=2"
    yaw = 0.5 * math.pi
    world = rig(
        alone(BEFORE_WALL.format(yaw), f"robots.robot.control={mode}", limit), constant(0.65)
    )
    world.advance(2.0)
    world.own.logger.walls.finish()
    (contact,) = world.memory.contacts
    assert contact["t1"] == 2.0
    ticks = round((contact["t1"] - contact["t0"]) / TICK) + 1
    if mode == "kinematic":
        assert contact["impulse"] == contact["peak_force"] == 0.0
    else:
        assert 0.0 < contact["impulse"] <= contact["peak_force"] * ticks * TICK


def test_wheels_slip_on_a_slippery_floor() -> None:
    """Friction of 0.1: no more than 0.1 g of thrust.

    Wheels spin up at once; odometry counts their way; in the end the robot rolls as commanded.
    """
    world = rig(alone(MIDDLE, "environment.floor.friction=0.1", *QUICK), constant(0.65))
    track = world.track(2.5, TICK)
    slipping = 0
    for (_, before), (t, after) in itertools.pairwise(track):
        rim = (after.left_angle - before.left_angle) / TICK * 0.0352
        gained = (after.vx - before.vx) / TICK
        assert gained < 0.1 * 9.81
        if 0.1 < t < 1.0:
            assert rim > after.vx + 0.05
            assert gained == pytest.approx(0.54, rel=0.1)  # casters carry nearly half the weight
            slipping += 1
    assert slipping > 100
    robot = world.robot()
    assert robot.vx == pytest.approx(0.65, rel=5e-3)
    counted = world.memory.readings["odometry"][-1].values[0] - 25.0
    assert counted == pytest.approx(robot.left_angle * 0.035, abs=0.02)
    assert counted > robot.x - 25.0 + 0.3


def test_a_holonomic_drive_pushes_no_harder_than_the_floor_holds() -> None:
    """Pepper where friction is 0.02: v = mu g t until it is as fast as commanded."""
    quick = "robots.robot.model={kind: pepper, max_acceleration: 5, max_yaw_acceleration: 9}"
    odometry = "robots.robot.sensors={odometry: {kind: holonomic_odometry}}"
    floor = "environment.floor.friction=0.02"
    world = rig(alone(MIDDLE, quick, odometry, "robots.robot.control=force", floor), constant(0.5))
    track = world.track(2.0, TICK)
    for t, robot in track:
        if 0.2 < t < 2.0:
            late = 0.0625 + 2.0 * TICK  # one step of the planner
            assert robot.vx <= 0.02 * 9.81 * t + 1e-6
            assert robot.vx >= 0.02 * 9.81 * (t - late) - 1e-3


def test_the_usual_floor_is_not_in_the_hash() -> None:
    usual = canonical_bytes(alone(MIDDLE), {})
    assert canonical_bytes(alone(MIDDLE, "environment.floor.friction=1"), {}) == usual
    assert b"friction" not in usual
    assert b'"friction":0.4' in canonical_bytes(alone(MIDDLE, "environment.floor.friction=0.4"), {})
    assert (floor_of(1.0).static_friction(), floor_of(1.0).dynamic_friction()) == (1.0, 1.0)
