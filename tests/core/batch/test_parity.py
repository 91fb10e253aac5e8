"""Worlds of a batch move exactly as the full simulation with kinematic control."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.api import registry
from crowdbot.core.batch.array_tables import ScratchPool
from crowdbot.core.batch.batch import Batch
from crowdbot.core.batch.blueprint import blueprint
from crowdbot.core.batch.parallel import Batches
from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.support.ticks import TICK
from crowdbot.errors import InputError

KINEMATIC = "robots.robot.control=kinematic"
CHALLENGE = ("challenge-2020", "counter-d0500-dispersed-c20-r05")
FEW = "crowd.flow.density=0.05"
SURE = [
    f"robots.robot.sensors.{name}_lidar.noise.range={{kind: offset, value: 1 cm}}"
    for name in ("front", "rear")
]
CAFE = Path(__file__).parents[3] / "scenario_specs/examples/cafe_crossing.yaml"


def commands(count: int, robots: int = 1) -> Any:
    """Commands (T, R, 3) that change every half second, some backwards."""
    rng = np.random.default_rng(7)
    drawn = rng.uniform([-0.2, -1.2, 0.0], [0.9, 1.2, 1e-9], (count // 8 + 1, robots, 3))
    return drawn.repeat(8, axis=0)[:count]


def compare(scenario: crowdbot.Scenario, seconds: float, lidars: list[str]) -> dict[str, float]:
    """Largest differences between a batch of one world and a session, m; and readings compared."""
    world = BatchWorld(blueprint(scenario, registry(), lidars), None)
    batch, found = Batch([world], [0]), {"robot": 0.0, "people": 0.0, "ranges": 0.0, "read": 0.0}
    session = crowdbot.Session(scenario, sensors=lidars, privileged=True)
    names = list(session.robots)
    with session:
        seen = session.reset_all()
        for now in commands(round(seconds * 16), len(names)):
            for r, name in enumerate(names):
                truth = seen[name].truth
                assert truth is not None
                found["robot"] = max(
                    found["robot"], *np.abs(world.robots[r, [0, 1, 6]] - truth.pose).tolist()
                )
                people = truth.people[truth.people_id >= 0]
                rows = world.rows()
                rows = rows[rows[:, s.WAITING] == s.PRESENT]
                assert len(rows) == len(people)
                # The session shows people after this tick's update, a tick ahead.
                ahead = rows[:, s.X : s.Y + 1] + TICK * rows[:, s.VX : s.VY + 1]
                away = np.abs(people - ahead).max(initial=0.0, axis=1)
                found["people"] = max(found["people"], away[away < 5.0].max(initial=0.0))
                for place, sensor in enumerate(world.blueprint.sensors):
                    if sensor.robot == r:
                        there = seen[name].readings[sensor.name].values
                        mine = world.scanners[place].arrays["ranges"].reshape(there.shape)
                        assert np.array_equal(np.isfinite(there), np.isfinite(mine))
                        both = np.isfinite(there)
                        away = np.abs(there[both] - mine[both])
                        found["ranges"] = max(found["ranges"], away.max(initial=0.0))
                        found["read"] += int(both.sum())
            given = {name: tuple(now[r, :2]) for r, name in enumerate(names)}
            seen = session.step_all(given)
            batch.step(now[None] * [1.0, 1.0, 0.0])
    return found


def test_a_crowd_of_the_challenge_robot_people_and_lidars() -> None:
    scenario = crowdbot.load(*CHALLENGE, set=[KINEMATIC, FEW, *SURE])
    found = compare(scenario, 6.0, ["front_lidar", "rear_lidar"])
    assert found["robot"] == 0.0
    assert found["people"] < 1e-3  # what a person's acceleration does in a tick
    assert found["ranges"] < 1e-9
    assert found["read"] > 10_000


def test_a_robot_that_is_not_round_at_a_wall() -> None:
    wheelchair = next(s.id for s in crowdbot.expand("challenge-2020-robots") if "wheel" in s.id)
    scenario = crowdbot.load("challenge-2020-robots", wheelchair, set=[KINEMATIC, "crowd=null"])
    assert compare(scenario, 5.0, [])["robot"] < 1e-9


def test_people_who_find_their_way_decide_outside_of_compiled_code_but_alike() -> None:
    (scenario,) = crowdbot.expand(CAFE, set=[KINEMATIC])
    world = BatchWorld(blueprint(scenario, registry(), []), None)
    assert not world.compiled
    found = compare(scenario, 2.0, [])
    assert found["robot"] == 0.0
    assert found["people"] < 2e-3


def states(worlds: list[BatchWorld], steps: int) -> list[Any]:
    """The state of each world after some steps."""
    batch = Batch(worlds, list(range(len(worlds))))
    for now in commands(steps):
        batch.step(np.repeat(now[None], len(worlds), axis=0))
    return [np.concatenate([w.flat, w.robots.ravel()]) for w in worlds]


def test_worlds_of_any_size_in_any_order_do_not_depend_on_each_other() -> None:
    small = blueprint(crowdbot.load(*CHALLENGE, set=[FEW]), registry(), [])
    large = blueprint(crowdbot.load(*CHALLENGE, set="crowd.flow.density=0.1"), registry(), [])
    plans = [(small, 1), (large, 2), (small, 3)]
    pool = ScratchPool()
    together = states([BatchWorld(plan, root, pool) for plan, root in plans], 24)
    alone = [states([BatchWorld(plan, root)], 24)[0] for plan, root in plans]
    for one, other in zip(together, alone, strict=True):
        assert np.array_equal(one, other)
    assert not np.array_equal(together[0], together[2])


def test_people_shown_after_a_step_are_those_of_the_world_in_any_thread() -> None:
    pools = [ScratchPool(), ScratchPool()]
    plan = blueprint(crowdbot.load(*CHALLENGE, set=[KINEMATIC, FEW]), registry(), [])
    worlds = [BatchWorld(plan, root, pool) for root, pool in enumerate((*pools, pools[1]))]
    batches = Batches(worlds, [0, 1, 2], [(0, 1), (1, 3)])
    shown, asked = np.zeros((2, 3, worlds[0].people + 2, 5))
    batches.show_people(shown)
    for which in ([0, 1, 2], [0, 2], [1]):
        batches.step(np.full((3, 1, 3), np.nan), np.array(which))
        batches.people(asked)
        assert np.array_equal(shown, asked, equal_nan=True)
    assert np.isfinite(shown[0]).any()
    assert np.isnan(shown[:, -2:]).all()
    assert np.isnan(batches.commands[:, 0, 0]).all()  # not taken for a limit
    batches.close()


def test_a_world_begins_again_as_it_began() -> None:
    plan = blueprint(crowdbot.load(*CHALLENGE, set=FEW), registry(), ["front_lidar"])
    world = BatchWorld(plan, 5)
    batch = Batch([world], [3])
    first = world.scanners[0].arrays["ranges"].copy()
    runs = []
    for _ in range(2):
        for now in commands(16):
            batch.step(now[None])
        runs.append(np.concatenate([world.flat, world.scanners[0].arrays["ranges"].ravel()]))
        batch.put(0, world, 3)
        assert np.array_equal(world.scanners[0].arrays["ranges"], first)
    assert np.array_equal(runs[0], runs[1])


#: Sensors that are not cast in compiled code; noise and errors draw the numbers of a run's seed.
OTHERS = {
    "tilted": "{kind: lidar2d, rate: 16 Hz, mount: {z: 0.4 m, pitch: 10 deg}, angle_step: 4 deg}",
    "erring": "{kind: lidar2d, rate: 8 Hz, angle_step: 5 deg, noise: 1 cm, dropout: 0.1, "
    "mount: {z: 0.3 m}, errors: {a: {kind: gaussian, std: 0.1}}}",
    "uneven": "{kind: lidar2d, rate: 10 Hz, angle_step: 5 deg, mount: {z: 0.3 m, roll: 5 deg}}",
    "layers": "{kind: lidar3d, rate: 8 Hz, mount: {z: 0.5 m, pitch: -4 deg}, angle_step: 6 deg}",
    "infrared": "{kind: infrared, rate: 16 Hz, range_max: 9 m, mount: {z: 0.3 m, yaw: 90 deg}}",
    "sonar": "{kind: ultrasound, rate: 8 Hz, range_max: 4 m, mount: {z: 0.3 m, pitch: 5 deg}}",
    "depth": "{kind: rgbd_camera, width: 32, height: 24, noise: 0.0014, mount: {z: 0.4 m}}",
    "slanted": "{kind: rgbd_camera, width: 16, height: 12, mount: {z: 0.4 m, pitch: 15 deg}}",
}


def with_others() -> crowdbot.Scenario:
    """The challenge with few people and sensors of many kinds."""
    added = [f"robots.robot.sensors.{name}={text}" for name, text in OTHERS.items()]
    return crowdbot.load(*CHALLENGE, set=[KINEMATIC, "crowd.flow.density=0.15", *added])


@pytest.mark.parametrize("sensor", ["us0", "us7", *OTHERS])
def test_any_other_sensor_of_distances_reads_what_it_reads_in_a_run(sensor: str) -> None:
    found = compare(with_others(), 2.0, [sensor])
    assert found["robot"] == 0.0
    assert found["read"] > 0
    assert found["ranges"] < 1e-9


def test_sensors_of_all_kinds_are_read_side_by_side_in_worlds_of_several_threads() -> None:
    plan = blueprint(with_others(), registry(), ["front_lidar", *OTHERS, "rear_lidar"])
    pools = [ScratchPool(), ScratchPool()]
    worlds = [BatchWorld(plan, root, pool) for root, pool in enumerate(pools)]
    both, alone = Batches(worlds, [4, 5], [(0, 1), (1, 2)]), BatchWorld(plan, 1)
    one = Batch([alone], [5])
    for now in commands(20):
        both.step(now[None].repeat(2, axis=0), np.arange(2))
        one.step(now[None])
    both.close()
    for mine, other in zip(alone.scanners, worlds[1].scanners, strict=True):
        assert np.array_equal(mine.arrays["ranges"], other.arrays["ranges"])
    assert sum(np.isfinite(s.arrays["ranges"]).any() for s in alone.scanners) >= 8
    assert not np.array_equal(
        worlds[0].scanners[2].arrays["ranges"], worlds[1].scanners[2].arrays["ranges"]
    )


def test_a_sensor_that_batches_cannot_simulate_is_named() -> None:
    colour = "robots.robot.sensors.camera.colour=true"
    scenario = crowdbot.load(*CHALLENGE, set=colour)
    with pytest.raises(InputError, match=r"sensor 'imu' .*kind 'imu'.*sensors of distances"):
        blueprint(scenario, registry(), ["imu"])
    with pytest.raises(InputError, match=r"sensor 'camera' .*takes colour images"):
        blueprint(scenario, registry(), ["camera"])
    with pytest.raises(InputError, match=r"no sensor 'radar'; it has 'camera'"):
        blueprint(scenario, registry(), ["radar"])


def test_with_dynamic_control_the_robot_stays_within_5_cm_for_20_s() -> None:
    """The same commands without contact: wheels and motors against exact arcs."""
    scenario = crowdbot.load(*CHALLENGE, set="crowd.flow.density=0.02")
    world = BatchWorld(blueprint(scenario, registry(), []), None)
    batch, rng = Batch([world], [0]), np.random.default_rng(3)
    drawn = rng.uniform([0.0, -0.8], [0.5, 0.8], (20, 2)).repeat(16, axis=0)
    away, people = [], []
    with crowdbot.Session(scenario, sensors=[], privileged=True) as session:
        truth = session.reset().truth
        for v, w in drawn.tolist():
            truth = session.step((v, w)).truth
            batch.step(np.array([[[v, w, 0.0]]]))
            assert truth is not None
            assert batch.drive("touched")[0, 0] == 0.0
            away.append(np.hypot(*(np.array(truth.pose[:2]) - world.robots[0, :2])))
            rows = world.rows()[world.rows()[:, s.WAITING] == s.PRESENT]
            ahead = rows[:, s.X : s.Y + 1] + TICK * rows[:, s.VX : s.VY + 1]
            off = np.hypot(*(truth.people - ahead).T)
            people.append(off[off < 5.0].mean())
    assert max(away) < 0.05  # 5 mm when this was written
    assert np.mean(people) < 0.01  # 3 micrometres when this was written
