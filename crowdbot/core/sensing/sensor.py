"""The contracts of sensors and of noise generators."""

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
        """Constant description."""
        ...

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return new values of ``info().shape``. ``pose`` is base_link's, world frame."""
        ...


@runtime_checkable
class DepthCamera(Protocol):
    """A camera that makes an image in whole millimetres with less work than a reading in m.

    A camera need not be one: where it is recorded, its reading is rounded.
    """

    def depth_mm(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator
    ) -> NDArray[np.uint16]:
        """What `Sensor.read` would return, rounded as in `CameraFrame`; a new array."""
        ...


class SensorWithMemory(Protocol):
    """A sensor whose ``info().memory > 0``; it keeps all its state in ``memory``."""

    def info(self) -> SensorInfo:
        """Constant description."""
        ...

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """As `Sensor.read`; ``memory`` starts as zeros and is changed in place."""
        ...


class NoiseGenerator(Protocol):
    """One error of a proximity sensor.

    Attributes:
        random: whether ``errors`` draws from ``rng``; if not, it must leave it alone.
    """

    random: bool

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """What to add to distances (N,), m, finite; inf is a beam that hit nothing.

        As many numbers are drawn whatever the distances are. Errors of generators that come
        before are in ``distance`` already.
        """
        ...
