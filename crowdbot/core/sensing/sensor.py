"""The interfaces of sensors and of noise generators."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import SensorInfo

if TYPE_CHECKING:
    from crowdbot.core.sensing.scene import Scene


class Sensor(Protocol):
    """A sensor without memory."""

    def info(self) -> SensorInfo:
        """Return the constant description."""
        ...

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return new values of ``info().shape``. ``pose`` is base_link's, world frame."""
        ...


@runtime_checkable
class DepthCamera(Protocol):
    """A camera that can make an image in whole millimetres faster than a reading in m.

    This is optional: otherwise recordings contain the rounded reading.
    """

    def depth_mm(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator
    ) -> NDArray[np.uint16]:
        """Return the reading in whole millimetres, rounded as in `CameraFrame`; a new array."""
        ...


class SensorWithMemory(Protocol):
    """A sensor whose ``info().memory > 0``; it keeps all its state in ``memory``."""

    def info(self) -> SensorInfo:
        """Return the constant description."""
        ...

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Return a reading as `Sensor.read`; ``memory`` starts as zeros and is changed in place."""
        ...


class NoiseGenerator(Protocol):
    """One error of a range sensor.

    Attributes:
        random: True if ``errors`` uses ``rng``; otherwise it must not.
    """

    random: bool

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Return errors for distances (N,), m, finite; inf marks a beam without a hit.

        The number of draws does not depend on the distances. Errors of earlier generators are
        already included in ``distance``.
        """
        ...
