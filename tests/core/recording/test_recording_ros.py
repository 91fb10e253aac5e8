"""Others read our recordings: rosbags, mcap and mcap_ros2 are the oracles."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability

from crowdbot.core.recording.definitions import DEFINITIONS
from crowdbot.core.recording.topics import sensor_topics
from crowdbot.plugin import SensorInfo
from tests.core.recording.recording_cases import ANGLES, ODOMETRY, random_run, write_run
from tests.paths import ROOT

RUN = random_run()
N = len(RUN.t)
EXPECTED = {
    "/clock": ("rosgraph_msgs/msg/Clock", N),
    "/cmd_vel": ("geometry_msgs/msg/Twist", N),
    "/contact_markers": ("visualization_msgs/msg/MarkerArray", 2),
    "/contacts": ("crowdbot_msgs/msg/Contact", 2),
    "/crowdbot/end": ("crowdbot_msgs/msg/RunEnd", 1),
    "/crowdbot/header": ("crowdbot_msgs/msg/RunHeader", 1),
    "/crowdbot/planner_time": ("crowdbot_msgs/msg/Series", 1),
    "/crowdbot/signal": ("crowdbot_msgs/msg/Series", 1),
    "/crowdbot/state": ("crowdbot_msgs/msg/RunStates", 1),
    "/crowdbot/trip": ("crowdbot_msgs/msg/Trip", 2),
    "/front/scan": ("sensor_msgs/msg/LaserScan", N),
    "/goal_pose": ("geometry_msgs/msg/PoseStamped", 1),
    "/goal_zone": ("geometry_msgs/msg/PolygonStamped", 1),
    "/map": ("nav_msgs/msg/OccupancyGrid", 1),
    "/nose": ("std_msgs/msg/Float64MultiArray", N),
    "/odom": ("nav_msgs/msg/Odometry", 4 * N),
    "/pedestrians": ("crowdbot_msgs/msg/Pedestrians", N),
    "/pedestrians_marker": ("visualization_msgs/msg/Marker", N),
    "/people_markers": ("visualization_msgs/msg/MarkerArray", -(-N // 4)),
    "/robot/path": ("nav_msgs/msg/Path", 1),
    "/robot_description": ("std_msgs/msg/String", 1),
    "/scan": ("sensor_msgs/msg/LaserScan", N),
    "/tf_odometry": ("tf2_msgs/msg/TFMessage", 4 * N),
    "/robot/pose": ("geometry_msgs/msg/PoseStamped", N),
    "/tf": ("tf2_msgs/msg/TFMessage", N),
    "/tf_static": ("tf2_msgs/msg/TFMessage", 1),
    "/walls_marker": ("visualization_msgs/msg/Marker", 1),
}


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ros") / "run.mcap"
    write_run(path, RUN)
    return path


@pytest.fixture(scope="module")
def decoded(path: Path) -> dict[str, list[Any]]:
    """Topic -> (log time in ns, message), decoded by mcap_ros2 with CRCs checked."""
    topics: dict[str, list[Any]] = {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for item in reader.iter_decoded_messages():
            topics.setdefault(item.channel.topic, []).append(
                (item.message.log_time, item.decoded_message)
            )
    return topics


def test_rosbags_opens_the_file(path: Path) -> None:
    with AnyReader([path]) as reader:
        found = {c.topic: (c.msgtype, c.msgcount) for c in reader.connections}
        assert found == EXPECTED
        for connection, _, raw in reader.messages():
            reader.deserialize(raw, connection.msgtype)
        durability = {c.topic: c.ext.offered_qos_profiles[0].durability for c in reader.connections}  # type: ignore[union-attr]
    latched = {t for t, d in durability.items() if d == QosDurability.TRANSIENT_LOCAL}
    assert latched == {
        "/crowdbot/header",
        "/crowdbot/end",
        "/goal_pose",
        "/goal_zone",
        "/map",
        "/robot_description",
        "/tf_static",
        "/walls_marker",
    }


def test_mcap_ros2_decodes_every_message(decoded: dict[str, list[Any]]) -> None:
    assert {t: len(m) for t, m in decoded.items()} == {t: n for t, (_, n) in EXPECTED.items()}


def test_profile_and_checksums(path: Path) -> None:
    with path.open("rb") as file:
        head = NonSeekingReader(file).get_header()
    assert (head.profile, head.library) == ("ros2", "crowdbot")
    with path.open("rb") as file:
        assert sum(1 for _ in NonSeekingReader(file, validate_crcs=True).iter_messages()) == sum(
            n for _, n in EXPECTED.values()
        )
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    assert all(c.compression == "zstd" for c in summary.chunk_indexes)


def test_stamps_are_simulated_time(decoded: dict[str, list[Any]]) -> None:
    for k, (ns, clock) in enumerate(decoded["/clock"]):
        assert ns == round(RUN.t[k] * 1e9)
        assert max(ns, 1) == clock.clock.sec * 10**9 + clock.clock.nanosec
    for ns, odom in decoded["/odom"]:  # 0 would be "the latest" to tf2
        assert odom.header.stamp.sec * 10**9 + odom.header.stamp.nanosec == max(ns, 1)


def test_truth_is_in_tf_and_pose(decoded: dict[str, list[Any]]) -> None:
    assert RUN.robot is not None
    for row, (_, tf), (_, pose) in zip(
        RUN.robot, decoded["/tf"], decoded["/robot/pose"], strict=True
    ):
        (item,) = tf.transforms
        assert (item.header.frame_id, item.child_frame_id) == ("map", "base_footprint")
        for place, turn in (
            (item.transform.translation, item.transform.rotation),
            (pose.pose.position, pose.pose.orientation),
        ):
            assert (place.x, place.y, place.z) == (row[0], row[1], 0.0)
            assert 2.0 * math.atan2(turn.z, turn.w) == pytest.approx(row[2], abs=1e-12)


def test_the_frames_form_one_tree(decoded: dict[str, list[Any]]) -> None:
    ((_, static),) = decoded["/tf_static"]
    parents = {i.child_frame_id: i.header.frame_id for i in static.transforms}
    assert parents == {
        "odom": "map",
        "base_link": "base_footprint",
        "front_lidar": "base_link",
        "nose": "base_link",
    }
    lidar = next(i for i in static.transforms if i.child_frame_id == "front_lidar").transform
    assert (lidar.translation.x, lidar.translation.y, lidar.translation.z) == (0.1, 0.02, 0.3)
    assert 2.0 * math.atan2(lidar.rotation.z, lidar.rotation.w) == pytest.approx(0.5)


def test_scan_values(decoded: dict[str, list[Any]]) -> None:
    _, scan = decoded["/front/scan"][3]
    beams = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    assert np.allclose(beams, ANGLES, atol=1e-6)
    assert scan.angle_max == pytest.approx(ANGLES[-1])
    assert (scan.range_min, scan.range_max) == (pytest.approx(0.1), 10.0)
    assert np.array_equal(scan.ranges, np.where(ANGLES > 0.0, 1.0 + RUN.t[3], np.inf))


def test_odometry_command_and_unknown_sensor(decoded: dict[str, list[Any]]) -> None:
    assert RUN.robot is not None
    _, odom = decoded["/odom"][20]
    x, y, yaw, v, w = RUN.robot[5] + 0.01
    turn = odom.pose.pose.orientation
    assert (odom.pose.pose.position.x, odom.pose.pose.position.y) == (x, y)
    assert 2.0 * math.atan2(turn.z, turn.w) == pytest.approx(yaw)
    assert (odom.twist.twist.linear.x, odom.twist.twist.angular.z) == (v, w)
    assert (odom.header.frame_id, odom.child_frame_id) == ("odom", "base_footprint")
    _, command = decoded["/cmd_vel"][0]
    assert (command.linear.x, command.angular.z) == (0.4, -0.2)
    _, smell = decoded["/nose"][2]
    assert [(d.size, d.stride) for d in smell.layout.dim] == [(2, 6), (3, 3)]
    assert np.array_equal(smell.data, np.arange(6.0) + RUN.t[2])


def test_people_as_columns_and_as_spheres(decoded: dict[str, list[Any]]) -> None:
    assert RUN.agents is not None
    counts = set()
    for state, (ns, people), (at, marker) in zip(
        RUN.agents, decoded["/pedestrians"], decoded["/pedestrians_marker"], strict=True
    ):
        there = ~np.isnan(state[0])
        counts.add(int(there.sum()))
        x, y, vx, vy = state[:, there]
        assert list(people.id) == [100 + 3 * i for i in np.flatnonzero(there)]
        for column, values in ((people.x, x), (people.y, y), (people.vx, vx), (people.vy, vy)):
            assert np.array_equal(column, np.rint(values * 1024.0) / 1024.0)
        assert np.allclose(people.radius, 0.33)
        fast = np.hypot(vx, vy) > 0.1
        assert np.allclose(np.array(people.heading)[fast], np.arctan2(vy, vx)[fast], atol=5e-4)
        points = np.array([(p.x, p.y, p.z) for p in marker.points])
        assert np.abs(points[:, :2] - np.column_stack((x, y))).max() <= 0.5 / 1024
        assert ns == at
        assert max(ns, 1) == marker.header.stamp.sec * 10**9 + marker.header.stamp.nanosec
        assert (marker.type, marker.ns, marker.header.frame_id) == (7, "people", "map")
        assert (marker.colors, marker.text) == ([], "")
    assert counts == {6, 7}


def test_walls_and_goal(decoded: dict[str, list[Any]]) -> None:
    ((_, walls),), ((_, goal),) = decoded["/walls_marker"], decoded["/goal_zone"]
    assert [(p.x, p.y) for p in walls.points] == [(0, -5), (50, -5), (0, 5), (50, 5)]
    assert walls.type == 5
    assert [(p.x, p.y) for p in goal.polygon.points] == [(45, -2), (48, -2), (48, 2), (45, 2)]


def test_topics_of_unusual_sensors() -> None:
    uneven = SensorInfo(
        category="lidar",
        frame="l",
        mount=(0.0, 0.0, 0.0, 0.0),
        rate=1.0,
        shape=(3,),
        ros_type="",
        angles=np.array([0.0, 0.1, 0.5]),
    )
    topics = sensor_topics({"l": uneven, "a": ODOMETRY, "b": ODOMETRY})
    assert {k: t.name for k, t in topics.items()} == {"l": "/l", "a": "/odom", "b": "/b/odom"}


def test_the_reference_page_lists_every_topic_and_type() -> None:
    page = ROOT / "docs" / "reference" / "recording.md"
    text = page.read_text(encoding="utf-8")
    for topic, (msgtype, _) in EXPECTED.items():
        if topic not in ("/front/scan", "/nose"):  # named by the scenario
            assert f"`{topic}`" in text
        assert f"`{msgtype.replace('/msg/', '/')}`" in text
    for name, definition in DEFINITIONS.items():
        assert f"# crowdbot_msgs/{name}\n{definition}\n" in text
