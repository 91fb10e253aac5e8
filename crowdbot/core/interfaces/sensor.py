"""What a sensor says about itself and about the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces.motion import Array, Pose

if TYPE_CHECKING:
    from crowdbot.core.sensing.scene import Scene


@dataclass(frozen=True, slots=True, kw_only=True)
class Pinhole:
    """A camera that looks along x of its frame; images are (height, width), top left first.

    Attributes:
        width, height: pixels.
        focal: focal length, pixels; pixels are square and the axis goes through the centre.
        colour: whether it takes colour images too.
    """

    width: int
    height: int
    focal: float
    colour: bool = False

    @property
    def centre(self) -> tuple[float, float]:
        """Column and row of the optical axis, counted from the centre of the first pixel."""
        return 0.5 * (self.width - 1), 0.5 * (self.height - 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInfo:
    """What a planner or a recorder may know about a sensor.

    Attributes:
        category: ``lidar``, ``odometry``, ``ultrasound``, …
        mount: x, y, z, yaw from base_link (m, rad).
        shape: shape of a reading's values.
        angles: in the sensor frame, rad: (R,) of the beams of a lidar, (L, C, 2) azimuth and
            elevation of each beam of a multi-layer lidar, (2,) edges of the zone of an ultrasound
            or an infrared sensor; or None.
        sees: whether ``read`` looks at the people of the scene; if not, they may be out of date.
        memory: number of float64 the sensor keeps between readings (0: none).
        random: whether ``read`` draws from ``rng``; if not, it must leave it alone.
        camera: of a sensor whose readings are images. They are a pure function of what is seen
            at their instant and are kept out of the simulation's state; such a sensor has no
            memory.
        privileged: whether readings tell what no sensor of a real robot could; only planners
            that say that they are privileged may read them.
    """

    category: str
    frame: str
    mount: tuple[float, float, float, float]
    rate: float
    shape: tuple[int, ...]
    ros_type: str
    angles: Array | None = None
    range_min: float = 0.0
    range_max: float = float("inf")
    memory: int = 0
    random: bool = True
    sees: bool = True
    camera: Pinhole | None = None
    privileged: bool = False


class Reading(NamedTuple):
    """A sensor's latest values and the simulated time at which they were taken (s).

    Images are float32. ``colour`` is (height, width, 3) uint8 of a camera that has it.
    """

    stamp: float
    values: Array
    colour: NDArray[np.uint8] | None = None


class Photograph(NamedTuple):
    """What a recording keeps of a camera's reading, and the time at which it was taken (s).

    Attributes:
        millimetres: (height, width) uint16, whole millimetres as ROS has them in ``16UC1``: 0
            where nothing was measured.
        colour: (height, width, 3) uint8 of a camera that has it.
    """

    stamp: float
    millimetres: NDArray[np.uint16]
    colour: NDArray[np.uint8] | None = None


class Sensor(Protocol):
    """A sensor without memory."""

    def info(self) -> SensorInfo:
        """Constant description."""
        ...

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return new values of ``info().shape``. ``pose`` is base_link's, world frame."""
        ...


@runtime_checkable
class MillimetreCamera(Protocol):
    """A camera that has an image in whole millimetres with less ado than a reading in m.

    A camera need not be one: where it is recorded, its reading is rounded.
    """

    def millimetres(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator
    ) -> NDArray[np.uint16]:
        """What `Sensor.read` would return, rounded as in `Photograph`; a new array."""
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
