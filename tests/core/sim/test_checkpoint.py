"""What runs lives in the context: all sensors and all noise on, a planner that uses everything."""

from __future__ import annotations

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.plugin import Command, Observation
from tests.core.sim.sim_worlds import Rig, rig, scenario

pytestmark = pytest.mark.slow

SENSORS = {
    "camera": "{kind: rgbd_camera, width: 64, height: 48, rate: 8, noise: 0.0014,"
    " resolution: 0.001, dropout: 0.05, mount: {x: -0.087, z: 0.287}}",
    "imu": "{kind: imu, rate: 64, gyro_bias: 0.01, gyro_walk: 0.01, force_bias: 0.1,"
    " force_walk: 0.1, mount: {x: 0.056, y: 0.062, z: 0.0202}}",
    "bumper": "{kind: bumper}",
    "tracker": "{kind: people_tracker, miss: 0.1, position_noise: 0.05, velocity_noise: 0.05}",
    "sonar": "{kind: ultrasound, rate: 16, bits: 8, dropout: 0.05, noise: {error: {kind: gaussian,"
    " std: 0.01}, spikes: {kind: peak, probability: 0.1}}, mount: {x: 0.17, z: 0.15}}",
    "eye": "{kind: infrared, rate: 32, noise: {error: {kind: gaussian, std: 0.02}, bias:"
    " {kind: offset, value: 0.01}}, mount: {x: 0.17, z: 0.2, yaw: 0.5}}",
    "odometry": "{kind: wheel_odometry, noise: 0.05, heading: gyro}",
}
WORLD = tuple(f"robots.robot.sensors.{n}={text}" for n, text in SENSORS.items())
ALL = ("front_lidar", "rear_lidar", *SENSORS)


class ByEverything:
    """Steers by every sensor, so that a bit that differs anywhere soon differs everywhere."""

    def __init__(self) -> None:
        self.seen: list[Observation] = []

    def reset(self, task: object, limits: object, sensors: object, seed: int) -> None:
        pass

    def step(self, obs: Observation) -> Command:
        self.seen.append(obs)
        assert set(obs.readings) == set(ALL)
        total = 0.0
        for reading in obs.readings.values():
            values = np.asarray(reading.values, np.float64)
            total += float(np.where(np.isfinite(values), values, 0.0).mean())
        return Command(0.3 + 0.1 * np.sin(total + obs.t), 0.5 * np.cos(100.0 * total))


class ByTime(ByEverything):
    """Steers by none of them."""

    def step(self, obs: Observation) -> Command:
        self.seen.append(obs)
        return Command(0.3, 0.5 * np.cos(obs.t))


def _rig() -> tuple[Rig, ByEverything]:
    planner = ByEverything()
    return rig(scenario(*WORLD), planner, sensors=ALL), planner


def test_one_advance_equals_many() -> None:
    one, planner = _rig()
    one.advance(1.5)
    many, _ = _rig()
    for k in range(1, 101):
        many.advance(1.5 * k / 100)
    assert one.everything() == many.everything()
    images = [obs.readings["camera"] for obs in planner.seen]
    assert {(r.values.shape, r.values.dtype.name) for r in images} == {((48, 64), "float32")}
    assert [r.stamp for r in images] == [n // 2 / 8.0 for n in range(24)]
    assert len({r.values.tobytes() for r in images}) == 12
    # What is recorded is what the planner gets, rounded.
    assert [p.stamp for p in one.memory.frames["camera"]] == [n / 8.0 for n in range(12)]
    for frame, reading in zip(one.memory.frames["camera"], images[::2], strict=True):
        np.testing.assert_array_equal(frame.depth_mm, depth_mm(reading.values))


def test_a_clone_goes_on_bit_by_bit() -> None:
    """Cloned between two images: the resumed planner's next step must see the older one."""
    whole, planner = _rig()
    whole.advance(1.14)
    clone = whole.context.Clone()
    steps = len(planner.seen)
    whole.advance(2.0)

    end, rest = whole.everything(), planner.seen[steps:]
    assert rest[0].readings["camera"].stamp == 1.125

    planner.seen = []
    whole.simulator = Simulator(whole.blocks.diagram, clone)
    whole.advance(2.0)
    assert whole.everything() == end
    assert [obs.t for obs in planner.seen] == [obs.t for obs in rest]
    for mine, theirs in zip(planner.seen, rest, strict=True):
        for name in ALL:
            assert mine.readings[name].stamp == theirs.readings[name].stamp
            assert mine.readings[name].values.tobytes() == theirs.readings[name].values.tobytes()


def test_looking_at_images_changes_nothing_else() -> None:
    """An image that a planner asks for is made from what was kept, not from the world."""
    found = []
    for sensors in (ALL, ALL[:2]):
        exact = "robots.robot.sensors.camera.noise=0"
        planner = ByTime()
        run = rig(scenario(*WORLD, exact), planner, sensors=ALL, visible=sensors)
        run.advance(1.5)
        assert set(planner.seen[-1].readings) == set(sensors)
        found.append((run.everything(), run.memory))
    (state, memory), (other_state, other_memory) = found
    assert state == other_state
    for name, readings in memory.readings.items():
        for mine, theirs in zip(readings, other_memory.readings[name], strict=True):
            assert mine.values.tobytes() == theirs.values.tobytes()
    images = zip(memory.frames["camera"], other_memory.frames["camera"], strict=True)
    assert all(a.depth_mm.tobytes() == b.depth_mm.tobytes() for a, b in images)


def test_images_need_no_recording() -> None:
    """A planner gets the same images where none are recorded."""
    planners = ByEverything(), ByEverything()
    runs = [rig(scenario(*WORLD), p, sensors=ALL, images=p is planners[0]) for p in planners]
    for run in runs:
        run.advance(0.5)
    assert runs[0].everything() == runs[1].everything()
    assert (len(runs[0].memory.frames["camera"]), runs[1].memory.frames) == (4, {})


def test_images_are_not_part_of_the_state() -> None:
    small, _ = _rig()
    size = len(small.everything())
    large = rig(
        scenario(*WORLD, "robots.robot.sensors.camera.width=640"), ByEverything(), sensors=ALL
    )
    assert len(large.everything()) == size
