"""Build sensors: their descriptions are checked once, their readings each time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from numbers import Integral
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.core.sensing.context import SensorContext
from crowdbot.core.sensing.reading_errors import ErringSensor
from crowdbot.core.sensing.sensor import DepthCamera, Sensor, SensorWithMemory
from crowdbot.core.support.plain_numbers import plain_numbers
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo, SensorMessage
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.errors import PluginError, hidden_character

#: Largest number of values in a reading: 100 images of a million pixels.
_MOST_VALUES = 100_000_000
_TEXTS = ("category", "frame", "ros_type")


def build_sensor(
    registry: Registry, spec: SensorSpec, context: SensorContext
) -> Sensor | SensorWithMemory:
    """Return the sensor that a spec describes; each of its readings is checked.

    Args:
        context: the robot that carries it, and the robot's task.

    Raises:
        PluginError: it cannot be built, or its description is invalid.
        InputError: one of its errors is about a number that its readings do not have.
    """
    call = registry.plugin_call(spec)
    sensor = registry.build(spec, lambda built: checked_sensor(built, call), context, call=call)
    errors = [spec.errors[name] for name in sorted(spec.errors)]
    return ErringSensor(sensor, errors) if errors else sensor


def checked_sensor(sensor: object, call: PluginCall) -> Sensor | SensorWithMemory:
    """Wrap a sensor so that its readings are checked.

    Args:
        sensor: result of a build function.
        call: call boundary to its plugin.

    Raises:
        PluginError: it is not a sensor, or its description is invalid.
    """
    missing = [m for m in ("info", "read") if not callable(getattr(sensor, m, None))]
    if missing:
        raise PluginError(
            f"build returned a {type(sensor).__name__}, which has no {' and no '.join(missing)}"
        )
    built = cast(Sensor, sensor)
    with call("info"):
        info = built.info()
    _check(info)
    if info.message is not None:
        info = replace(info, message=_guarded(info.message, call))
    checked = CheckedCamera if isinstance(sensor, DepthCamera) else CheckedSensor
    return checked(built, info, call)


def _guarded(message: SensorMessage, call: PluginCall) -> SensorMessage:
    """Return the message of a plugin's sensor with its calls inside the boundary."""

    def fields(values: Array) -> Mapping[str, Any]:
        with call("message.fields"):
            found = message.fields(values)
        if not isinstance(found, Mapping):
            call.fail(f"message.fields returned a {type(found).__name__}, not fields by name")
        return found

    return replace(message, fields=fields)


class CheckedSensor:
    """A sensor whose readings must have the declared shape and no NaN."""

    def __init__(self, sensor: Any, info: SensorInfo, call: PluginCall) -> None:
        self._sensor, self._info, self._call = sensor, info, call
        self._shape, self._remembers = tuple(info.shape), bool(info.memory)

    def info(self) -> SensorInfo:
        """Return the constant description."""
        return self._info

    def read(self, *given: Any) -> Array:
        """Return the sensor's checked reading; arguments as in its interface.

        Raises:
            PluginError: it raised, or returned something that is not a reading.
        """
        with self._call("read", given[2]):
            values = plain_numbers(self._sensor.read(*given))
        if values.shape != self._shape:
            self._call.fail(f"read returned shape {values.shape}; info() says {self._shape}")
        # A sum of squares is NaN or infinite if any number is, which is by far the fastest check.
        if math.isnan(np.vdot(values, values)):
            self._call.fail("read returned NaN; nothing in reach is inf")
        if self._remembers:
            memory = given[-1]
            if not math.isfinite(np.vdot(memory, memory)) and not np.isfinite(memory).all():
                self._call.fail("read left a memory that is not finite")
        return values


class CheckedCamera(CheckedSensor):
    """A camera with images in whole millimetres, which are also checked."""

    def depth_mm(self, *given: Any) -> NDArray[np.uint16]:
        """Return the camera's image in whole millimetres, copied, since it is written later.

        Raises:
            PluginError: it raised, or returned something that is not an image.
        """
        with self._call("depth_mm", given[2]):
            image = self._sensor.depth_mm(*given)
        if getattr(image, "dtype", None) != np.uint16 or image.shape != self._shape:
            kind = f"{getattr(image, 'dtype', type(image).__name__)} {np.shape(image)}"
            self._call.fail(f"depth_mm returned {kind}, not uint16 {self._shape}")
        return cast(NDArray[np.uint16], image.copy())


def _check(info: object) -> None:
    def refuse(text: str) -> None:
        raise PluginError(f"info(): {text}")

    if not isinstance(info, SensorInfo):
        raise PluginError(f"info() is a {type(info).__name__}, not a SensorInfo")
    for name in _TEXTS:
        if not (isinstance(getattr(info, name), str) and getattr(info, name)):
            refuse(f"{name} is {getattr(info, name)!r}")
        if hidden := hidden_character(getattr(info, name), allowed=""):
            refuse(f"{name} has the character {hidden}")
    if not (isinstance(info.rate, int | float) and 0.0 < info.rate <= TICKS_PER_SECOND):
        refuse(f"rate is {info.rate!r} Hz; it must be above 0 and at most {TICKS_PER_SECOND}")
    _check_shape(info, refuse)
    _check_mount(info, refuse)
    if not (isinstance(info.memory, Integral) and int(info.memory) >= 0):
        refuse(f"memory is {info.memory!r}")
    if info.angles is not None and not np.all(np.isfinite(info.angles)):
        refuse("angles are not finite")
    if math.isnan(info.range_min) or not info.range_min < info.range_max:
        refuse(f"range is from {info.range_min} to {info.range_max} m")
    _check_noise(info, refuse)
    _check_camera(info, refuse)
    if info.message is not None and not (
        isinstance(info.message, SensorMessage) and callable(info.message.fields)
    ):
        refuse(f"message is a {type(info.message).__name__}; a SensorMessage is wanted")


def _check_noise(info: SensorInfo, refuse: Callable[[str], None]) -> None:
    for name in ("deviations", "scatter"):
        found = getattr(info, name)
        if not all(isinstance(d, int | float) and 0.0 <= d < math.inf for d in found):
            refuse(f"{name} are {found!r}; numbers from 0 on are wanted")
    if info.scatter and info.shape != (len(info.scatter),):
        refuse(f"scatter has {len(info.scatter)} numbers, and a reading the shape {info.shape}")


def _check_shape(info: SensorInfo, refuse: Callable[[str], None]) -> None:
    shape: object = info.shape
    if not (
        isinstance(shape, tuple) and all(isinstance(n, Integral) and int(n) > 0 for n in shape)
    ):
        refuse(f"shape is {shape!r}; a tuple of whole numbers above 0 is wanted")
    if math.prod(info.shape) > _MOST_VALUES:
        refuse(f"shape is {shape!r}; a reading has at most {_MOST_VALUES} numbers")


def _check_camera(info: SensorInfo, refuse: Callable[[str], None]) -> None:
    if info.camera is not None and (
        info.memory or info.shape != (info.camera.height, info.camera.width)
    ):
        refuse("a camera's shape is its height and width, and it has no memory")


def _check_mount(info: SensorInfo, refuse: Callable[[str], None]) -> None:
    mount = np.asarray(info.mount, np.float64)
    if mount.shape != (4,) or not np.all(np.isfinite(mount)):
        refuse(f"mount is {info.mount!r}; x, y, z, yaw are wanted")
    tilt = np.asarray(info.tilt, np.float64)
    if tilt.shape != (2,) or not np.all(np.isfinite(tilt)):
        refuse(f"tilt is {info.tilt!r}; roll and pitch are wanted")
