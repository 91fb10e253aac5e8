"""Wheel odometry against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.errors import SimulationError
from crowdbot.plugin import Pose, RobotState
from crowdbot.plugins.sensors.wheel_odometry import WHEEL_ODOMETRY, WheelOdometrySpec
from crowdbot.plugins.sensors.wheel_odometry_build import build
from crowdbot.testing.sensor_scenes import context

SPEC = WheelOdometrySpec()
WHEEL_RADIUS, TRACK = context().robot.wheels
TICK = 2 * math.pi * WHEEL_RADIUS / SPEC.ticks_per_turn
DT = 1 / 64
Array = NDArray[np.float64]
START = Pose(2.5, -1.0, 0.7)


def drive(left: Array, right: Array, spec: WheelOdometrySpec = SPEC, start: Pose = START) -> Array:
    """Readings (N, 5) for wheel angles (N,), rad."""
    sensor, scene = build(spec, context()), Scene(np.empty((0, 4)), [0.0, 1.0], [], [])
    memory, readings = np.zeros(sensor.info().memory), []
    for k, (a, b) in enumerate(zip(left, right, strict=True)):
        state = RobotState(9, 9, 9, 0, 0, 0, 0, 0, float(a), float(b))
        scene.update(state, np.zeros((0, 4)), np.zeros(0, dtype=np.bool_))
        rng = sensor_rng(0, "robot", "odometry", k)
        readings.append(sensor.read(scene, start if k == 0 else Pose(0, 0, 0), k * DT, rng, memory))
    return np.array(readings)


def wheels(v: float, w: float, seconds: float, offset: float = 0.0) -> tuple[Array, Array]:
    t: Array = np.arange(round(seconds / DT) + 1, dtype=np.float64) * DT
    left, right = v - w * TRACK / 2, v + w * TRACK / 2
    return offset + left * t / WHEEL_RADIUS, offset + right * t / WHEEL_RADIUS


def test_info() -> None:
    info = build(SPEC, context()).info()
    assert (info.category, info.ros_type) == ("odometry", "nav_msgs/msg/Odometry")
    assert info.shape == (5,)
    assert info.memory > 0
    assert load_build(WHEEL_ODOMETRY) is build


def test_starts_at_the_first_pose_whatever_the_wheels_say() -> None:
    reading = drive(np.array([17.3]), np.array([-4.1]))[0]
    assert reading == pytest.approx([2.5, -1.0, 0.7, 0.0, 0.0])


def test_encoder_constants_of_the_kobuki() -> None:
    assert pytest.approx(8.529e-5, rel=1e-3) == TICK
    assert 2 * math.pi / SPEC.ticks_per_turn == pytest.approx(0.002436917, rel=1e-5)


@settings(max_examples=40)
@given(st.floats(-0.65, 0.65), st.floats(-3.0, 3.0), st.floats(-50.0, 50.0))
def test_straight_lines_and_circles(v: float, w: float, offset: float) -> None:
    seconds = 2.0
    end = drive(*wheels(v, w, seconds, offset))[-1]
    turn = w * seconds
    if abs(w) > 1e-6:
        ahead, aside = v / w * math.sin(turn), v / w * (1 - math.cos(turn))
    else:
        ahead, aside = v * seconds, 0.0
    c, s = math.cos(0.7), math.sin(0.7)
    # A count is off by up to a tick at either end; that turns the whole way by 2 ticks / track.
    doubt = 2 * TICK + 2 * TICK / TRACK * abs(v) * seconds + 1e-4
    assert end[0] == pytest.approx(2.5 + c * ahead - s * aside, abs=doubt)
    assert end[1] == pytest.approx(-1.0 + s * ahead + c * aside, abs=doubt)
    error = math.remainder(end[2] - 0.7 - turn, 2 * math.pi)
    assert abs(error) <= 2 * TICK / TRACK + 1e-9
    assert -math.pi <= end[2] <= math.pi
    assert abs(end[3] - v) <= TICK / DT + 1e-9
    assert abs(end[4] - w) <= 2 * TICK / TRACK / DT + 1e-9


def test_quantised_to_whole_ticks() -> None:
    slow = np.linspace(0.0, 3.5 * TICK / WHEEL_RADIUS, 30)
    x = drive(slow, slow, start=Pose(0, 0, 0))[:, 0] / TICK
    assert x == pytest.approx(np.round(x), abs=1e-9)
    assert sorted(set(np.round(x))) == [0, 1, 2, 3]


def test_backwards_is_floored_not_truncated() -> None:
    """Through zero no tick is lost: forth and back ends where it began."""
    way = np.concatenate([np.linspace(0.1, -3.0, 50), np.linspace(-3.0, 0.1, 50)])
    end = drive(way, way * 1.3)[-1]
    assert end[2] == pytest.approx(0.7, abs=1e-9)


def test_finer_encoders_come_closer() -> None:
    fine = WheelOdometrySpec(ticks_per_turn=1e7)
    # 2.0 s at w = pi/2: half a circle of radius v / w.
    end = drive(*wheels(0.5, math.pi / 2, 2.0), spec=fine)[-1]
    exact = drive(*wheels(0.5, math.pi / 2, 2.0))[-1]
    radius = 0.5 / (math.pi / 2)
    centre = np.array([2.5 - radius * math.sin(0.7), -1.0 + radius * math.cos(0.7)])
    opposite = 2 * centre - np.array([2.5, -1.0])
    assert math.dist(end[:2], opposite) < 1e-4
    assert math.dist(end[:2], opposite) < math.dist(exact[:2], opposite)


def test_a_wrong_radius_scales_the_way() -> None:
    """The tyre rolls on 0.0352 m, the firmware believes 0.035 m: 0.57 % short."""
    angle = np.linspace(0.0, 10.0 / 0.0352, 500)
    end = drive(angle, angle, start=Pose(0, 0, 0))[-1]
    assert end[0] == pytest.approx(10.0 * 0.035 / 0.0352, abs=2 * TICK)


def test_reading_twice_at_one_instant() -> None:
    sensor, scene = build(SPEC, context()), Scene(np.empty((0, 4)), [0.0, 1.0], [], [])
    memory, rng = np.zeros(sensor.info().memory), np.random.default_rng(0)
    nobody = np.zeros((0, 4)), np.zeros(0, dtype=np.bool_)
    readings = []
    for t, angle in ((0.0, 0.0), (DT, 1.0), (DT, 1.0)):
        scene.update(RobotState(0, 0, 0, 0, 0, 0, 0, 0, angle, angle), *nobody)
        readings.append(sensor.read(scene, Pose(0, 0, 0), t, rng, memory))
    np.testing.assert_array_equal(readings[1], readings[2])
    assert readings[1][0] > 0.0
    readings[1][:] = 99.0  # the reading is new, not a view of the memory
    assert 99.0 not in memory


def test_needs_a_robot() -> None:
    sensor, scene = build(SPEC, context()), Scene(np.empty((0, 4)), [0.0, 1.0], [], [])
    with pytest.raises(SimulationError, match="robot"):
        sensor.read(scene, Pose(0, 0, 0), 0.0, np.random.default_rng(0), np.zeros(9))


def test_noisy_wheels_drift_as_a_random_walk() -> None:
    """Angles add up s dt n at each reading; the difference of the wheels turns the robot."""
    spec = WheelOdometrySpec(noise=0.5, ticks_per_turn=1e6)
    still, steps = np.zeros(4001), 4000
    rows = drive(still, still, spec, Pose(0, 0, 0))
    assert build(spec, context()).info().random
    turn = np.diff(np.unwrap(rows[:, 2]))
    expected = 0.5 * DT * WHEEL_RADIUS / TRACK * math.sqrt(2.0)
    assert turn.std() == pytest.approx(expected, rel=0.05)
    assert abs(turn.mean()) < 4 * expected / math.sqrt(steps)
    assert rows[1:, 3].std() == pytest.approx(0.5 * WHEEL_RADIUS / math.sqrt(2.0), rel=0.05)


def turned(spec: WheelOdometrySpec, yaws: Array, wheel: float = 0.0) -> Array:
    sensor, scene = build(spec, context()), Scene(np.empty((0, 4)), [0.0, 1.0], [], [])
    memory, rows = np.zeros(sensor.info().memory), []
    for k, yaw in enumerate(yaws.tolist()):
        scene.move_robot(RobotState(0, 0, yaw, 0, 0, 0, 0, 0, k * wheel, k * wheel))
        rng = sensor_rng(0, "robot", "odometry", k)
        rows.append(sensor.read(scene, Pose(0, 0, yaw), k * DT, rng, memory))
    return np.array(rows)


def test_a_gyro_knows_the_heading_when_wheels_slip() -> None:
    spec = WheelOdometrySpec(heading="gyro", gyro_noise=0.0)
    assert not build(spec, context()).info().random
    way = np.linspace(3.0, 4.0, 50)
    rows = turned(spec, np.array([math.remainder(y, 2 * math.pi) for y in way]))
    assert np.unwrap(rows[:, 2]) == pytest.approx(way)
    assert rows[1:, 4] == pytest.approx(np.diff(way) / DT)
    assert rows[:, :2] == pytest.approx(np.zeros((50, 2)))
    wheels_only = turned(SPEC, way)
    assert wheels_only[:, 2] == pytest.approx(np.full(50, 3.0))


def test_a_noisy_gyro_walks_with_the_root_of_time() -> None:
    spec = WheelOdometrySpec(heading="gyro", gyro_noise=0.02)
    yaw = np.unwrap(turned(spec, np.zeros(4001))[:, 2])
    assert np.diff(yaw).std() == pytest.approx(0.02 * math.sqrt(DT), rel=0.05)
