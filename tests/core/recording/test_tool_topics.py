"""What a recording has for viewers and ROS: path, arrows, contacts, frames, names, covariances."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.highlevel import AnyReader

from crowdbot.core.recording.covariance import LEAST, OdometryCovariance
from crowdbot.core.recording.viewers import PeopleArrows, RobotPath
from crowdbot.testing.sensor_scenes import context
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


# ------------------------------------------------------------------------- covariances
def _grown(steps: int, dx: float, turn: float, deviations: tuple[float, float, float]) -> Any:
    covariance, x, y, yaw = OdometryCovariance(deviations), 0.0, 0.0, 0.0
    for k in range(steps + 1):
        pose, twist = covariance(k * 10**8, (x, y, yaw, dx / 0.1, turn / 0.1))
        yaw += turn
        x, y = x + dx * math.cos(yaw), y + dx * math.sin(yaw)
    return np.frombuffer(pose).reshape(6, 6), np.frombuffer(twist).reshape(6, 6)


@given(
    st.integers(0, 200), st.floats(-0.2, 0.2), st.floats(-0.5, 0.5),
    st.tuples(st.floats(0, 0.1), st.floats(0, 0.1), st.floats(0, 0.01)),
)  # fmt: skip
def test_a_covariance_is_symmetric_and_positive(
    steps: int, dx: float, turn: float, deviations: tuple[float, float, float]
) -> None:
    for matrix in _grown(steps, dx, turn, deviations):
        assert np.array_equal(matrix, matrix.T)
        scale = max(float(np.abs(matrix).max()), LEAST)
        assert np.linalg.eigvalsh(matrix).min() > -2e-3 * scale
        assert matrix.diagonal().min() >= LEAST


def test_straight_ahead_it_is_as_computed_by_hand() -> None:
    """100 steps of 0.1 m: sqrt(100) * 0.02 * 0.1 m along; the turn's drift 0.01 sqrt(10)."""
    pose, twist = _grown(100, 0.1, 0.0, (0.02, 0.0, 0.01))
    assert pose[0, 0] - LEAST == pytest.approx(100 * (0.02 * 0.1) ** 2, rel=1e-3)
    assert pose[5, 5] - LEAST == pytest.approx(0.01**2 * 10.0, rel=1e-3)
    # y drifts as the integral of a random walk: q * sum of (0.1 k)^2 * dt
    expected = 0.01**2 * 0.1 * sum((0.1 * k) ** 2 for k in range(100))
    assert pose[1, 1] - LEAST == pytest.approx(expected, rel=2e-3)
    assert twist[0, 0] - LEAST == pytest.approx((0.02 * 1.0) ** 2, rel=1e-3)
    assert twist[5, 5] - LEAST == pytest.approx(0.01**2 / 0.1, rel=1e-3)


def test_it_agrees_with_many_noisy_drives() -> None:
    """A turn to the left at 1 m/s: sample covariance of 4000 drives within 10 %."""
    deviations, steps, dx, turn, dt = (0.05, 0.02, 0.03), 60, 0.1, 0.04, 0.1
    pose, _ = _grown(steps, dx, turn, deviations)
    rng = np.random.default_rng(0)
    x = y = yaw = np.zeros(4000)
    for _ in range(steps):
        gone = dx * (1.0 + deviations[0] * rng.standard_normal(4000))
        drift = math.hypot(deviations[1] * dx, deviations[2] * math.sqrt(dt))
        yaw = yaw + turn
        x, y = x + gone * np.cos(yaw), y + gone * np.sin(yaw)
        yaw = yaw + drift * rng.standard_normal(4000)
    sample = np.cov(np.stack([x, y, yaw]))
    mine = pose[np.ix_([0, 1, 5], [0, 1, 5])]
    assert np.abs(mine - sample).max() < 0.1 * np.abs(sample).max()


def test_the_same_reading_again_changes_nothing() -> None:
    covariance = OdometryCovariance((0.05, 0.0, 0.01))
    covariance(0, (0.0, 0.0, 0.0, 1.0, 0.0))
    first = covariance(10**8, (0.1, 0.0, 0.0, 1.0, 0.0))
    assert covariance(10**8, (0.1, 0.0, 0.0, 1.0, 0.0)) == first


def test_what_is_not_known_is_zero(found: dict[str, list[Any]]) -> None:
    assert not any(m.pose.covariance.any() or m.twist.covariance.any() for m in found["/odom"])


def test_odometry_and_imu_know_their_noise() -> None:
    from crowdbot.plugins.sensors.imu import ImuSpec
    from crowdbot.plugins.sensors.imu_build import Imu
    from crowdbot.plugins.sensors.wheel_odometry import WheelOdometrySpec
    from crowdbot.plugins.sensors.wheel_odometry_build import WheelOdometry

    imu = Imu(ImuSpec(rate=64.0)).info()
    assert imu.deviations == pytest.approx((5.2e-4 * 8.0, 3.9e-3 * 8.0))
    assert len(WheelOdometry(WheelOdometrySpec(), context()).info().deviations) == 3
