"""The IMU against closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.errors import SimulationError
from crowdbot.plugin import Pose, RobotState, TiltableMount
from crowdbot.plugins.sensors.imu import IMU, ImuSpec
from crowdbot.plugins.sensors.imu_build import build
from crowdbot.testing.sensor_scenes import context

Array = NDArray[np.float64]
G = 9.81
#: t to yaw, vx, vy, w; world frame.
Motion = Callable[[float], tuple[float, float, float, float]]


def quiet(**fields: Any) -> ImuSpec:
    """An IMU without white noise."""
    return ImuSpec(gyro_noise=0.0, force_noise=0.0, **fields)


def readings(spec: ImuSpec, motion: Motion, count: int = 20) -> Array:
    imu, scene = build(spec, context()), Scene([], [0, 1], [], [])
    memory, rows = np.zeros(imu.info().memory), []
    for k in range(count):
        yaw, vx, vy, w = motion(k / spec.rate)
        scene.move_robot(RobotState(0, 0, yaw, vx, vy, w, 0, 0, 0, 0))
        rng = sensor_rng(0, "robot", "imu", k)
        rows.append(imu.read(scene, Pose(0, 0, yaw), k / spec.rate, rng, memory))
    return np.array(rows)


def turning(v: float, w: float) -> Motion:
    return lambda t: (w * t, v * math.cos(w * t), v * math.sin(w * t), w)


def test_info() -> None:
    info = build(ImuSpec(mount=TiltableMount(x=0.056, y=0.062, z=0.0202)), context()).info()
    assert (info.category, info.ros_type, info.shape) == ("imu", "sensor_msgs/msg/Imu", (6,))
    assert (info.random, info.sees) == (True, False)
    assert build(quiet(), context()).info().random is False
    assert load_build(IMU) is build


def test_at_rest_it_feels_the_floor() -> None:
    rows = readings(quiet(), lambda _: (1.0, 0.0, 0.0, 0.0))
    np.testing.assert_array_equal(rows, np.broadcast_to([0, 0, 0, 0, 0, G], rows.shape))


@settings(max_examples=40)
@given(
    st.floats(-0.65, 0.65), st.floats(-3.0, 3.0), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2),
    st.floats(-3.1, 3.1),
)  # fmt: skip
def test_a_constant_turn(v: float, w: float, x: float, y: float, yaw: float) -> None:
    """Towards the centre of the circle: v w to the left, less w^2 r of the mount itself."""
    rows = readings(quiet(mount=TiltableMount(x=x, y=y, yaw=yaw)), turning(v, w))[1:]
    forward, left = -w * w * x, v * w - w * w * y
    c, s = math.cos(yaw), math.sin(yaw)
    expected = [0, 0, w, c * forward + s * left, c * left - s * forward, G]
    doubt = (abs(v * w) + w * w * 0.3) * (w / 64.0) ** 2 / 12.0 + 1e-9
    np.testing.assert_allclose(rows, np.broadcast_to(expected, rows.shape), atol=doubt)


def test_braking_is_felt_backwards() -> None:
    rows = readings(quiet(), lambda t: (0.5, *_along(0.5, 0.6 - 1.0 * t), 0.0))
    np.testing.assert_allclose(rows[1:, 3], -1.0, atol=1e-9)
    np.testing.assert_allclose(rows[1:, 4], 0.0, atol=1e-9)


def _along(yaw: float, v: float) -> tuple[float, float]:
    return v * math.cos(yaw), v * math.sin(yaw)


def test_yaw_acceleration_is_felt_beside_the_axis() -> None:
    """At 0.1 m ahead, 2 rad/s^2 push 0.2 m/s^2 to the left; a small turn hardly bends it."""
    rows = readings(
        quiet(mount=TiltableMount(x=0.1)), lambda t: (t * t, 0.0, 0.0, 2.0 * t), count=5
    )
    np.testing.assert_allclose(rows[1:, 4], 0.2, rtol=2e-3)


def test_through_pi_nothing_jumps() -> None:
    rows = readings(quiet(), lambda t: (_wrap(3.1 + t), *_along(3.1 + t, 0.5), 1.0))
    np.testing.assert_allclose(rows[1:, 4], 0.5, rtol=1e-4)
    np.testing.assert_allclose(rows[1:, 3], 0.0, atol=1e-9)


def _wrap(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def test_white_noise_has_the_density() -> None:
    spec = ImuSpec(rate=50.0, gyro_noise=0.01, force_noise=0.1)
    rows = readings(spec, lambda _: (0.0, 0.0, 0.0, 0.0), count=4000)
    rows[:, 5] -= G
    root = math.sqrt(50.0)
    for k in range(6):
        std = (0.01 if k < 3 else 0.1) * root
        assert rows[:, k].std() == pytest.approx(std, rel=0.05)
        assert abs(rows[:, k].mean()) < 4 * std / math.sqrt(4000)
    assert np.max(np.abs(np.corrcoef(rows.T) - np.eye(6))) < 0.08


def test_bias_stays_and_walks() -> None:
    still = readings(quiet(gyro_bias=0.02, force_bias=0.3), lambda _: (0, 0, 0, 0))
    assert np.ptp(still, axis=0) == pytest.approx(np.zeros(6), abs=1e-12)
    assert np.all(still[0, :3] != 0.0)
    assert np.abs(still[0, :3]).max() < 0.1
    walk = readings(quiet(gyro_walk=0.05, force_walk=0.5), lambda _: (0, 0, 0, 0), 6000)
    steps = np.diff(walk, axis=0)
    for k in range(6):
        expected = (0.05 if k < 3 else 0.5) * math.sqrt(1 / 64)
        assert steps[:, k].std() == pytest.approx(expected, rel=0.05)
    assert walk[0] == pytest.approx([0, 0, 0, 0, 0, G])


def test_reading_twice_at_one_instant() -> None:
    imu, scene = build(ImuSpec(gyro_walk=0.1), context()), Scene([], [0, 1], [], [])
    scene.move_robot(RobotState(0, 0, 0, 0.3, 0, 0, 0, 0, 0, 0))
    memory = np.zeros(imu.info().memory)
    one, two = (
        imu.read(scene, Pose(0, 0, 0), 0.0, np.random.default_rng(k), memory) for k in range(2)
    )
    np.testing.assert_array_equal(one, two)


def test_needs_a_robot() -> None:
    imu = build(ImuSpec(), context())
    with pytest.raises(SimulationError, match="robot"):
        imu.read(
            Scene([], [0, 1], [], []), Pose(0, 0, 0), 0.0, np.random.default_rng(0), np.zeros(17)
        )
