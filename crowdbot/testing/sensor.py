"""Checks for every sensor."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Iterator
from dataclasses import fields, replace
from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.sensor_messages import message_kind
from crowdbot.core.registry.registry import Registry
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.sensor import DepthCamera
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec
from crowdbot.errors import PluginError
from crowdbot.testing.around import around, built, specs_of
from crowdbot.testing.sensor_scenes import (
    POSES,
    context,
    crowded,
    empty,
    in_front,
    pose_of,
    robot_at,
)

_ROS_TYPE = re.compile(r"[a-z][a-z0-9_]*/msg/[A-Z][A-Za-z0-9]*")
#: Categories that measure distances, with inf for no hit.
_DISTANCES = ("infrared", "lidar", "ultrasound")


class Probe:
    """A sensor to be read repeatedly, with its memory array, which a simulation would keep."""

    def __init__(self, sensor: Any) -> None:
        self.sensor, self.info = sensor, sensor.info()
        self.memory = np.zeros(self.info.memory)

    def __call__(self, scene: Scene, k: int, rng: np.random.Generator | None = None) -> Array:
        """Return reading ``k`` of a drive, with the robot at ``POSES[k]``."""
        rng = rng or sensor_rng(0, "robot", "sensor", k)
        args = (scene, pose_of(k), k / self.info.rate, rng)
        if self.info.memory:
            return np.asarray(self.sensor.read(*args, self.memory))
        return np.asarray(self.sensor.read(*args))


def check_info(component: Component[Any], registry: Registry | None = None) -> None:
    """``info`` is constant and valid: rate, shape, ranges, mount, ROS type.

    If this fails, create `SensorInfo` once, in the constructor. A rate is above 0 and at most 128
    Hz, a ROS type is like ``sensor_msgs/msg/LaserScan``, angles are those of all beams.
    """
    for sensor in _sensors(component, registry):
        info = sensor.info()
        _assert_info(info)
        assert _same_info(info, sensor.info()), "info() changes"
        before = replace(info, angles=None if info.angles is None else info.angles.copy())
        _assert_can_be_read(sensor, info)
        Probe(sensor)(crowded(), 0)
        assert _same_info(before, sensor.info()), "info() changes when the sensor is read"


def _assert_can_be_read(sensor: Any, info: SensorInfo) -> None:
    given = ("scene", "pose", "t", "rng", *(("memory",) if info.memory else ()))
    try:
        inspect.signature(sensor.read).bind(*given)
    except TypeError as error:
        raise AssertionError(
            f"info().memory is {info.memory}, so that read({', '.join(given)}) is called: {error}"
        ) from error


def check_reading_is_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """A reading has the shape ``info().shape``, is float64 (float32 for a camera), never NaN.

    If this fails, return inf, not NaN, if nothing is in range; an array of another shape cannot be
    stored.
    """
    for sensor in _sensors(component, registry):
        for name, scene in {"empty": empty(), "crowded": crowded()}.items():
            probe = Probe(sensor)
            for k in range(len(POSES)):
                _assert_reading(name, probe.info, probe(_shown(scene, k), k))


def check_readings_are_new(component: Component[Any], registry: Registry | None = None) -> None:
    """Each reading is a new array, and the scene's arrays are not written to.

    If this fails, return copies of stored arrays, and do not change the scene's arrays.
    """
    for sensor in _sensors(component, registry):
        probe, scene = Probe(sensor), crowded()
        first = probe(_shown(scene, 0), 0)
        kept, people = first.copy(), scene.people.copy()
        for k in range(1, len(POSES)):
            probe(_shown(scene, k), k)
        assert np.array_equal(first, kept), "a later reading changed an earlier one"
        assert np.array_equal(scene.people, people), "reading changed the people of the scene"


def check_equal_draws_give_equal_readings(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Two sensors with the same spec give equal readings for equal scenes and random numbers.

    If this fails, the sensor uses a generator other than ``rng``, or a clock.
    """
    pairs = zip(_sensors(component, registry), _sensors(component, registry), strict=True)
    for one, two in (tuple(map(Probe, pair)) for pair in pairs):
        scene = crowded()
        for k in range(len(POSES)):
            same = np.array_equal(one(_shown(scene, k), k), two(_shown(scene, k), k))
            assert same, f"reading {k} differs between two sensors of the same spec"


def check_random_says_whether_it_draws(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """``info().random`` is true if and only if random numbers are drawn.

    If this fails, correct ``random``: if it is false, the given generator is shared.
    """
    for sensor in _sensors(component, registry):
        drew = _draws(sensor)
        says = sensor.info().random
        assert drew == says, f"random is {says}, numbers drawn: {drew}"


def check_exact_without_noise(component: Component[Any], registry: Registry | None = None) -> None:
    """A range sensor without noise and dropouts draws no random numbers.

    If this fails, draw nothing for a noise of zero; a sensor that is random by design declares
    ``Component(exceptions={"check_exact_without_noise": "why"})``.
    """
    known = around(component, registry)
    for spec in specs_of(component, known):
        if isinstance(spec, RangeSensorSpec) and not spec.noise and not spec.dropout:
            assert not _draws(built(known, spec, context())), "draws random numbers without noise"


def check_memory_is_all_it_keeps(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A new sensor with the old one's memory continues like the old one.

    If this fails, the object keeps other state: only ``info().memory`` numbers survive.
    """
    pairs = zip(_sensors(component, registry), _sensors(component, registry), strict=True)
    for one, two in (tuple(map(Probe, pair)) for pair in pairs):
        scene, half = crowded(), len(POSES) // 2
        for k in range(half):
            one(_shown(scene, k), k)
        two.memory[:] = one.memory
        for k in range(half, len(POSES)):
            same = np.array_equal(one(_shown(scene, k), k), two(_shown(scene, k), k))
            assert same, f"reading {k} depends on something that is not in the memory"


def check_sees_people(component: Component[Any], registry: Registry | None = None) -> None:
    """``info().sees`` is true if and only if a person in front of the robot changes a reading.

    If this fails, correct ``sees``: if it is false, the scene's people are out of date.
    """
    for sensor in _sensors(component, registry):
        info = sensor.info()
        alone = Probe(sensor)(empty(), 0)
        changed = any(
            not np.array_equal(alone, Probe(sensor)(scene, 0))
            for scenes in in_front(info).values()
            for scene in scenes
        )
        assert changed == info.sees, f"sees is {info.sees}; a person changes readings: {changed}"


def check_distances_are_true(component: Component[Any], registry: Registry | None = None) -> None:
    """A range sensor reads inf in an empty world, else the distance of a person in front.

    If this fails, the sensor sees the robot itself, or measures to somewhere else. Categories are
    ``lidar``, ``ultrasound`` and ``infrared``; others are not looked at.
    """
    for sensor in _sensors(component, registry):
        info = sensor.info()
        if info.category not in _DISTANCES:
            continue
        alone = Probe(sensor)(empty(), 0)
        assert np.all(np.isinf(alone)), f"in an empty world the nearest thing is {alone.min()} m"
        for distance, scenes in in_front(info).items():
            if not info.range_min + 0.6 < distance < info.range_max - 0.5:
                continue
            nearest = min(float(Probe(sensor)(scene, 0).min()) for scene in scenes)
            assert abs(nearest - distance) < 0.6, (
                f"a person whose centre is {distance:.2f} m ahead reads {nearest:.2f} m"
            )


def check_millimetres_are_the_reading(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A camera's ``depth_mm`` is its reading, rounded, for equal random numbers.

    If this fails, recordings differ from the planners' readings. Whole millimetres are rounded to
    even; missing values, and those beyond 65.535 m, are 0. Each image is a new array.
    """
    for sensor in _sensors(component, registry):
        rate = sensor.info().rate
        if not isinstance(sensor, DepthCamera):
            continue
        earlier = np.zeros(0, np.uint16)
        for scene in (empty(), crowded()):
            for k in range(len(POSES)):
                reading = Probe(sensor)(_shown(scene, k), k)
                given = pose_of(k), k / rate, sensor_rng(0, "robot", "sensor", k)
                image = np.asarray(sensor.depth_mm(scene, *given))
                assert image.dtype == np.uint16, f"depth_mm() returned {image.dtype}"
                assert image.shape == reading.shape, f"shape {image.shape}, not {reading.shape}"
                other = int(np.count_nonzero(image != depth_mm(reading)))
                assert not other, f"{other} of {image.size} pixels are not those of the reading"
                assert not np.shares_memory(image, earlier), "an image takes an earlier one's place"
                earlier = image


def check_message_has_its_type(component: Component[Any], registry: Registry | None = None) -> None:
    """Readings of a sensor with its own ``message`` become messages of ``info().ros_type``.

    If this fails, return every field of the type from ``SensorMessage.fields``, and put the texts
    of types that ROS 2 Humble lacks into ``definitions``.
    """
    for sensor in _sensors(component, registry):
        info = sensor.info()
        if info.message is None:
            continue
        try:
            msgtype, kind = message_kind(info)
            data = kind.encoder(info, "")(10**9, Probe(sensor)(crowded(), 0))
        except PluginError as error:
            raise AssertionError(str(error)) from error
        header = getattr(ros.from_cdr(data, msgtype), "header", None)
        if header is not None:
            assert header.frame_id, "the header of its message has no frame"


def _sensors(component: Component[Any], registry: Registry | None) -> Iterator[Any]:
    known = around(component, registry)
    for spec in specs_of(component, known):
        yield built(known, spec, context())


def _draws(sensor: Any) -> bool:
    """Return True if the sensor draws random numbers in any reading of a drive."""
    probe, scene, drew = Probe(sensor), crowded(), False
    for k in range(len(POSES)):
        rng, untouched = (sensor_rng(0, "robot", "sensor", k) for _ in range(2))
        probe(_shown(scene, k), k, rng)
        drew = drew or repr(rng.bit_generator.state) != repr(untouched.bit_generator.state)
    return drew


def _shown(scene: Scene, k: int) -> Scene:
    """Return the scene with the robot at its pose of reading k."""
    scene.move_robot(robot_at(k))
    return scene


def _assert_info(info: SensorInfo) -> None:
    assert isinstance(info, SensorInfo), f"info() is a {type(info).__name__}"
    assert info.category.strip(), "no category"
    assert 0.0 < info.rate <= 128.0, f"the rate is {info.rate} Hz"
    assert all(isinstance(n, int) and n > 0 for n in info.shape), f"the shape is {info.shape}"
    assert len(info.mount) == 4, f"the mount is {info.mount}"
    assert all(math.isfinite(x) for x in info.mount), f"the mount is {info.mount}"
    assert len(info.tilt) == 2, f"the tilt is {info.tilt}"
    assert all(math.isfinite(x) for x in info.tilt), f"the tilt is {info.tilt}"
    assert 0.0 <= info.range_min <= info.range_max, f"{info.range_min} to {info.range_max} m"
    assert _ROS_TYPE.fullmatch(info.ros_type), f"'{info.ros_type}' is not a ROS type"
    assert isinstance(info.memory, int), f"memory is {info.memory}"
    assert info.memory >= 0, f"memory is {info.memory}"
    if info.angles is not None:
        assert np.all(np.isfinite(info.angles)), "angles are not finite"
    if info.category == "lidar":
        assert info.angles is not None, "a lidar without angles"
        assert info.angles.shape == info.shape, f"{info.angles.shape} angles for {info.shape}"
    if info.camera is not None:
        assert info.shape == (info.camera.height, info.camera.width), f"shape {info.shape}"
        assert info.memory == 0, "a camera has no memory"


def _same_info(one: SensorInfo, two: SensorInfo) -> bool:
    pairs = [(getattr(one, f.name), getattr(two, f.name)) for f in fields(SensorInfo)]
    return all(np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b for a, b in pairs)


def _assert_reading(name: str, info: SensorInfo, values: Array) -> None:
    dtype = np.float32 if info.camera is not None else np.float64
    assert values.dtype == dtype, f"{name}: returned {values.dtype}"
    assert values.shape == info.shape, f"{name}: {values.shape}, info says {info.shape}"
    assert not np.any(np.isnan(values)), f"{name}: {np.count_nonzero(np.isnan(values))} are NaN"
