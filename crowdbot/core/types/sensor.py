"""Values of sensors: their description, their messages, their readings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Pinhole:
    """A camera that looks along x of its frame; images are (height, width), top left first.

    Attributes:
        width, height: pixels.
        focal: focal length, pixels; pixels are square and the axis goes through the centre.
        colour: True if it also takes colour images.
    """

    width: int
    height: int
    focal: float
    colour: bool = False

    @property
    def centre(self) -> tuple[float, float]:
        """Return column and row of the optical axis, from the centre of the first pixel."""
        return 0.5 * (self.width - 1), 0.5 * (self.height - 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorMessage:
    """The ROS message for a sensor's readings; of type `SensorInfo.ros_type`.

    Attributes:
        fields: makes the message's fields, by name, of a reading's values: numbers, texts, arrays,
            and mappings for messages within it. A field ``header`` is filled in where it is left
            out: the time of the reading and the sensor's frame.
        definitions: ROS type -> its text as in a .msg file, of each type that ROS 2 Humble lacks.
        topic: readings are on ``/NAME/topic``; empty: on ``/NAME``.
    """

    fields: Callable[[Array], Mapping[str, Any]]
    definitions: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    topic: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInfo:
    """A sensor's description for planners and recorders.

    Attributes:
        category: ``lidar``, ``odometry``, ``ultrasound``, …
        mount: x, y, z, yaw from base_link (m, rad).
        tilt: roll and pitch of the mount (rad), before its yaw: R = Rz(yaw) Ry(pitch) Rx(roll).
        shape: shape of a reading's values.
        angles: in the sensor frame, rad: (R,) of the beams of a lidar, (L, C, 2) azimuth and
            elevation of each beam of a multi-layer lidar, (2,) edges of the zone of an ultrasound
            or an infrared sensor; or None.
        sees: True if ``read`` uses the scene's people; otherwise they may be out of date.
        feels: True if ``read`` uses the scene's ``push``; otherwise it may be out of date.
        memory: number of float64 the sensor keeps between readings (0: none).
        random: True if ``read`` draws from ``rng``; otherwise it must not use it.
        camera: of a sensor whose readings are images. They are a pure function of what is seen
            at their instant and are kept out of the simulation's state; such a sensor has no
            memory.
        deviations: standard deviations of what it measures, for the covariances of its messages;
            none where they are not known. Of an IMU: of angular rates (rad/s) and of specific
            force (m/s^2). Of odometry: of the distance between two readings as a part of it, of
            the turn on each metre (rad/m), of the turn in a second (rad/sqrt(s)); and perhaps of
            the speeds of each reading: ahead, to the left (m/s), turning (rad/s).
        scatter: standard deviation of each number of a reading in itself, by errors that do not
            add up from reading to reading, such as those of ``errors:``; none: no such errors.
        privileged: True if readings contain what no real sensor could measure; only planners
            that say that they are privileged may read them.
        message: of a sensor whose ``ros_type`` crowdbot has no encoder for; without it its
            readings are recorded as ``std_msgs/msg/Float64MultiArray``.
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
    feels: bool = False
    camera: Pinhole | None = None
    deviations: tuple[float, ...] = ()
    scatter: tuple[float, ...] = ()
    privileged: bool = False
    tilt: tuple[float, float] = (0.0, 0.0)
    message: SensorMessage | None = None


class Reading(NamedTuple):
    """A sensor's latest values and the simulated time at which they were taken (s).

    Images are float32. ``colour`` is (height, width, 3) uint8 for a camera with colour.
    """

    stamp: float
    values: Array
    colour: NDArray[np.uint8] | None = None


class CameraFrame(NamedTuple):
    """A recorded camera image, and the time at which it was taken (s).

    Attributes:
        depth_mm: (height, width) uint16, in whole millimetres as in ROS's ``16UC1``: 0 if nothing
            was measured.
        colour: (height, width, 3) uint8 for a camera with colour.
    """

    stamp: float
    depth_mm: NDArray[np.uint16]
    colour: NDArray[np.uint8] | None = None
