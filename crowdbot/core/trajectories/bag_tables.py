"""Tables of a robot and of people from topics of a ROS 1 or ROS 2 bag.

A message is read by its fields, not by its type name: a pose, with or without covariance; a list of
people with positions. So message packages need not be installed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.trajectories.raw_table import Cells, RawTable
from crowdbot.errors import InputError, UnknownNameError

#: Fields that may hold the list of people, in the order they are tried.
_LISTS = ("people", "tracks", "pedestrians", "agents", "agent_states", "markers", "poses")
_NAMES = ("track_id", "id", "name", "object_id", "uuid")


def bag_tables(
    path: Path, robot: str | None, people: str | None
) -> tuple[RawTable | None, RawTable | None]:
    """Return the tables of two topics; times are from the headers, else from the recording.

    Args:
        path: a bag of ROS 1 (``.bag``), a folder of rosbag2, or its ``.mcap`` or ``.db3`` file.
        robot: topic with the pose: ``Odometry``, ``PoseStamped``, ``Pose`` and similar.
        people: topic with a list of people, or a ``PoseArray``, whose order then identifies people.

    Raises:
        InputError: it cannot be read, or a message has no pose or no list.
        UnknownNameError: there is no such topic.
    """
    if robot is None and people is None:
        raise InputError(f"{path}: which topics? Give robot=TOPIC, people=TOPIC or both")
    wanted = {topic for topic in (robot, people) if topic is not None}
    robot_rows: list[dict[str, Any]] = []
    people_rows: list[dict[str, Any]] = []
    for topic, ns, message in _messages(path, wanted):
        t = _stamp(message, ns)
        if topic == robot:
            robot_rows.append({"t": t, **_robot_row(path, topic, message)})
        if topic == people:
            people_rows += [{"t": t, **row} for row in _people_rows(path, topic, message)]
    return _table(path, robot, robot_rows), _table(path, people, people_rows)


def people_topics(path: Path) -> list[str]:
    """Return the topics of a bag whose messages list people with positions, in order.

    Raises:
        InputError: it cannot be read.
    """
    found: dict[str, bool] = {}
    for topic, _, message in _messages(path):
        items = next((getattr(message, n) for n in _LISTS if hasattr(message, n)), ())
        if len(items):  # an empty list shows nothing
            found[topic] = found.get(topic, True) and all(_pose(i) is not None for i in items)
    return sorted(topic for topic, people in found.items() if people)


def _messages(path: Path, topics: set[str] | None = None) -> Iterator[tuple[str, int, Any]]:
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.typesys import Stores, get_typestore

    if not path.exists():
        raise InputError(f"{path}: no such file")
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            known = {c.topic for c in reader.connections}
            for topic in sorted((topics or set()) - known):
                raise UnknownNameError("topic", topic, known)
            chosen = [c for c in reader.connections if topics is None or c.topic in topics]
            for connection, ns, raw in reader.messages(connections=chosen):
                yield connection.topic, ns, reader.deserialize(raw, connection.msgtype)
    except (AnyReaderError, FileNotFoundError) as error:
        raise InputError(f"{path}: not a bag that can be read: {error}") from error


def _stamp(message: Any, ns: int) -> int:
    """Return nanoseconds, from the header if it is filled in."""
    header = getattr(message, "header", None)
    if header is not None and (header.stamp.sec or header.stamp.nanosec):
        return 10**9 * int(header.stamp.sec) + int(header.stamp.nanosec)
    return ns


def _robot_row(path: Path, topic: str, message: Any) -> dict[str, float]:
    pose = _pose(message)
    if pose is None:
        raise InputError(f"{path}: {topic} holds {message.__msgtype__}, which has no pose")
    row = {"x": float(pose.position.x), "y": float(pose.position.y)}
    q = getattr(pose, "orientation", None)
    if q is not None and q.x**2 + q.y**2 + q.z**2 + q.w**2 > 0.5:
        row["theta"] = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y**2 + q.z**2))
    twist = getattr(getattr(message, "twist", None), "twist", None)
    if twist is not None:  # Odometry: in the robot's frame
        row |= {"v": float(twist.linear.x), "w": float(twist.angular.z)}
    return row


def _pose(item: Any) -> Any:
    """Return the part with a position, at any of the usual depths."""
    for _ in range(4):
        if hasattr(item, "position") and hasattr(item.position, "x"):
            return item
        item = getattr(item, "pose", None)
    return None


def _people_rows(path: Path, topic: str, message: Any) -> Iterator[dict[str, Any]]:
    name = next((n for n in _LISTS if hasattr(message, n)), None)
    if name is None:
        raise InputError(
            f"{path}: {topic} holds {message.__msgtype__}, which has no list of people"
        )
    for number, item in enumerate(getattr(message, name)):
        pose = _pose(item)
        if pose is None:
            raise InputError(f"{path}: {topic}: a person in '{name}' has no position")
        label = next((getattr(item, n) for n in _NAMES if hasattr(item, n)), number)
        row = {"id": _label(label), "x": float(pose.position.x), "y": float(pose.position.y)}
        yield row | _velocity(item)


def _label(label: Any) -> str:
    uuid = getattr(label, "uuid", None)
    return bytes(uuid).hex() if uuid is not None else str(label)


def _velocity(item: Any) -> dict[str, float]:
    twist = getattr(item, "twist", None)
    linear = getattr(getattr(twist, "twist", twist), "linear", None)
    linear = getattr(item, "velocity", None) if linear is None else linear
    if linear is None or not hasattr(linear, "x"):
        return {}
    return {"vx": float(linear.x), "vy": float(linear.y)}


def _table(path: Path, topic: str | None, rows: list[dict[str, Any]]) -> RawTable | None:
    if topic is None:
        return None
    if not rows:
        raise InputError(f"{path}: {topic} contains no people")
    once = {(row["t"], row.get("id")): row for row in sorted(rows, key=lambda row: row["t"])}
    rows = list(once.values())  # a repeated message adds nothing
    columns: dict[str, Cells] = {
        n: [row.get(n, math.nan) for row in rows] for n in dict.fromkeys(k for r in rows for k in r)
    }
    columns["t"] = np.array(columns["t"], dtype="datetime64[ns]")
    return RawTable(f"{path}: {topic}", columns)
