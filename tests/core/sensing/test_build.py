"""Cameras of third parties that have whole millimetres are checked like all sensors."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import discover
from crowdbot.core.sensing.build import CheckedCamera, CheckedSensor, build_sensor, checked_sensor
from crowdbot.errors import PluginError
from crowdbot.plugin import DepthCamera, SensorInfo, SensorMessage, SensorSpec
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import RgbdCamera
from crowdbot.testing.sensor_scenes import context

REGISTRY = discover(allow=())
GIVEN: Any = ("scene", "pose", 0.125, "rng")


class Camera(RgbdCamera):
    """Returns what it is told to, or raises it."""

    answer: Any = None

    def depth_mm(self, *given: Any) -> Any:
        assert given == GIVEN
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


CALL = PluginCall("sensor 'acme.camera' (acme 1.0)")


def checked(answer: Any) -> CheckedCamera:
    camera = Camera(RgbdCameraSpec(width=3, height=2))
    camera.answer = answer
    return CheckedCamera(camera, camera.info(), CALL)


def test_sound_images_go_through() -> None:
    image = np.full((2, 3), 700, np.uint16)
    camera = checked(image)
    assert isinstance(camera, DepthCamera)
    kept = camera.depth_mm(*GIVEN)
    np.testing.assert_array_equal(kept, image)
    image[:] = 0  # a camera that uses its memory again
    assert np.all(kept == 700)
    assert not isinstance(CheckedSensor(camera, camera.info(), CALL), DepthCamera)


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        (np.zeros((3, 2), np.uint16), r"returned uint16 \(3, 2\), not uint16 \(2, 3\)"),
        (np.zeros((2, 3)), r"returned float64 \(2, 3\)"),
        (None, r"returned NoneType \(\)"),
        (
            ValueError("fog"),
            r"'acme.camera' \(acme 1.0\): depth_mm at t = 0.125 s: ValueError: fog",
        ),
    ],
)
def test_others_are_an_error(answer: Any, expected: str) -> None:
    with pytest.raises(PluginError, match=expected):
        checked(answer).depth_mm(*GIVEN)


@pytest.mark.parametrize("kind", sorted(REGISTRY.components("sensor")))
def test_built_in_sensors_are_checked_as_well(kind: str) -> None:
    spec = cast(SensorSpec, REGISTRY.spec_model("sensor", kind)(kind=kind))
    sensor = build_sensor(REGISTRY, spec, context())
    assert isinstance(sensor, CheckedSensor)
    camera = sensor.info().camera is not None
    assert isinstance(sensor, CheckedCamera) == camera


class Beam:
    """Returns what it is told to."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def info(self) -> SensorInfo:
        return SensorInfo(
            category="beam", frame="beam", mount=(0.0, 0.0, 0.0, 0.0), rate=8.0, shape=(2,),
            ros_type="std_msgs/msg/Float64MultiArray", memory=1, random=False,
        )  # fmt: skip

    def read(self, *given: Any) -> Any:
        given[-1][0] = self.answer[0]
        return self.answer[1]


@pytest.mark.parametrize(
    "values", [[1.0, 2.0], [np.inf, -np.inf], [1e200, -1e200], np.arange(4.0)[::2], [1, 2]]
)
def test_sound_readings_go_through(values: Any) -> None:
    sensor: Any = checked_sensor(Beam((0.0, values)), CALL)
    found = sensor.read(*GIVEN, np.zeros(1))
    np.testing.assert_array_equal(found, values)
    assert found.dtype == np.float64


@pytest.mark.parametrize(
    ("memory", "values", "expected"),
    [
        (0.0, [np.inf, np.nan], r": read returned NaN"),
        (0.0, [1.0], r": read returned shape \(1,\); info\(\) says \(2,\)"),
        (np.inf, [1.0, 2.0], r": read left a memory that is not finite"),
        (
            0.0,
            "fog",
            r": read at t = 0.125 s: TypeError: a str where an array of numbers is wanted",
        ),
    ],
)
def test_other_readings_are_an_error(memory: float, values: Any, expected: str) -> None:
    sensor: Any = checked_sensor(Beam((memory, values)), CALL)
    with pytest.raises(PluginError, match=expected):
        sensor.read(*GIVEN, np.zeros(1))


def test_what_is_not_a_sensor() -> None:
    with pytest.raises(PluginError, match="build returned a int, which has no info and no read"):
        checked_sensor(3, CALL)


class Telling(Beam):
    """Declares what it is told to as its message."""

    def info(self) -> SensorInfo:
        return replace(super().info(), message=self.answer)


def test_messages_of_plugins_are_called_inside_the_boundary() -> None:
    def fields(values: Any) -> Any:
        return 1 / float(values[0])

    info = checked_sensor(Telling(SensorMessage(fields=fields)), CALL).info()
    assert info.message is not None
    with pytest.raises(PluginError, match=r"acme.camera.*: message.fields: ZeroDivisionError"):
        info.message.fields(np.zeros(1))
    with pytest.raises(PluginError, match="returned a float, not fields by name"):
        info.message.fields(np.full(1, 2.0))
    with pytest.raises(PluginError, match="message is a str; a SensorMessage is wanted"):
        checked_sensor(Telling("Radar"), CALL)
