"""Covariances of odometry and IMU: by hand, and against the errors that the sensors make."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.covariance import LEAST, OdometryCovariance
from crowdbot.core.recording.topics import sensor_topics
from crowdbot.core.sensing.reading_errors import ErringSensor
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.spec.reading_errors import GaussianError, PeakError
from crowdbot.plugins.sensors.base_odometry_build import BaseOdometry
from crowdbot.plugins.sensors.imu import ImuSpec
from crowdbot.plugins.sensors.imu_build import Imu
from crowdbot.plugins.sensors.wheel_odometry import (
    BaseOdometrySpec,
    HolonomicOdometrySpec,
    WheelOdometrySpec,
)
from crowdbot.plugins.sensors.wheel_odometry_build import WheelOdometry
from crowdbot.testing.sensor_scenes import context

Six = tuple[float, float, float, float, float, float]
_PLANE = np.ix_([0, 1, 5], [0, 1, 5])


def _info(deviations: tuple[float, ...], rate: float = 10.0) -> SensorInfo:
    return SensorInfo(
        category="odometry", frame="odom", mount=(0.0, 0.0, 0.0, 0.0), rate=rate, shape=(6,),
        ros_type="nav_msgs/msg/Odometry", deviations=deviations,
    )  # fmt: skip


def _grown(steps: int, dx: float, turn: float, deviations: tuple[float, ...]) -> Any:
    covariance, x, y, yaw = OdometryCovariance(_info(deviations)), 0.0, 0.0, 0.0
    for k in range(steps + 1):
        pose, twist = covariance(k * 10**8, (x, y, yaw, dx / 0.1, turn / 0.1))
        yaw += turn
        x, y = x + dx * math.cos(yaw), y + dx * math.sin(yaw)
    return np.frombuffer(pose).reshape(6, 6), np.frombuffer(twist).reshape(6, 6)


def _message(info: SensorInfo, values: list[float], ns: int = 0) -> Any:
    topic = sensor_topics({"s": info})["s"]
    return ros.from_cdr(topic.message(ns, np.array(values)), topic.msgtype)


@given(
    st.integers(0, 200), st.floats(-0.2, 0.2), st.floats(-0.5, 0.5),
    st.tuples(
        st.floats(0, 0.1), st.floats(0, 0.1), st.floats(0, 0.01),
        st.floats(0, 0.1), st.floats(0, 0.1), st.floats(0, 0.1),
    ),
)  # fmt: skip
def test_a_covariance_is_symmetric_and_positive(
    steps: int, dx: float, turn: float, deviations: Six
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
    assert np.abs(pose[_PLANE] - sample).max() < 0.1 * np.abs(sample).max()


@pytest.mark.parametrize("speeds", [(0.4, 0.3), (0.0, 0.0)], ids=["arc", "stands"])
@pytest.mark.parametrize(
    "spec",
    [
        WheelOdometrySpec(noise=2.0),
        WheelOdometrySpec(noise=2.0, heading="gyro", gyro_noise=0.02),
        HolonomicOdometrySpec(noise=2.0, rate=32.0),
    ],
    ids=["wheels", "gyro", "holonomic"],
)
def test_wheel_odometry_errs_as_its_messages_say(
    spec: WheelOdometrySpec | HolonomicOdometrySpec, speeds: tuple[float, float]
) -> None:
    """Readings of 300 drives of one second: variances scatter by 8 % of themselves."""
    sensor, rng = WheelOdometry(spec, context()), np.random.default_rng(1)
    drives = [list(_drive(sensor, speeds, rng)) for _ in range(300)]
    encode = sensor_topics({"s": sensor.info()})["s"].message
    *_, last = [encode(ns, reading) for ns, reading in drives[0]]
    values = ros.from_cdr(last, "nav_msgs/msg/Odometry")
    sample = np.cov(np.stack([drive[-1][1] for drive in drives]).T)
    pose = values.pose.covariance.reshape(6, 6)[_PLANE]
    assert np.abs(pose - sample[:3, :3]).max() < 0.25 * np.abs(sample[:3, :3]).max()
    twist = values.twist.covariance[[0, 35, 7]]
    count = 2 + isinstance(spec, HolonomicOdometrySpec)
    assert twist[:count] == pytest.approx(np.diag(sample)[3:], rel=0.3)


def _drive(
    sensor: WheelOdometry, speeds: tuple[float, float], rng: np.random.Generator
) -> Iterator[tuple[int, Any]]:
    info, (radius, track) = sensor.info(), context().robot.wheels
    memory, (v, w) = np.zeros(info.memory), speeds
    scene = Scene(np.empty((0, 4)), [0.0, 1.0], [], [])
    for k in range(round(info.rate) + 1):
        t = k / info.rate
        left, right = ((v - side * w * track / 2) * t / radius for side in (1, -1))
        state = RobotState(0, 0, 0, 0, 0, 0, 0, 0, left, right)
        scene.update(state, np.zeros((0, 4)), np.zeros(0, dtype=np.bool_))
        yield round(t * 1e9), sensor.read(scene, Pose(0.0, 0.0, w * t), t, rng, memory)


@given(st.tuples(*[st.floats(0, 0.1)] * 6), st.floats(0.1, 1.0))
def test_every_fourth_reading_has_nearly_the_same_covariance(deviations: Six, v: float) -> None:
    """As in a live run, whose planner gets 16 of 64 readings a second."""
    found = []
    for every in (1, 4):
        covariance = OdometryCovariance(_info(deviations, 64.0))
        for k in range(0, 257, every):
            pose, twist = covariance(k * 10**9 // 64, (v * k / 64, 0.0, 0.0, v, 0.0))
        found.append(np.stack([np.frombuffer(pose), np.frombuffer(twist)]))
    assert found[1] == pytest.approx(found[0], rel=0.03, abs=1e-3 * found[0].max() + 1e-9)


def test_the_same_reading_again_changes_nothing() -> None:
    covariance = OdometryCovariance(_info((0.05, 0.0, 0.01)))
    covariance(0, (0.0, 0.0, 0.0, 1.0, 0.0))
    first = covariance(10**8, (0.1, 0.0, 0.0, 1.0, 0.0))
    assert covariance(10**8, (0.1, 0.0, 0.0, 1.0, 0.0)) == first


@pytest.mark.parametrize(
    "info",
    [BaseOdometry(BaseOdometrySpec()).info(), WheelOdometry(WheelOdometrySpec(), context()).info()],
    ids=["base", "wheels"],
)
def test_without_noise_it_is_unknown(info: SensorInfo) -> None:
    message = _message(info, [1.0, 0.0, 0.0, 0.5, 0.0, 0.0][: info.shape[0]])
    assert not message.pose.covariance.any()
    assert not message.twist.covariance.any()


def test_errors_of_readings_are_in_the_covariance_and_do_not_add_up() -> None:
    """A peak of 1 ± 0.5 in one of ten readings: 0.1 · 1.25 − 0.1², by its definition."""
    shaken = ErringSensor(
        BaseOdometry(BaseOdometrySpec()),
        [
            GaussianError(std=0.03, entries=(0, 1)),
            GaussianError(std=0.04, entries=(0,)),
            PeakError(probability=0.1, mean=1.0, std=0.5, entries=(4,)),
        ],
    )
    encode = sensor_topics({"s": shaken.info()})["s"].message
    for k in range(3):
        data = encode(k * 10**9, np.array([float(k), 0.0, 0.0, 1.0, 0.0, 0.0]))
        message = ros.from_cdr(data, "nav_msgs/msg/Odometry")
        pose = message.pose.covariance.reshape(6, 6).diagonal() - LEAST
        twist = message.twist.covariance.reshape(6, 6).diagonal() - LEAST
        assert pose == pytest.approx([0.05**2, 0.03**2, 0, 0, 0, 0], rel=1e-3, abs=1e-12)
        assert twist == pytest.approx([0, 0, 0, 0, 0, 0.115], rel=1e-3, abs=1e-12)


def test_an_imu_knows_its_noise_and_its_errors() -> None:
    imu = Imu(ImuSpec(rate=64.0))
    assert imu.info().deviations == pytest.approx((5.2e-4 * 8.0, 3.9e-3 * 8.0))
    shaken = ErringSensor(imu, [GaussianError(std=0.5, entries=(5,))])
    message = _message(shaken.info(), [0.0] * 6)
    rate, force = message.angular_velocity_covariance, message.linear_acceleration_covariance
    own = (3.9e-3 * 8.0) ** 2
    assert rate.reshape(3, 3) == pytest.approx(np.diag([(5.2e-4 * 8.0) ** 2] * 3))
    assert force.reshape(3, 3) == pytest.approx(np.diag([own, own, own + 0.25]))
    unknown = _message(replace(imu.info(), deviations=()), [0.0] * 6)
    assert not unknown.angular_velocity_covariance.any()
