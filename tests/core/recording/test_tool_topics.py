"""What a recording has for viewers and ROS: path, arrows, contacts, frames, names."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.highlevel import AnyReader

from crowdbot.core.recording.viewers import PeopleArrows, RobotPath
from tests.core.recording.recording_cases import URDF, random_run, write_run

RUN = random_run()


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    path = tmp_path_factory.mktemp("tools") / "run.mcap"
    write_run(path, RUN)
    messages: dict[str, list[Any]] = {}
    with AnyReader([path]) as reader:
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            messages.setdefault(connection.topic, []).append(message)
    return messages


def test_the_robot_is_described(found: dict[str, list[Any]]) -> None:
    ((text,),) = ([m.data for m in found["/robot_description"]],)
    assert text == URDF


def test_the_first_lidar_is_scan(found: dict[str, list[Any]]) -> None:
    for one, two in zip(found["/scan"], found["/front/scan"], strict=True):
        assert one.ranges.tobytes() == two.ranges.tobytes()
        assert one.header == two.header


def test_odometry_has_a_frame_of_its_own(found: dict[str, list[Any]]) -> None:
    for tf, odom in zip(found["/tf_odometry"], found["/odom"], strict=True):
        (item,) = tf.transforms
        assert (item.header.frame_id, item.child_frame_id) == ("odom", "base_footprint")
        assert item.header.stamp == odom.header.stamp
        assert item.transform.translation.x == odom.pose.pose.position.x
        assert item.transform.rotation == odom.pose.pose.orientation


def test_no_stamp_of_a_moving_frame_is_zero(found: dict[str, list[Any]]) -> None:
    for topic in ("/tf", "/tf_odometry"):
        for message in found[topic]:
            stamp = message.transforms[0].header.stamp
            assert stamp.sec * 10**9 + stamp.nanosec > 0


def test_a_contact_is_where_it_began(found: dict[str, list[Any]]) -> None:
    first, second = (m.markers[0] for m in found["/contact_markers"])
    assert (first.text, second.text) == ("person 103", "wall")
    assert (first.id, second.id) == (0, 1)
    assert RUN.robot is not None
    t = first.header.stamp.sec + first.header.stamp.nanosec / 1e9
    assert t == pytest.approx(0.3)
    assert first.pose.position.x == pytest.approx(np.interp(t, RUN.t, RUN.robot[:, 0]))


@given(
    st.integers(0, 5),
    st.integers(0, 2**32 - 1),
)
def test_every_person_has_its_arrow(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    state = rng.normal(0.0, 2.0, (4, count))
    state[:, rng.random(count) < 0.3] = np.nan
    there = np.flatnonzero(np.isfinite(state[0]))
    ids, radius = rng.integers(-5, 1000, count), rng.uniform(0.2, 0.5, count)
    from crowdbot.core.recording import messages as ros

    arrows = PeopleArrows(ids, radius)
    message = ros.from_cdr(arrows.message(7, state), "visualization_msgs/msg/MarkerArray")
    gone, *markers = message.markers
    assert gone.action == gone.DELETEALL
    assert [m.id for m in markers] == ids[there].tolist()
    for m, i in zip(markers, there, strict=True):
        assert (m.header.stamp.nanosec, m.type, m.header.frame_id) == (7, m.ARROW, "map")
        assert (m.pose.position.x, m.pose.position.y) == pytest.approx(state[:2, i], abs=5e-4)
        speed = float(np.hypot(*state[2:, i]))
        assert m.scale.x == pytest.approx(max(speed, 0.1), abs=5e-4)
        assert m.scale.y == pytest.approx(2.0 * radius[i], abs=5e-4)
        if speed > 0.1:
            yaw = 2.0 * math.atan2(m.pose.orientation.z, m.pose.orientation.w)
            assert math.remainder(yaw - math.atan2(*state[3:1:-1, i]), 2 * math.pi) == (
                pytest.approx(0.0, abs=1e-3)
            )


def test_a_path_grows_by_two_poses_a_second() -> None:
    way = RobotPath(0.2)
    for k in range(65):
        way.add(k / 16, 0.05 * k, 0.0, 0.1)
    poses = way.path(4 * 10**9).poses
    assert [p.header.stamp.sec + p.header.stamp.nanosec / 1e9 for p in poses] == [
        0.5 * k for k in range(9)
    ]
    assert poses[-1].pose.position.x == pytest.approx(3.2, abs=5e-4)
