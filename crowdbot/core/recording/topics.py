"""Topic names, and which message a sensor's readings become."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.interfaces import Array, SensorInfo
from crowdbot.core.recording import messages as ros


class Topic(StrEnum):
    """The topics that do not depend on the robot's sensors."""

    HEADER = "/crowdbot/header"
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


class SensorTopic(NamedTuple):
    """A topic and the function that makes its messages from (ns, info, values)."""

    name: str
    message: Callable[[int, SensorInfo, Array], Any]


def sensor_topics(sensors: Mapping[str, SensorInfo]) -> dict[str, SensorTopic]:
    """Sensor name -> topic. The first odometry has ``/odom`` for itself."""
    topics: dict[str, SensorTopic] = {}
    odometry = [n for n, s in sensors.items() if s.category == "odometry" and s.shape == (5,)]
    for name, info in sensors.items():
        if name in odometry:
            topic = "/odom" if name == odometry[0] else f"/{name}/odom"
            topics[name] = SensorTopic(topic, _odometry)
        elif is_scan(info):
            topics[name] = SensorTopic(scan_topic(name), _scan)
        else:
            topics[name] = SensorTopic(f"/{name}", _numbers)
    return topics


def scan_topic(sensor: str) -> str:
    """Topic of a lidar's scans."""
    return f"/{sensor}/scan"


def is_scan(info: SensorInfo) -> bool:
    """Whether readings fit a LaserScan: a lidar with evenly spaced beams in one plane."""
    angles = info.angles
    if info.category != "lidar" or angles is None or info.shape != angles.shape or not angles.size:
        return False
    steps = np.diff(angles)
    return bool(angles.ndim == 1 and np.ptp(steps) < 1e-6) if steps.size else True


def _odometry(ns: int, info: SensorInfo, values: Array) -> Any:
    del info
    return ros.odometry(ns, "base_footprint", values)


def _scan(ns: int, info: SensorInfo, values: Array) -> Any:
    assert info.angles is not None  # by is_scan
    return ros.laser_scan(ns, info, info.angles, values)


def _numbers(ns: int, info: SensorInfo, values: Array) -> Any:
    del ns, info
    return ros.numbers(values)
