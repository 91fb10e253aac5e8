"""The robot alone: step response, walls, wheels."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.core.sim.sim_worlds import Drive, alone, constant, rig

START = "robots.robot.task.start=[{}, {}, {}]"


def test_the_robot_moves() -> None:
    """A desired state that is not connected disarms the wheels without a word."""
    world = rig(alone(), constant(0.3))
    plant = world.plant.plant
    port = plant.get_desired_state_input_port(world.plant.model)
    assert port.HasValue(plant.GetMyContextFromRoot(world.context))
    assert plant.get_applied_generalized_force_input_port().HasValue(
        plant.GetMyContextFromRoot(world.context)
    ) == (world.blocks.crowd is not None)
    robot = world.advance(4.0).robot()
    assert robot.x - 2.5 == pytest.approx(0.3 * 4.0 - 0.5 * 0.3**2 / 1.0, rel=0.02)
    assert abs(robot.y) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_full_speed_and_yaw_rate_settle_without_overshoot(sign: float) -> None:
    """From rest to (0.65 m/s, 3.14 rad/s), limited by the slew of 1 m/s^2 and 2 rad/s^2."""
    v, w = 0.65, sign * 3.14
    world = rig(alone(START.format(25, 0, 0)), constant(v, w))
    track = world.track(4.0)
    forward = np.array([r.vx * math.cos(r.yaw) + r.vy * math.sin(r.yaw) for _, r in track])
    yaw_rate = np.array([r.w for _, r in track])
    t = np.array([t for t, _ in track])
    assert np.max(forward) <= v * 1.005
    assert np.max(yaw_rate * sign) <= 3.14 * 1.005
    settled = t > 2.5
    assert forward[settled] == pytest.approx(np.full(int(settled.sum()), v), rel=5e-3)
    assert yaw_rate[settled] == pytest.approx(np.full(int(settled.sum()), w), rel=5e-3)
    assert np.all(forward <= np.minimum(v, t * 1.0) + 0.01)
    assert np.all(np.diff(forward[t < 0.6]) > 0.0)
    assert np.interp(0.325, t, forward) == pytest.approx(0.325, abs=0.05)
    assert max(r.tilt for _, r in track) < math.radians(1.5)


def test_a_turn_on_the_spot_stays_on_the_spot() -> None:
    world = rig(alone(), constant(0.0, 1.5))
    robot = world.advance(6.0).robot()
    assert math.hypot(robot.x - 2.5, robot.y) < 0.01
    assert robot.w == pytest.approx(1.5, rel=5e-3)


def test_commands_are_slewed() -> None:
    """A jump from full ahead to full astern takes 1.3 s."""
    world = rig(alone(), Drive(lambda t: (0.65 if t < 1.0 else -0.65, 0.0)))
    track = dict(world.track(3.0))
    assert track[1.0].vx == pytest.approx(0.65, rel=5e-3)
    assert track[1.5].vx == pytest.approx(0.15, abs=0.05)
    assert track[3.0].vx == pytest.approx(-0.65, rel=5e-3)
    accelerations = np.diff([r.vx for r in track.values()]) * 64.0
    assert np.max(np.abs(accelerations)) < 1.6


WALLS = {
    "left": ("25", "4", "1.5707963267948966", "y", 5.0 - 0.178),
    "right": ("25", "-4", "-1.5707963267948966", "y", -5.0 + 0.178),
    "start": ("1", "0", "3.141592653589793", "x", 0.178),
    "end": ("49", "0", "0", "x", 50.0 - 0.178),
    "slant": ("25", "4.3", "0.7853981633974483", "y", 5.0 - 0.178),
}


@pytest.mark.slow
@pytest.mark.parametrize("wall", list(WALLS))
def test_a_wall_stops_the_robot(wall: str) -> None:
    x, y, yaw, axis, expected = WALLS[wall]
    zone = "robot_goal" if wall != "end" else "robot_spawn"
    world = rig(
        alone(START.format(x, y, yaw), f"robots.robot.task.goal.zone={zone}"), constant(0.65)
    )
    track = world.track(5.0)
    beyond = [abs(getattr(r, axis)) - abs(expected) for _, r in track]
    if expected == 0.178:
        beyond = [0.178 - r.x for _, r in track]
    assert max(beyond) < 0.01
    assert max(r.tilt for _, r in track) < math.radians(3.0)
    assert all(abs(r.z - track[0][1].z) < 0.01 for _, r in track)
    last = track[-1][1]
    assert getattr(last, axis) == pytest.approx(expected, abs=5e-3)
    if wall != "slant":
        assert math.hypot(last.vx, last.vy) < 0.02


def test_all_periods_are_dyadic(monkeypatch: pytest.MonkeyPatch) -> None:
    """Event times of other periods do not coincide in floating point."""
    from pydrake.systems.framework import LeafSystem

    from tests.core.sim.sim_worlds import scenario

    declared: list[tuple[float, float]] = []

    def watched(name: str) -> None:
        original = getattr(LeafSystem, name)

        def declare(self: object, period: float, offset: float, *rest: object) -> object:
            declared.append((period, offset))
            return original(self, period, offset, *rest)

        monkeypatch.setattr(LeafSystem, name, declare)

    for name in dir(LeafSystem):
        if name.startswith("DeclarePeriodic"):
            watched(name)
    world = rig(scenario(), constant(0.0), sensors=("odometry", "front_lidar", "rear_lidar"))
    assert len(declared) == 6  # crowd, sensors, planner, logger (twice), recorder
    declared.append((world.plant.plant.time_step(), 0.0))
    for period, offset in declared:
        mantissa, exponent = math.frexp(period)
        assert (mantissa, offset) == (0.5, 0.0)
        assert exponent >= -6


def test_the_plants_weight_is_the_models() -> None:
    world = rig(alone(), constant(0.0))
    plant = world.plant.plant
    context = plant.GetMyContextFromRoot(world.context)
    assert plant.CalcTotalMass(context, [world.plant.model]) == pytest.approx(6.3)
    before = world.robot()
    after = world.advance(1.0).robot()
    assert abs(after.z - before.z) < 1e-3  # stands where it was put
    assert math.hypot(after.x - before.x, after.y - before.y) < 1e-3
    assert after.tilt < math.radians(0.2)
