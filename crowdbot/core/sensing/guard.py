"""Sensors as plugins return them: described soundly, and watched while they read."""

from __future__ import annotations

import math
from collections.abc import Callable
from numbers import Integral
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.fault import described
from crowdbot.core.interfaces import MillimetreCamera, Sensor, SensorInfo, SensorWithMemory
from crowdbot.core.registry import Registry
from crowdbot.core.ticks import TICKS_PER_SECOND
from crowdbot.dsl.base import SensorSpec
from crowdbot.dsl.proximity import ProximitySpec
from crowdbot.errors import CrowdbotError, PluginError

Array = NDArray[np.float64]
_WORDS = ("category", "frame", "ros_type")


def build_sensor(registry: Registry, spec: SensorSpec) -> Sensor | SensorWithMemory:
    """The sensor that a spec describes.

    Those that are not crowdbot's own, or have noise that is not, are watched: what they return is
    looked at, and what they raise becomes an error with their name.

    Raises:
        PluginError: it cannot be built, or its description is unsound.
    """
    try:
        sensor = registry.build(spec)
        info = sensor.info()
    except CrowdbotError:
        raise
    except (Exception, SystemExit) as error:
        raise PluginError(f"sensor {spec.kind}: {described(error)}") from error
    _check(spec.kind, info)
    specs = [spec, *(spec.noise.values() if isinstance(spec, ProximitySpec) else ())]
    owners = (registry.owner(registry.find(s.category, s.kind)) for s in specs)
    built: Sensor | SensorWithMemory = sensor
    if all(o.name == "builtin" for o in owners):
        return built
    watched = WatchedCamera if isinstance(sensor, MillimetreCamera) else Watched
    return watched(spec.kind, sensor, info)


class Watched:
    """A sensor whose readings have the shape that it promised and no NaN, or an error says so."""

    def __init__(self, kind: str, sensor: Any, info: SensorInfo) -> None:
        self._kind, self._sensor, self._info = kind, sensor, info

    def info(self) -> SensorInfo:
        """Constant description."""
        return self._info

    def read(self, *given: Any) -> Array:
        """What the sensor reads.

        Raises:
            PluginError: it raised, or returned what is no reading.
        """
        values = self._asked(lambda *a: np.asarray(self._sensor.read(*a), np.float64), *given)
        if values.shape != self._info.shape:
            raise PluginError(
                f"sensor {self._kind} returned shape {values.shape}; info() says {self._info.shape}"
            )
        if np.any(np.isnan(values)):
            raise PluginError(f"sensor {self._kind} returned NaN; nothing in reach is inf")
        if self._info.memory and not np.all(np.isfinite(given[-1])):
            raise PluginError(f"sensor {self._kind} left a memory that is not finite")
        return cast(Array, values)

    def _asked(self, question: Callable[..., Any], *given: Any) -> Any:
        try:
            return question(*given)
        except CrowdbotError:
            raise
        except (Exception, SystemExit) as error:
            text = f"sensor {self._kind} at t = {given[2]:g} s: {described(error)}"
            raise PluginError(text) from error


class WatchedCamera(Watched):
    """A camera that has images in whole millimetres, watched as well."""

    def millimetres(self, *given: Any) -> NDArray[np.uint16]:
        """What the camera sees, in whole millimetres; copied, for it is written later.

        Raises:
            PluginError: it raised, or returned what is no image.
        """
        image = self._asked(self._sensor.millimetres, *given)
        if getattr(image, "dtype", None) != np.uint16 or image.shape != self._info.shape:
            what = f"{getattr(image, 'dtype', type(image).__name__)} {np.shape(image)}"
            raise PluginError(
                f"sensor {self._kind}: millimetres() returned {what}, not uint16 {self._info.shape}"
            )
        return cast(NDArray[np.uint16], image.copy())


def _check(kind: str, info: object) -> None:
    def refuse(text: str) -> None:
        raise PluginError(f"sensor {kind}: info(): {text}")

    if not isinstance(info, SensorInfo):
        raise PluginError(f"sensor {kind}: info() is a {type(info).__name__}, not a SensorInfo")
    for name in _WORDS:
        if not (isinstance(getattr(info, name), str) and getattr(info, name)):
            refuse(f"{name} is {getattr(info, name)!r}")
    if not (isinstance(info.rate, int | float) and 0.0 < info.rate <= TICKS_PER_SECOND):
        refuse(f"rate is {info.rate!r} Hz; it must be above 0 and at most {TICKS_PER_SECOND}")
    shape: object = info.shape
    if not (
        isinstance(shape, tuple) and all(isinstance(n, Integral) and int(n) > 0 for n in shape)
    ):
        refuse(f"shape is {shape!r}; a tuple of whole numbers above 0 is wanted")
    mount = np.asarray(info.mount, np.float64)
    if mount.shape != (4,) or not np.all(np.isfinite(mount)):
        refuse(f"mount is {info.mount!r}; x, y, z, yaw are wanted")
    if not (isinstance(info.memory, Integral) and int(info.memory) >= 0):
        refuse(f"memory is {info.memory!r}")
    if info.angles is not None and not np.all(np.isfinite(info.angles)):
        refuse("angles are not finite")
    if math.isnan(info.range_min) or not info.range_min < info.range_max:
        refuse(f"range is from {info.range_min} to {info.range_max} m")
    if info.camera is not None and (
        info.memory or info.shape != (info.camera.height, info.camera.width)
    ):
        refuse("a camera's shape is its height and width, and it has no memory")
