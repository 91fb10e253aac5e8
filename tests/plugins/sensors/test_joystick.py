"""The joystick: a driver who steers for the goal with a shaky hand, and a recorded one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from pydantic import ValidationError

from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.topics import sensor_topics
from crowdbot.core.sensing.context import SensorContext
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pose
from crowdbot.plugins.sensors.joystick import JoystickSpec
from crowdbot.plugins.sensors.joystick_build import build
from crowdbot.testing.sensor_scenes import context

EMPTY = Scene((), (0.0, 2.5), (), ())
ANGLES = st.floats(-math.pi, math.pi)


def drive(spec: JoystickSpec, poses: list[Pose], seed: int = 0) -> NDArray[np.float64]:
    """Readings at these poses, one after the other, at the joystick's rate."""
    stick, memory = build(spec, context()), np.zeros(4)
    return np.array(
        [
            stick.read(EMPTY, pose, k / spec.rate, sensor_rng(seed, "robot", "joystick", k), memory)
            for k, pose in enumerate(poses)
        ]
    )


def steady(x: float = 10.0, y: float = 0.0) -> JoystickSpec:
    return JoystickSpec(goal=(x, y), noise=0.0, max_speed=1.5, max_yaw_rate=1.2)


def test_straight_ahead_is_full_speed() -> None:
    assert drive(steady(), [Pose(0.0, 0.0, 0.0)])[0] == pytest.approx([1.5, 0.0])


def test_a_goal_behind_is_turned_to_first() -> None:
    left, right = drive(steady(), [Pose(0.0, 0.0, -3.0), Pose(0.0, 0.0, 3.0)])
    assert left == pytest.approx([0.0, 1.2])
    assert right == pytest.approx([0.0, -1.2])


@given(st.floats(-20, 20), st.floats(-20, 20), ANGLES, st.floats(1.6, 30.0), st.floats(-0.7, 0.7))
def test_it_steers_by_the_angle_to_the_goal(
    x: float, y: float, yaw: float, far: float, off: float
) -> None:
    """1.5 rad/s a radian up to the full deflection, ahead by the cosine; any pose and goal."""
    goal = x + far * math.cos(yaw + off), y + far * math.sin(yaw + off)
    (v, w), *_ = drive(steady(*goal), [Pose(x, y, yaw)])
    assert v == pytest.approx(1.5 * math.cos(off), abs=1e-6)
    assert w == pytest.approx(1.5 * off, abs=1e-6)


def test_near_the_goal_the_driver_slows_down_and_stops() -> None:
    speeds = drive(steady(), [Pose(10.0 - d, 0.0, 0.0) for d in (2.0, 1.5, 0.75, 0.0)])[:, 0]
    assert speeds == pytest.approx([1.5, 1.5, 0.75, 0.0])


def test_the_hand_is_as_shaky_as_the_spec_says() -> None:
    """Mean, deviation and correlation of the process; no deflection at the goal, so no clipping."""
    spec = JoystickSpec(goal=(0.0, 0.0), noise=0.1, noise_time=0.25, max_speed=1.5,
                        max_yaw_rate=1.2)  # fmt: skip
    found = drive(spec, [Pose(0.0, 0.0, 0.0)] * 8000) / [1.5, 1.2]
    assert found.mean(axis=0) == pytest.approx([0.0, 0.0], abs=0.01)
    assert found.std(axis=0) == pytest.approx([0.1, 0.1], rel=0.06)
    lag = 4  # readings, 0.25 s: one noise_time
    for column in found.T:
        assert np.corrcoef(column[:-lag], column[lag:])[0, 1] == pytest.approx(
            math.exp(-1.0), abs=0.06
        )
    assert abs(np.corrcoef(*found.T)[0, 1]) < 0.08


def test_the_stick_goes_no_farther_than_it_can() -> None:
    spec = JoystickSpec(goal=(100.0, 0.0), noise=1.0, max_speed=1.5, max_yaw_rate=1.2)
    found = np.abs(drive(spec, [Pose(0.0, 0.0, 0.0)] * 200))
    assert found.max(axis=0) == pytest.approx([1.5, 1.2])


def test_equal_seeds_are_equal_hands_and_others_are_not() -> None:
    spec, poses = JoystickSpec(goal=(9.0, 0.0)), [Pose(0.0, 0.0, 0.0)] * 20
    assert np.array_equal(drive(spec, poses), drive(spec, poses))
    assert not np.array_equal(drive(spec, poses), drive(spec, poses, seed=1))


def test_a_recorded_command_holds_until_the_next_one() -> None:
    spec = JoystickSpec(rate=8.0, recorded=((0.25, 0.5, 0.1), (0.5, 0.3, -0.2)))
    found = drive(spec, [Pose(5.0, 5.0, 1.0)] * 6)
    wanted = [(0, 0), (0, 0), (0.5, 0.1), (0.5, 0.1), (0.3, -0.2), (0.3, -0.2)]
    assert found.tolist() == [list(map(float, w)) for w in wanted]
    assert not build(spec, context()).info().random


def test_goal_and_limits_come_from_the_robot_unless_the_spec_says_them() -> None:
    robot = replace(context().robot, limits=replace(context().robot.limits, v_max=1.5, w_max=1.2))
    task = replace(context().task, goal=(9.0, 1.0))
    at, memory, rng = Pose(0.0, 1.0, -1.0), np.zeros(4), sensor_rng(0, "robot", "joystick", 0)
    for spec, wanted in (
        (JoystickSpec(noise=0.0), 1.2),
        (JoystickSpec(noise=0.0, goal=(-9.0, 1.0)), -1.2),
    ):
        stick = build(spec, SensorContext(robot=robot, task=task))
        assert stick.read(EMPTY, at, 0.0, rng, memory)[1] == pytest.approx(wanted)
    fast = build(JoystickSpec(noise=0.0, max_speed=0.8), SensorContext(robot=robot, task=task))
    assert fast.read(EMPTY, Pose(0.0, 1.0, 0.0), 0.0, rng, memory) == pytest.approx([0.8, 0.0])


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"recorded": ((1.0, 0.5, 0.0), (1.0, 0.2, 0.0))}, "command 2 is at 1 s, not after 1 s"),
        ({"recorded": ()}, "at least 1 item"),
        ({"recorded": ((0.0, 0.5, 0.0),), "goal": (1.0, 2.0)}, "a recorded driver has no goal"),
        ({"noise": 1.5}, "less than or equal to 1"),
    ],
)
def test_what_no_driver_can_do_is_refused(fields: dict[str, object], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        JoystickSpec.model_validate({"kind": "joystick", **fields})


def test_it_is_recorded_as_a_stamped_twist() -> None:
    """By the message class, not by the template that made the bytes."""
    topic = sensor_topics({"joystick": build(JoystickSpec(), context()).info()})["joystick"]
    assert topic.name == "/joystick/cmd_vel"
    message = ros.from_cdr(topic.message(1_500_000_000, np.array([0.75, -0.25])), topic.msgtype)
    assert topic.msgtype == "geometry_msgs/msg/TwistStamped"
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 500_000_000)
    twist = message.twist
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (0.75, 0.0, -0.25)
