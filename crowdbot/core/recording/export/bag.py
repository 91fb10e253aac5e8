"""Export recordings as bags of ROS 2 (a folder) and ROS 1 (a file)."""

from __future__ import annotations

import heapq
import shutil
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.export.extras import OFTEN, Extra, arrival, extras
from crowdbot.core.recording.export.stamps import moved
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.scenery import BASE
from crowdbot.core.recording.topics import Topic, sensor_topics, usual_names
from crowdbot.errors import InputError

Tree = Literal["truth", "odometry"]
_FOREVER = QosTime(2147483647, 4294967295)
_TF, _ODOMETRY = "tf2_msgs/msg/TFMessage", "nav_msgs/msg/Odometry"
_LATCHED = (
    Topic.HEADER, Topic.END, Topic.TF_STATIC, Topic.WALLS, Topic.GOAL, Topic.GOAL_POSE, Topic.MAP,
    Topic.DESCRIPTION,
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class BagOptions:
    """Options of an exported bag: times, transforms, names and extras.

    Attributes:
        offset: ns added to all times.
        tree: pose in ``/tf``: the true one, or that of odometry below ``odom``.
        ros_names: True to use the usual ROS names of topics.
        markers: True to add a marker per person and contact.
        description: the robot's URDF, if it is known.
    """

    offset: int = 0
    tree: Tree = "truth"
    ros_names: bool = True
    markers: bool = True
    description: str | None = None


class _Message(NamedTuple):
    ns: int
    order: int
    topic: str
    msgtype: str
    data: bytes
    latched: bool


def write_ros2(path: Path, out: Path, options: BagOptions) -> int:
    """Write a folder with ``metadata.yaml`` (version 8) and an MCAP file; return the message count.

    Raises:
        InputError: not a crowdbot recording, the folder exists, or odometry was not recorded.
    """
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(out, version=8, storage_plugin=StoragePlugin.MCAP) as bag:
        return _write(bag, path, options)


def write_ros1(path: Path, out: Path, options: BagOptions) -> int:
    """Write a ROS 1 bag with noetic's types; return the message count.

    Raises:
        InputError: not a crowdbot recording, or it cannot be written.
    """
    from rosbags.convert.converter import convert

    folder = out.with_name(f".{out.name}.ros2")
    bag = folder / "ros1.bag"  # the converter uses the suffix
    shutil.rmtree(folder, ignore_errors=True)
    try:
        folder.mkdir(parents=True)
        count = write_ros2(path, folder / "ros2", options)
        store = ros.ros1_store()
        convert([folder / "ros2"], bag, "", 0, None, "", None, store, [], [], [], [])
        bag.rename(out)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return count


def _write(bag: Any, path: Path, options: BagOptions) -> int:
    connections: dict[str, Any] = {}
    count = 0
    for message in _merged(path, options):
        connection = connections.get(message.topic)
        if connection is None:
            connection = connections[message.topic] = bag.add_connection(
                message.topic,
                message.msgtype,
                typestore=ros.ros2_store(),
                offered_qos_profiles=[_qos(latched=message.latched)],
            )
        data = moved(message.data, message.msgtype, options.offset)
        bag.write(connection, message.ns + options.offset, data)
        count += 1
    return count


def _merged(path: Path, options: BagOptions) -> Iterator[_Message]:
    """Yield recorded and added messages, in order of time."""
    with Recording(path) as recording:
        info, run = recording.info, recording.trajectories()
    header = info.header
    if options.tree == "odometry" and "/odom" not in info.topics:
        raise InputError(f"{path}: there is no /odom in it; --record none leaves odometry out")
    counts = {topic: count for topic, (_, count) in info.topics.items()}
    lacking = _lacking(counts, len(run.t), options)
    every = extras(header, run, options.description, markers=options.markers)
    added = [extra for extra in every if lacking(extra.topic)]
    instead = dict.fromkeys(topic for topic in OFTEN if any(e.topic == topic for e in added))
    names = _names(header, options, info.topics) | instead
    recorded = _recorded(path, set(info.topics), names, options)
    at_goal = [e for e in arrival(header, run) if e.topic != Topic.TF or options.tree == "truth"]
    yield from heapq.merge(_sorted(recorded), _sorted(_added([*added, *at_goal])))


def _lacking(topics: Mapping[str, int], samples: int, options: BagOptions) -> Callable[[str], bool]:
    """Return a test for topics to add: not recorded, or not at every sample."""

    def lacking(topic: str) -> bool:
        if topic == Topic.TF and options.tree == "odometry":
            return False
        return topics.get(topic, 0) < (samples if topic in OFTEN else 1)

    return lacking


def _sorted(messages: Iterable[_Message]) -> list[_Message]:
    """Sort messages by time: a recording writes a second at once."""
    return sorted(messages, key=lambda m: m.ns)


def _added(found: Iterable[Extra]) -> Iterator[_Message]:
    for k, extra in enumerate(found):
        yield _Message(extra.ns, k, extra.topic, extra.msgtype, extra.data, extra.latched)


def _recorded(
    path: Path, topics: Container[str], names: Mapping[str, str | None], options: BagOptions
) -> Iterator[_Message]:
    """Yield the recorded messages; ``names``: other names of topics, None drops one."""
    derived = options.tree == "odometry" and Topic.TF_ODOMETRY not in topics
    records = Records(path)
    for k, record in enumerate(records):
        _declare(records, record)
        topic, latched = names.get(record.topic, record.topic), record.topic in _LATCHED
        if topic is not None:
            yield _Message(record.ns, k, topic, record.msgtype, record.data, latched)
        if derived and record.msgtype == _ODOMETRY and record.topic == "/odom":
            data = _believed(record.data)
            yield _Message(record.ns, k, str(Topic.TF), _TF, data, False)


def _declare(records: Records, record: Record) -> None:
    """Register the type of a message as the recording describes it: a plugin's is in no store."""
    schema = None
    if ros.field_types(record.msgtype) is None:
        schema = records.channel(record.topic).schema
    if schema is not None:
        try:
            ros.declare({schema.name: schema.data.decode()})
        except ValueError as error:
            raise InputError(f"{record.topic}: {error}") from error


def _believed(data: bytes) -> bytes:
    """Return the transform ``odom`` to ``base_footprint`` of an odometry message."""
    odometry = ros.from_cdr(data, _ODOMETRY)
    at = odometry.pose.pose
    stamped = ros.transform(0, "odom", BASE, (at.position.x, at.position.y, at.position.z), 0.0)
    stamped.header, stamped.transform.rotation = odometry.header, at.orientation
    return ros.to_cdr(ros.transforms([stamped]))


def _names(
    header: RecordingHeader, options: BagOptions, topics: Container[str]
) -> dict[str, str | None]:
    """Return recorded topics -> those of the bag; None: dropped as a duplicate."""
    names: dict[str, str | None] = {}
    if options.tree == "odometry":
        names = {Topic.TF: None, Topic.TF_ODOMETRY: str(Topic.TF)}
    if not options.markers:
        names |= {Topic.PEOPLE_MARKERS: None, Topic.CONTACT_MARKERS: None}
    usual = usual_names(header.sensors)
    for sensor, topic in sensor_topics(header.sensors).items():
        if sensor not in usual:
            continue
        twice, there = topic.name, usual[sensor]
        if not options.ros_names:
            names[there] = None
        elif twice != there:
            names[twice] = None if there in topics else there
    for name in header.sensors if options.ros_names else ():
        for leaf in ("image_raw", "camera_info"):
            names[f"/{name}/colour/{leaf}"] = f"/{name}/color/{leaf}"  # in older recordings
    return names


def _qos(*, latched: bool) -> Qos:
    return Qos(
        QosHistory.KEEP_LAST if latched else QosHistory.UNKNOWN,
        1 if latched else 0,
        QosReliability.RELIABLE,
        QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE,
        _FOREVER,
        _FOREVER,
        QosLiveliness.AUTOMATIC,
        _FOREVER,
        False,
    )
