"""Noise generators and sensors that are wrong, each found by the check that is for it."""
# ruff: noqa: ARG002, ARG005 - the signatures are fixed

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.sensing.scene import Scene
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec
from crowdbot.plugin import Pose, SensorInfo, SensorMessage
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec
from crowdbot.plugins.sensors.lidar2d_build import build as lidar2d
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import RgbdCamera
from crowdbot.testing import noise, sensor
from crowdbot.testing.checks import checks_in
from crowdbot.testing.sensor_scenes import context
from tests.testing.wrong import BUILT_IN, WrongNoise, WrongSensor, assert_fails, made

Array = NDArray[np.float64]


# ------------------------------------------------------------------------------- noise
def generator(errors: Callable[[Array, np.random.Generator], Any], random: bool = True) -> Any:
    class Noise:
        def __init__(self) -> None:
            self.random = random

        def errors(self, distance: Array, rng: np.random.Generator) -> Any:
            return errors(distance, rng)

    return made(WrongNoise, lambda spec: Noise())


def _hits_only(distance: Array, rng: np.random.Generator) -> Array:
    found = np.zeros(len(distance))
    hit = np.isfinite(distance)
    found[hit] = rng.standard_normal(int(hit.sum()))
    return found


def _in_place(distance: Array, rng: np.random.Generator) -> Array:
    distance += rng.standard_normal(len(distance))
    return np.zeros(len(distance))


def _relative(distance: Array, rng: np.random.Generator) -> Array:
    with np.errstate(invalid="ignore"):
        return distance * 0.01 * rng.standard_normal(len(distance))


@pytest.mark.parametrize(
    ("check", "errors", "random", "because"),
    [
        (noise.check_errors_are_numbers, _relative, True, "inf"),
        (noise.check_errors_are_numbers, lambda d, rng: rng.normal(), True, "float"),
        (noise.check_distances_are_unchanged, _in_place, True, "changed"),
        (noise.check_draws_do_not_depend_on_distances, _hits_only, True, "depends"),
        (noise.check_random_says_whether_it_draws, lambda d, rng: 0.0 * d, True, "drawn: False"),
        (
            noise.check_random_says_whether_it_draws,
            lambda d, rng: rng.standard_normal(len(d)),
            False,
            "drawn: True",
        ),
        (
            noise.check_equal_draws_give_equal_errors,
            lambda d, rng: np.random.default_rng().standard_normal(len(d)),
            True,
            "another error",
        ),
    ],
)
def test_noise(check: Any, errors: Any, random: bool, because: str) -> None:
    with np.errstate(invalid="ignore"):
        assert_fails(check, generator(errors, random), because)


# ----------------------------------------------------------------------------- sensors
INFO = SensorInfo(
    category="nose",
    frame="nose",
    mount=(0.0, 0.0, 0.3, 0.0),
    rate=8.0,
    shape=(1,),
    ros_type="std_msgs/msg/Float64MultiArray",
    random=False,
)


class Nose:
    """Distance to the nearest person; sound but for what a test changes."""

    def __init__(self, info: SensorInfo) -> None:
        self._info, self.count, self.kept = info, 0, np.zeros(1)

    def info(self) -> SensorInfo:
        return self._info

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, *memory: Array
    ) -> Any:
        away = np.hypot(*(scene.people[:, :2] - [pose.x, pose.y]).T)[scene.present]
        return np.array([away.min(initial=100.0)])


class Restless(Nose):
    def info(self) -> SensorInfo:
        self.count += 1
        return replace(self._info, rate=float(self.count))


class Wordy(Nose):
    def read(self, *given: Any) -> Any:
        return np.zeros(3)


class Nan(Nose):
    def read(self, *given: Any) -> Any:
        return super().read(*given) * np.nan


class Lazy(Nose):
    def read(self, *given: Any) -> Any:
        self.kept[:] = super().read(*given)
        return self.kept


class Shaky(Nose):
    def read(self, *given: Any) -> Any:
        return super().read(*given) + np.random.default_rng().normal()


class Drawing(Nose):
    def read(self, *given: Any) -> Any:
        return super().read(*given) + given[3].normal()


class Counting(Nose):
    def read(self, *given: Any) -> Any:
        self.count += 1
        return super().read(*given) + self.count


class Near(Nose):
    def read(self, scene: Scene, *given: Any) -> Any:
        robot = scene.robot
        return np.array([0.17 if robot is not None else np.inf])


def made_sensor(kind: type[Nose], **changes: Any) -> Any:
    return made(WrongSensor, lambda spec, context: kind(replace(INFO, **changes)))


@pytest.mark.parametrize(
    ("check", "kind", "changes", "because"),
    [
        (sensor.check_info, Restless, {}, "info\\(\\) changes"),
        (sensor.check_info, Nose, {"rate": 200.0}, "200.0 Hz"),
        (sensor.check_info, Nose, {"ros_type": "LaserScan"}, "not a ROS type"),
        (sensor.check_info, Nose, {"category": "lidar"}, "without angles"),
        (sensor.check_reading_is_numbers, Wordy, {}, r"\(3,\)"),
        (sensor.check_reading_is_numbers, Nan, {}, "NaN"),
        (sensor.check_readings_are_new, Lazy, {}, "changed an earlier one"),
        (sensor.check_equal_draws_give_equal_readings, Shaky, {}, "differs"),
        (sensor.check_random_says_whether_it_draws, Drawing, {}, "drawn: True"),
        (sensor.check_random_says_whether_it_draws, Nose, {"random": True}, "drawn: False"),
        (sensor.check_memory_is_all_it_keeps, Counting, {}, "not in the memory"),
        (sensor.check_memory_is_all_it_keeps, Counting, {"memory": 1}, "not in the memory"),
        (sensor.check_sees_people, Nose, {"sees": False}, "changes readings: True"),
        (sensor.check_sees_people, Near, {}, "changes readings: False"),
        (sensor.check_distances_are_true, Near, {"category": "ultrasound"}, "0.17 m"),
    ],
)
def test_sensors(check: Any, kind: type[Nose], changes: dict[str, Any], because: str) -> None:
    assert_fails(check, made_sensor(kind, **changes), because)


def test_messages_that_are_not_of_the_sensors_type() -> None:
    kind = {"ros_type": "sensor_msgs/msg/Temperature"}
    for fields, because in (
        (lambda values: {"temperature": values[0]}, "missing or unknown: \\['variance'\\]"),
        (lambda values: {"temperature": "warm", "variance": 0.0}, "could not convert"),
    ):
        wrong = made_sensor(Nose, message=SensorMessage(fields=fields), **kind)
        assert_fails(sensor.check_message_has_its_type, wrong, because)
    sound = SensorMessage(fields=lambda values: {"temperature": values[0], "variance": 0.0})
    sensor.check_message_has_its_type(made_sensor(Nose, message=sound, **kind), BUILT_IN)


def test_a_sound_sensor_passes() -> None:
    for check in checks_in(sensor):
        check(made_sensor(Nose), BUILT_IN)


class WrongLidarSpec(Lidar2dSpec):
    """A lidar."""

    kind: Literal["acme.lidar"] = "acme.lidar"  # type: ignore[assignment]


class Noisy:
    """A lidar that draws although no noise is wanted."""

    def __init__(self, spec: RangeSensorSpec) -> None:
        self._lidar = lidar2d(spec, [], context())

    def info(self) -> SensorInfo:
        return replace(self._lidar.info(), random=True)

    def read(self, *given: Any) -> Any:
        return self._lidar.read(*given) + given[3].normal()


def test_a_lidar_that_is_never_exact() -> None:
    component = made(WrongLidarSpec, lambda spec, generators, context: Noisy(spec))
    assert_fails(sensor.check_exact_without_noise, component, "without noise")


class WrongCameraSpec(RgbdCameraSpec):
    """A camera."""

    kind: Literal["acme.camera"] = "acme.camera"  # type: ignore[assignment]


KEPT = np.zeros((240, 320), np.uint16)


def same_place(image: NDArray[np.uint16]) -> NDArray[np.uint16]:
    KEPT[:] = image
    return KEPT


@pytest.mark.parametrize(
    ("change", "because"),
    [
        (lambda image: image, None),
        (same_place, "an earlier one's place"),
        (lambda image: image + np.uint16(image > 0), "not those of the reading"),
        (lambda image: image.T, "shape"),
        (lambda image: image.astype(np.int64), "int64"),
    ],
)
def test_a_camera_with_other_millimetres(change: Any, because: str | None) -> None:
    class Turned(RgbdCamera):
        def depth_mm(self, *given: Any) -> Any:
            return change(super().depth_mm(*given))

    component = made(WrongCameraSpec, lambda spec, context: Turned(spec))
    check = sensor.check_millimetres_are_the_reading
    if because:
        assert_fails(check, component, because)
    else:
        check(component, BUILT_IN)


def test_a_lidar_that_looks_to_the_other_side() -> None:
    class Turned(Noisy):
        def read(self, *given: Any) -> Any:
            scene, pose, *rest = given
            return self._lidar.read(scene, Pose(pose.x + 2.0, pose.y, pose.yaw), *rest)

    component = made(WrongLidarSpec, lambda spec, generators, context: Turned(spec))
    assert_fails(sensor.check_distances_are_true, component, "a person whose centre is")
