"""Names of topics, and the topic of each sensor."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple

from crowdbot.core.recording.sensor_messages import Encoder, has_shape, is_even_fan, message_kind
from crowdbot.core.types.sensor import SensorInfo


class Topic(StrEnum):
    """The topics that every robot has, whatever its sensors."""

    HEADER = "/crowdbot/header"
    TILTS = "/crowdbot/tilts"
    PERSON_TASK = "/crowdbot/person_task"
    CANDIDATES = "/crowdbot/candidates"
    PERSON_GOALS = "/crowdbot/person_goals"
    STATE = "/crowdbot/state"
    TRIP = "/crowdbot/trip"
    SIGNAL = "/crowdbot/signal"
    PLANNER_TIME = "/crowdbot/planner_time"
    TRACKS = "/tracks"
    THOUGHTS = "/thoughts"
    THOUGHT_TEXTS = "/thought_texts"
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
    JOINT_STATES = "/joint_states"
    PEOPLE_MARKERS = "/people_markers"
    CONTACT_MARKERS = "/contact_markers"


class SensorTopic(NamedTuple):
    """A topic, and the function that builds its messages from (ns, values)."""

    name: str
    msgtype: str
    message: Encoder


def sensor_topics(sensors: Mapping[str, SensorInfo], namespace: str = "") -> dict[str, SensorTopic]:
    """Return the topic of each sensor, by its name. The first odometry has ``/odom`` for itself.

    Args:
        namespace: of the robot's frames; topics are without it.

    Raises:
        PluginError: the message that a sensor declares is not one.
    """
    odometry = next((n for n, s in sensors.items() if is_odometry(s)), None)
    topics: dict[str, SensorTopic] = {}
    for name, info in sensors.items():
        msgtype, kind = message_kind(info)
        topic = "/odom" if name == odometry else _topic(name, kind.leaf)
        topics[name] = SensorTopic(topic, msgtype, kind.encoder(info, namespace))
    return topics


def _topic(sensor: str, leaf: str) -> str:
    return f"/{sensor}/{leaf}" if leaf else f"/{sensor}"


def usual_names(sensors: Mapping[str, SensorInfo]) -> dict[str, str]:
    """Return the topics that users of ROS expect, of the first lidar and of the first IMU."""
    lidar = next((n for n, s in sensors.items() if is_scan(s)), None)
    imu = next((n for n, s in sensors.items() if is_imu(s)), None)
    names = {lidar: "/scan", imu: "/imu/data"}
    return {n: topic for n, topic in names.items() if n is not None}


def scan_topic(sensor: str) -> str:
    """Return the topic of a lidar's scans."""
    return _topic(sensor, "scan")


def range_topic(sensor: str) -> str:
    """Return the topic of an ultrasound or infrared sensor's readings."""
    return _topic(sensor, "range")


def is_cone(info: SensorInfo) -> bool:
    """Return True if a reading is one distance within a cone, as of ultrasound."""
    known = info.angles is not None and info.angles.shape == (2,) and info.message is None
    return known and info.ros_type == "sensor_msgs/msg/Range" and info.shape == (1,)


def is_scan(info: SensorInfo) -> bool:
    """Return True for a lidar whose readings are LaserScans: even beams in one plane."""
    return info.category == "lidar" and is_even_fan(info) and info.message is None


def is_imu(info: SensorInfo) -> bool:
    """Return True if readings are angular rate and specific force."""
    return info.ros_type == "sensor_msgs/msg/Imu" and info.shape == (6,) and info.message is None


def is_odometry(info: SensorInfo) -> bool:
    """Return True if readings are x, y, yaw, v, w, and perhaps vy."""
    return info.category == "odometry" and has_shape((5,), (6,))(info)
