"""Topic names, and which message a sensor's readings become."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import NamedTuple

import numpy as np

import crowdbot.core.recording.template as template
from crowdbot.core.recording.covariance import OdometryCovariance
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo

#: Numbers in `SensorInfo.deviations` of an odometry.
_DEVIATIONS = 3


class Topic(StrEnum):
    """The topics that do not depend on the robot's sensors."""

    HEADER = "/crowdbot/header"
    TILTS = "/crowdbot/tilts"
    CANDIDATES = "/crowdbot/candidates"
    PERSON_GOALS = "/crowdbot/person_goals"
    STATE = "/crowdbot/state"
    TRIP = "/crowdbot/trip"
    SIGNAL = "/crowdbot/signal"
    PLANNER_TIME = "/crowdbot/planner_time"
    END = "/crowdbot/end"
    CONTACTS = "/contacts"
    CLOCK = "/clock"
    TF = "/tf"
    TF_STATIC = "/tf_static"
    POSE = "/robot/pose"
    COMMAND = "/cmd_vel"
    PEOPLE = "/pedestrians"
    PEOPLE_MARKER = "/pedestrians_marker"
    WALLS = "/walls_marker"
    GOAL = "/goal_zone"
    GOAL_POSE = "/goal_pose"
    MAP = "/map"
    DESCRIPTION = "/robot_description"
    PATH = "/robot/path"
    TF_ODOMETRY = "/tf_odometry"
    PEOPLE_MARKERS = "/people_markers"
    CONTACT_MARKERS = "/contact_markers"


class SensorTopic(NamedTuple):
    """A topic, and the function that makes its messages from (ns, values)."""

    name: str
    msgtype: str
    message: Callable[[int, Array], bytes]


def sensor_topics(sensors: Mapping[str, SensorInfo], namespace: str = "") -> dict[str, SensorTopic]:
    """Sensor name -> topic. The first odometry has ``/odom`` for itself.

    Args:
        namespace: of the robot's frames; topics are without it.
    """
    topics: dict[str, SensorTopic] = {}
    odometry = [n for n, s in sensors.items() if is_odometry(s)]
    for name, info in sensors.items():
        if name in odometry:
            topic = "/odom" if name == odometry[0] else f"/{name}/odom"
            topics[name] = _odometry(topic, info, namespace)
        elif is_scan(info):
            topics[name] = _scan(scan_topic(name), info)
        elif info.ros_type == "sensor_msgs/msg/Range" and info.shape == (1,):
            topics[name] = _range(range_topic(name), info)
        elif is_cloud(info):
            topics[name] = _cloud(f"/{name}/points", info)
        elif is_imu(info):
            topics[name] = _imu(f"/{name}/imu", info)
        elif info.ros_type == "geometry_msgs/msg/WrenchStamped" and info.shape == (3,):
            topics[name] = _wrench(f"/{name}/wrench", info)
        elif info.ros_type == "geometry_msgs/msg/TwistStamped" and info.shape == (2,):
            topics[name] = _wanted(f"/{name}/cmd_vel", info)
        else:
            topics[name] = _numbers(f"/{name}", info)
    return topics


def usual_names(sensors: Mapping[str, SensorInfo]) -> dict[str, str]:
    """Sensor -> the topic that users of ROS expect: the first lidar's, the first IMU's."""
    lidar = next((n for n, s in sensors.items() if is_scan(s)), None)
    imu = next((n for n, s in sensors.items() if is_imu(s)), None)
    names = {lidar: "/scan", imu: "/imu/data"}
    return {n: topic for n, topic in names.items() if n is not None}


def scan_topic(sensor: str) -> str:
    """Topic of a lidar's scans."""
    return f"/{sensor}/scan"


def range_topic(sensor: str) -> str:
    """Topic of an ultrasound or infrared sensor's readings."""
    return f"/{sensor}/range"


def is_cone(info: SensorInfo) -> bool:
    """Whether a reading is one distance between two known edges."""
    known = info.angles is not None and info.angles.shape == (2,)
    return known and info.ros_type == "sensor_msgs/msg/Range" and info.shape == (1,)


def is_scan(info: SensorInfo) -> bool:
    """Whether readings fit a LaserScan: a lidar with evenly spaced beams in one plane."""
    angles = info.angles
    if info.category != "lidar" or angles is None or info.shape != angles.shape or not angles.size:
        return False
    steps = np.diff(angles)
    return bool(angles.ndim == 1 and np.ptp(steps) < 1e-6) if steps.size else True


def is_imu(info: SensorInfo) -> bool:
    """Whether readings are angular rate and specific force."""
    return info.ros_type == "sensor_msgs/msg/Imu" and info.shape == (6,)


def is_odometry(info: SensorInfo) -> bool:
    """Whether readings are x, y, yaw, v, w, and perhaps vy."""
    return info.category == "odometry" and info.shape in ((5,), (6,))


def is_cloud(info: SensorInfo) -> bool:
    """Whether readings are the ranges of beams (L, C) whose azimuths and elevations are known."""
    known = info.angles is not None and info.angles.shape == (*info.shape, 2)
    return known and len(info.shape) == 2 and info.ros_type == "sensor_msgs/msg/PointCloud2"


def _odometry(topic: str, info: SensorInfo, namespace: str) -> SensorTopic:
    before = f"{namespace}/" if namespace else ""
    blank = template.odometry(f"{before}base_footprint", f"{before}odom")
    known = len(info.deviations) == _DEVIATIONS
    covariance = OdometryCovariance(info.deviations) if known else None

    def message(ns: int, values: Array) -> bytes:
        numbers = values.tolist()
        x, y, yaw, v, w, *aside = numbers
        pose, speed = template.NO_COVARIANCE if covariance is None else covariance(ns, numbers)
        two, one = template.two, template.one
        return blank.fill(
            template.stamp(ns), two(x, y), template.turn(yaw), pose,
            two(v, aside[0] if aside else 0.0), one(w), speed,
        )  # fmt: skip

    return SensorTopic(topic, blank.msgtype, message)


def _scan(topic: str, info: SensorInfo) -> SensorTopic:
    assert info.angles is not None  # by is_scan
    blank = template.laser_scan(info, info.angles)

    def message(ns: int, values: Array) -> bytes:
        return blank.fill(template.stamp(ns), values.astype(np.float32).tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _range(topic: str, info: SensorInfo) -> SensorTopic:
    blank = template.range_reading(info)

    def message(ns: int, values: Array) -> bytes:
        return blank.fill(template.stamp(ns), values.astype(np.float32).tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _cloud(topic: str, info: SensorInfo) -> SensorTopic:
    assert info.angles is not None  # by is_cloud
    azimuth, elevation = info.angles[..., 0], info.angles[..., 1]
    level = np.cos(elevation)
    rays = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1)
    blank = template.point_cloud(info)

    def message(ns: int, values: Array) -> bytes:
        points = np.where(np.isfinite(values), values, np.nan)[..., np.newaxis] * rays
        return blank.fill(template.stamp(ns), points.astype(np.float32).tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _imu(topic: str, info: SensorInfo) -> SensorTopic:
    blank = template.imu(info.frame, info.deviations[:2] if len(info.deviations) > 1 else (0, 0))

    def message(ns: int, values: Array) -> bytes:
        data = np.asarray(values, np.float64)
        return blank.fill(template.stamp(ns), data[:3].tobytes(), data[3:].tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _wrench(topic: str, info: SensorInfo) -> SensorTopic:
    blank = template.wrench(info.frame)

    def message(ns: int, values: Array) -> bytes:
        data = np.asarray(values, np.float64)
        return blank.fill(template.stamp(ns), data[:2].tobytes(), data[2:].tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _wanted(topic: str, info: SensorInfo) -> SensorTopic:
    blank = template.twist_stamped(info.frame)

    def message(ns: int, values: Array) -> bytes:
        data = np.asarray(values, np.float64)
        return blank.fill(template.stamp(ns), data[:1].tobytes(), data[1:].tobytes())

    return SensorTopic(topic, blank.msgtype, message)


def _numbers(topic: str, info: SensorInfo) -> SensorTopic:
    blank = template.numbers(info.shape)

    def message(ns: int, values: Array) -> bytes:
        del ns
        return blank.fill(np.asarray(values, np.float64).tobytes())

    return SensorTopic(topic, blank.msgtype, message)
