"""Sensors: when they sample, and that they do not depend on each other."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np
import pytest
from sim_worlds import Drive, Memory, Rig, constant, rig, scenario

from crowdbot.core.sim import ports

TICK = 1.0 / 128.0
ALL = ("front_lidar", "rear_lidar", "odometry")
ODD = ("robots.robot.sensors.front_lidar.rate=10", "robots.robot.sensors.rear_lidar.rate=3")


def _run(
    *overrides: str, sensors: Collection[str] = ALL, until: float = 1.5, seed: int = 0
) -> tuple[Rig, Drive]:
    planner = constant(0.4, 0.3)
    return rig(scenario(*overrides), planner, sensors=sensors, seed=seed).advance(until), planner


def _stamps(memory: Memory, name: str) -> list[float]:
    return [r.stamp for r in memory.readings[name]]


def _expected(rate: float, until: float) -> list[float]:
    """First tick at or after n / rate, up to ``until`` itself."""
    ticks = (math.ceil(round(n * 128.0 / rate, 9)) for n in range(1000))
    return [k * TICK for k in ticks if k * TICK <= until]


@pytest.mark.parametrize(
    ("overrides", "rates"),
    [
        ((), {"front_lidar": 16.0, "rear_lidar": 16.0, "odometry": 64.0}),
        (ODD, {"front_lidar": 10.0, "rear_lidar": 3.0, "odometry": 64.0}),
        (("robots.robot.sensors.odometry.rate=50",), {"odometry": 50.0}),
    ],
)
def test_samples_fall_on_the_right_ticks(
    overrides: tuple[str, ...], rates: dict[str, float]
) -> None:
    world, _ = _run(*overrides)
    world.advance(1.5 + TICK)  # readings are recorded one tick after they were taken
    for name, rate in rates.items():
        assert _stamps(world.memory, name) == _expected(rate, 1.5)


def test_a_reading_is_of_the_instant_of_its_stamp() -> None:
    """Odometry, whose noise-free pose follows the true one closely."""
    world, _ = _run(until=0.0)
    poses = {0.0: world.robot()}
    for tick in range(1, 129):
        world.advance(tick * TICK)
        poses[tick * TICK] = world.robot()
    world.advance(129 * TICK)
    checked = 0
    for reading in world.memory.readings["odometry"]:
        if reading.stamp not in poses:
            continue
        x, y, yaw = reading.values[:3]
        true = poses[reading.stamp]
        assert math.hypot(x - true.x, y - true.y) < 2e-3 + 0.01 * abs(true.x - 2.5)
        assert abs(yaw - true.yaw) < 0.01
        checked += 1
    assert checked == 65


def test_a_planner_step_sees_the_readings_of_its_own_tick() -> None:
    world, planner = _run()
    del world
    assert [obs.t for obs in planner.seen] == [n / 16.0 for n in range(24)]
    for obs in planner.seen:
        assert {r.stamp for r in obs.readings.values()} == {obs.t}


def test_readings_do_not_depend_on_what_else_runs() -> None:
    everything, _ = _run()
    for few in (("front_lidar", "odometry"), ("rear_lidar",), ("odometry",)):
        world, _ = _run(sensors=few)
        assert set(world.memory.readings) == set(few)
        for name in few:
            for a, b in zip(
                world.memory.readings[name], everything.memory.readings[name], strict=True
            ):
                assert a.stamp == b.stamp
                assert a.values.tobytes() == b.values.tobytes()


def test_another_run_seed_is_other_noise_on_the_same_world() -> None:
    one, _ = _run(seed=0)
    two, _ = _run(seed=1)
    first, second = (w.memory.readings["front_lidar"] for w in (one, two))
    a, b = (np.concatenate([r.values for r in readings]) for readings in (first, second))
    both = np.isfinite(a) & np.isfinite(b)
    difference = a[both] - b[both]
    assert np.mean(both) > 0.5
    assert np.std(difference) == pytest.approx(1e-3 * math.sqrt(2.0), rel=0.1)
    assert np.array_equal(one.crowd(), two.crowd())


def test_the_two_lidars_have_different_noise() -> None:
    """Seen from the same place and heading, they agree but for the noise."""
    same = "robots.robot.sensors.rear_lidar.mount={x: 0.17, y: 0, z: 0.24, yaw: 0}"
    world, _ = _run(same)
    front, rear = (world.memory.readings[n][3].values for n in ("front_lidar", "rear_lidar"))
    both = np.isfinite(front) & np.isfinite(rear)
    assert np.mean(both) > 0.5
    assert 1e-4 < np.std(front[both] - rear[both]) < 3e-3


@pytest.mark.parametrize("start", [(2.5, 0.0, 0.0), (10.0, -2.0, 2.0), (30.0, 1.0, -3.0)])
def test_odometry_starts_at_the_start_pose(start: tuple[float, float, float]) -> None:
    x, y, yaw = start
    world, planner = _run(f"robots.robot.task.start=[{x}, {y}, {yaw}]", "crowd=null", until=0.25)
    del world
    assert planner.seen[0].t == 0.0
    assert tuple(planner.seen[0].pose) == pytest.approx(start, abs=1e-9)
    assert planner.seen[0].twist == pytest.approx((0.0, 0.0), abs=1e-9)


def test_people_outside_are_not_seen() -> None:
    """The scene holds whom the crowd holds: everybody present, nobody else."""
    world, _ = _run()
    bank = world.blocks.bank
    mine = bank.GetMyContextFromRoot(world.context)
    assert bank.GetOutputPort(ports.READINGS).Eval(mine)[0] == 1.5 * 128
