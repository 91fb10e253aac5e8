"""Sensors: when they sample, and that they do not depend on each other."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.sim import ports
from crowdbot.core.sim.sensor_bank import Timetable
from tests.core.sim.sim_worlds import Drive, Memory, Rig, constant, rig, scenario

pytestmark = pytest.mark.slow

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
    bank = world.own.bank
    mine = bank.GetMyContextFromRoot(world.context)
    assert bank.GetOutputPort(ports.READINGS).Eval(mine)[0] == 1.5 * 128


def _times(timetable: Timetable, name: str, until: int) -> list[float]:
    return [k * TICK for k in range(until) if name in timetable(k)]


@given(st.lists(st.one_of(st.sampled_from([1, 2, 8, 16, 64, 128]), st.floats(0.7, 128.0)),
                min_size=1, max_size=4))  # fmt: skip
def test_a_timetable_says_who_is_due(rates: list[float]) -> None:
    """Kept or worked out anew, for whole periods and others."""
    timetable = Timetable({f"s{i}": rate for i, rate in enumerate(rates)})
    for i, rate in enumerate(rates):
        assert _times(timetable, f"s{i}", 300) == _expected(rate, 299 * TICK)


def test_no_sensors_no_turns() -> None:
    assert Timetable({})(5) == ()


def test_the_ring_of_ultrasounds() -> None:
    """8 Hz, from the same instants as the lidars; what is near is near for both."""
    ring = [f"us{k}" for k in range(12)]
    world, _ = _run(sensors=[*ring, *ALL], until=1.0)
    world.advance(1.0 + TICK)
    for name in ring:
        assert _stamps(world.memory, name) == _expected(8.0, 1.0)
        assert all(r.values[0] >= 0.2 for r in world.memory.readings[name])
    wall = [r.values[0] for name in ("us5", "us6", "us7") for r in world.memory.readings[name]]
    assert min(wall) == pytest.approx(2.5 - 0.17, abs=0.05)  # the end of the corridor behind it


def test_people_are_seen_walking() -> None:
    """Legs swing with the way walked: the scene gets it from the crowd."""
    world, _ = _run(until=0.0)
    seen = []
    for tick in range(1, 129, 8):
        world.advance(tick * TICK)
        bodies = world.own.bank._scene.cylinders
        person = int(np.argmax(world.own.bank._scene.present))
        left, right = bodies[3 * person, :2], bodies[3 * person + 1, :2]
        seen.append(math.dist(left, right))
    assert max(seen) - min(seen) > 0.05
    assert min(seen) == pytest.approx(0.9 * 0.191 * 1.7, abs=0.05)
