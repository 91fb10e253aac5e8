"""Messages of sensors: a table from ROS type to encoder, and types that sensors declare.

A sensor gives its ROS type in `SensorInfo.ros_type`. For a type that is not in the table,
`SensorInfo.message` says how readings become fields. Otherwise readings are sent as plain numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

import crowdbot.core.recording.template as template
from crowdbot.core.recording.covariance import OdometryCovariance, has_noise, imu_deviations
from crowdbot.core.recording.declared_message import declared_encoder
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo

#: Makes a serialised message of a time (ns) and a reading's values.
Encoder = Callable[[int, Array], bytes]
ODOMETRY, SCAN = "nav_msgs/msg/Odometry", "sensor_msgs/msg/LaserScan"
_NUMBERS = "std_msgs/msg/Float64MultiArray"


class MessageKind(NamedTuple):
    """Conversion of readings into messages of one ROS type.

    Attributes:
        leaf: the topic is ``/NAME/leaf``; empty: ``/NAME``.
        fits: returns True if the readings of a sensor can be such messages.
        encoder: makes the encoder of a sensor; its second argument is the namespace of the robot.
    """

    leaf: str
    fits: Callable[[SensorInfo], bool]
    encoder: Callable[[SensorInfo, str], Encoder]


def message_kind(info: SensorInfo) -> tuple[str, MessageKind]:
    """Return the ROS type of a sensor's messages, and their encoder.

    The sensor's own declaration comes first, then the usual type of its category, then its ROS
    type.
    """
    if info.message is not None:
        return info.ros_type, MessageKind(info.message.topic, lambda _: True, declared_encoder)
    for name in (_USUAL.get(info.category, ""), info.ros_type):
        kind = MESSAGES.get(name)
        if kind is not None and kind.fits(info):
            return name, kind
    return _NUMBERS, MessageKind("", lambda _: True, _numbers)


def is_even_fan(info: SensorInfo) -> bool:
    """Return True if a reading is the ranges of evenly spaced beams in one plane."""
    angles = info.angles
    if angles is None or info.shape != angles.shape or not angles.size:
        return False
    steps = np.diff(angles)
    return bool(angles.ndim == 1 and np.ptp(steps) < 1e-6) if steps.size else True


def _is_beam_grid(info: SensorInfo) -> bool:
    """Return True if a reading is the ranges of beams (L, C) with known azimuths and elevations."""
    known = info.angles is not None and info.angles.shape == (*info.shape, 2)
    return known and len(info.shape) == 2


def has_shape(*shapes: tuple[int, ...]) -> Callable[[SensorInfo], bool]:
    """Return a function that tests readings for one of some shapes."""
    return lambda info: info.shape in shapes


def _odometry(info: SensorInfo, namespace: str) -> Encoder:
    before = f"{namespace}/" if namespace else ""
    blank = template.odometry(f"{before}base_footprint", f"{before}odom")
    covariance = OdometryCovariance(info) if has_noise(info) else None

    def message(ns: int, values: Array) -> bytes:
        numbers = values.tolist()
        x, y, yaw, v, w, *aside = numbers
        pose, speed = template.NO_COVARIANCE if covariance is None else covariance(ns, numbers)
        two, one = template.two, template.one
        return blank.fill(
            template.stamp(ns), two(x, y), template.turn(yaw), pose,
            two(v, aside[0] if aside else 0.0), one(w), speed,
        )  # fmt: skip

    return message


def _scan(info: SensorInfo, _: str) -> Encoder:
    assert info.angles is not None  # by is_even_fan
    return _ranges(template.laser_scan(info, info.angles))


def _range(info: SensorInfo, _: str) -> Encoder:
    return _ranges(template.range_reading(info))


def _ranges(blank: template.Template) -> Encoder:
    """Fill a message with all numbers in single precision."""

    def message(ns: int, values: Array) -> bytes:
        return blank.fill(template.stamp(ns), values.astype(np.float32).tobytes())

    return message


def _cloud(info: SensorInfo, _: str) -> Encoder:
    assert info.angles is not None  # by _is_beam_grid
    azimuth, elevation = info.angles[..., 0], info.angles[..., 1]
    level = np.cos(elevation)
    rays = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1)
    blank = template.point_cloud(info)

    def message(ns: int, values: Array) -> bytes:
        points = np.where(np.isfinite(values), values, np.nan)[..., np.newaxis] * rays
        return blank.fill(template.stamp(ns), points.astype(np.float32).tobytes())

    return message


def _imu(info: SensorInfo, _: str) -> Encoder:
    return _in_two(template.imu(info.frame, imu_deviations(info)), first=3)


def _wrench(info: SensorInfo, _: str) -> Encoder:
    return _in_two(template.wrench(info.frame), first=2)


def _in_two(blank: template.Template, first: int) -> Encoder:
    """Fill a message with the first numbers, and at another place with the others."""

    def message(ns: int, values: Array) -> bytes:
        data = np.asarray(values, np.float64)
        return blank.fill(template.stamp(ns), data[:first].tobytes(), data[first:].tobytes())

    return message


def _numbers(info: SensorInfo, _: str) -> Encoder:
    blank = template.numbers(info.shape)

    def message(ns: int, values: Array) -> bytes:
        del ns
        return blank.fill(np.asarray(values, np.float64).tobytes())

    return message


#: ROS type -> how readings become messages of it.
MESSAGES: Mapping[str, MessageKind] = {
    ODOMETRY: MessageKind("odom", has_shape((5,), (6,)), _odometry),
    SCAN: MessageKind("scan", is_even_fan, _scan),
    "sensor_msgs/msg/Range": MessageKind("range", has_shape((1,)), _range),
    "sensor_msgs/msg/PointCloud2": MessageKind("points", _is_beam_grid, _cloud),
    "sensor_msgs/msg/Imu": MessageKind("imu", has_shape((6,)), _imu),
    "geometry_msgs/msg/WrenchStamped": MessageKind("wrench", has_shape((3,)), _wrench),
}
#: Category -> type of its messages, whatever ROS type a sensor of it says.
_USUAL = {"odometry": ODOMETRY, "lidar": SCAN}
