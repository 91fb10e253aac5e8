"""Robots that push without moving are noticed, remembered and led away."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugin import Array, Command, Observation, Pose, Reading, SensorInfo
from crowdbot.plugins.planners.shared.stuck_build import Stuck

_PERIOD = 1.0 / 16.0
_RADIUS = 0.2
_ROOM = [(x, y) for y in (-3.0, 3.0) for x in np.arange(-4.0, 8.0, 0.1)] + [
    (x, y) for x in (-4.0, 8.0) for y in np.arange(-3.0, 3.0, 0.1)
]


def _scan(pose: Pose, more: Array | None = None) -> Array:
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    points = np.array(_ROOM) if more is None else np.concatenate([np.array(_ROOM), more])
    return np.asarray((points - (pose.x, pose.y)) @ np.array([[c, -s], [s, c]]))


def _observation(
    t: float, odometry: Pose, speed: float, readings: dict[str, Reading] | None = None
) -> Observation:
    return Observation(
        t=t, pose=odometry, twist=(speed, 0.0), goal=(7.0, 0.0), goal_zone=np.zeros((0, 2)),
        readings=readings or {},
    )  # fmt: skip


def _drive(
    stuck: Stuck, seconds: float, *, wheels: float = 0.6, real: float = 0.6, commanded: float = 0.6,
    ahead: Array | None = None, readings: dict[str, Reading] | None = None,
) -> tuple[Pose, Command | None]:  # fmt: skip
    """Drive along x and return the corrected pose and the command after the last step."""
    corrected, command = Pose(0.0, 0.0, 0.0), None
    for k in range(round(seconds / _PERIOD)):
        t = k * _PERIOD
        true, odometry = Pose(real * t, 0.0, 0.0), Pose(wheels * t, 0.0, 0.0)
        obs = _observation(t, odometry, wheels, readings)
        corrected, points = stuck.see(obs, odometry, _scan(true, ahead))
        command = stuck.way_back(obs, corrected, points)
        stuck.commanded(Command(commanded, 0.0), _PERIOD)
        if command is not None:
            break
    return corrected, command


def test_slipping_wheels_are_noticed_and_the_robot_backs_off() -> None:
    stuck = Stuck(_RADIUS)
    pose, command = _drive(stuck, 4.0, real=0.0)
    assert stuck.count == 1
    assert command is not None
    assert command.v < 0.0
    assert math.hypot(pose.x, pose.y) < 0.05  # slip does not count
    assert np.all(stuck.places[:, 0] > _RADIUS)
    assert np.ptp(stuck.places[:, 1]) >= 2.0 * _RADIUS


def test_a_robot_that_drives_sees_and_remembers_nothing_new() -> None:
    stuck = Stuck(_RADIUS)
    for k in range(160):
        t = k * _PERIOD
        pose = Pose(0.6 * t, 0.2 * math.sin(t), 0.3 * math.cos(t))
        seen = _scan(pose)
        corrected, points = stuck.see(_observation(t, pose, 0.6), pose, seen)
        assert corrected is pose
        assert points is seen
        assert stuck.way_back(_observation(t, pose, 0.6), pose, seen) is None
    assert stuck.count == 0


def test_people_who_walk_beside_it_do_not_make_it_stand() -> None:
    """In a long corridor nothing else changes in the scan."""
    walls = np.array([(x, y) for y in (-3.0, 3.0) for x in np.arange(-40.0, 40.0, 0.05)])
    turn = np.linspace(0.0, 2.0 * math.pi, 12, endpoint=False)
    body = 0.15 * np.column_stack([np.cos(turn), np.sin(turn)])
    places = [(1.5, 0.8), (2.5, -0.9), (-1.2, 1.1), (3.5, 0.3), (-2.0, -0.6), (0.4, -1.6)]
    people = np.concatenate([body + place for place in places])
    stuck = Stuck(_RADIUS)
    for k in range(96):
        t = k * _PERIOD
        pose = Pose(0.65 * t, 0.0, 0.0)
        points = np.concatenate([people, walls[abs(walls[:, 0] - pose.x) < 9.0] - (pose.x, 0.0)])
        stuck.see(_observation(t, pose, 0.65), pose, points)
    assert stuck.count == 0


def test_stalled_wheels_are_noticed() -> None:
    stuck = Stuck(_RADIUS)
    _, command = _drive(stuck, 3.0, wheels=0.0, real=0.0)
    assert stuck.count == 1
    assert command is not None
    standing = Stuck(_RADIUS)
    _drive(standing, 3.0, wheels=0.0, real=0.0, commanded=0.0)
    assert standing.count == 0


def test_what_a_lidar_sees_is_the_planner_s_own_task() -> None:
    in_front = np.column_stack([np.full(9, 0.25), np.linspace(-0.1, 0.1, 9)])
    stuck = Stuck(_RADIUS)
    _drive(stuck, 4.0, real=0.0, ahead=in_front)
    assert stuck.count == 0


def test_a_jolt_makes_it_sooner() -> None:
    info = SensorInfo(
        category="imu", frame="imu", mount=(0.0,) * 4, rate=64.0, shape=(6,), ros_type=""
    )
    jolt = {"imu": Reading(0.0, np.array([0.0, 0.0, 0.0, -40.0, 0.0, 9.81]))}
    calm = {"imu": Reading(0.0, np.array([0.0, 0.0, 0.0, 0.1, 0.0, 9.81]))}
    counts = []
    for readings in (calm, jolt):
        stuck = Stuck(_RADIUS, None, {"imu": info})
        _drive(stuck, 0.8, real=0.0, readings=readings)
        counts.append(stuck.count)
    assert counts == [0, 1]


def test_a_pressed_bumper_is_enough() -> None:
    info = SensorInfo(
        category="bumper", frame="b", mount=(0.0,) * 4, rate=16.0, shape=(3,), ros_type=""
    )
    pressed = {"bumper": Reading(0.0, np.array([0.0, 1.0, 0.0]))}
    stuck = Stuck(_RADIUS, None, {"bumper": info})
    _drive(stuck, 0.5, wheels=0.05, real=0.0, commanded=0.1, readings=pressed)
    assert stuck.count == 1


def test_it_backs_off_by_a_stretch_and_then_lets_go() -> None:
    stuck, t, rolled, x = Stuck(_RADIUS), 0.0, 0.0, 0.0
    away: Command | None = None
    while t < 12.0 and not (stuck.count and away is None):
        odometry = Pose(rolled, 0.0, 0.0)
        obs = _observation(t, odometry, 0.6 if away is None else away.v)
        pose, points = stuck.see(obs, odometry, _scan(Pose(x, 0.0, 0.0)))
        away = stuck.way_back(obs, pose, points)
        t, rolled = t + _PERIOD, rolled + (0.6 if away is None else away.v) * _PERIOD
        x += 0.0 if away is None else away.v * _PERIOD
    assert -0.5 < x < -0.35
    assert pose.x == pytest.approx(x, abs=0.05)
    # The barrier stays in what the planner sees.
    assert len(points) == len(_ROOM) + len(stuck.places)


@pytest.mark.parametrize("behind", [0.25, 2.0])
def test_it_does_not_back_into_something(behind: float) -> None:
    stuck = Stuck(_RADIUS)
    obstacle = np.column_stack([np.full(9, -behind), np.linspace(-0.1, 0.1, 9)])
    _, command = _drive(stuck, 3.0, real=0.0, ahead=obstacle)
    assert stuck.count > 0
    assert (command is None) == (behind < 0.3)


def test_barriers_met_again_are_taken_for_wider() -> None:
    stuck, widths = Stuck(_RADIUS), [0.0]
    behind = np.column_stack([np.full(9, -0.25), np.linspace(-0.1, 0.1, 9)])
    for k in range(120):  # something behind it ends each way back at once
        odometry = Pose(0.6 * k * _PERIOD, 0.0, 0.0)
        obs = _observation(k * _PERIOD, odometry, 0.6)
        pose, points = stuck.see(obs, odometry, _scan(Pose(0.0, 0.0, 0.0), behind))
        stuck.way_back(obs, pose, points)
        if stuck.count == len(widths):
            widths.append(float(np.ptp(stuck.places[:, 1])))
    assert len(widths) > 3
    assert 0.0 < widths[1] < widths[2] < widths[3]


def _pushed() -> tuple[Stuck, float, float]:
    """Return one that was just noticed to push, the way that its wheels rolled, and the time."""
    stuck, still = Stuck(_RADIUS), _scan(Pose(0.0, 0.0, 0.0))
    for k in range(64):
        t = k * _PERIOD
        odometry = Pose(0.6 * t, 0.0, 0.0)
        obs = _observation(t, odometry, 0.6)
        corrected, points = stuck.see(obs, odometry, still)
        if stuck.way_back(obs, corrected, points) is not None:
            return stuck, odometry.x, t
        stuck.commanded(Command(0.6, 0.0), _PERIOD)
    raise AssertionError("nothing was noticed")


def _walk(stuck: Stuck, rolled: float, start: float, seconds: float, reach: float) -> int:
    """Drive back and forth behind the barrier; return how many places the last step added."""
    added = 0
    for k in range(round(seconds / _PERIOD)):
        t, back = start + k * _PERIOD, 0.5 * reach * (math.cos(0.1 * k) - 1.0)
        speed = -0.05 * reach * math.sin(0.1 * k) / _PERIOD
        odometry, seen = Pose(rolled + back, 0.0, 0.0), _scan(Pose(back, 0.0, 0.0))
        obs = _observation(t, odometry, speed)
        corrected, points = stuck.see(obs, odometry, seen)
        stuck.way_back(obs, corrected, points)
        added = len(points) - len(seen)
    return added


def test_a_robot_that_stays_among_remembered_places_forgets_them() -> None:
    """They may be wider than what is there, and would hold it for ever."""
    stuck, rolled, t = _pushed()
    assert _walk(stuck, rolled, t, 9.0, 0.0) > 0
    assert _walk(stuck, rolled, t + 9.0, 3.0, 0.0) == 0
    assert (len(stuck.places), stuck.count) == (0, 1)


def test_a_robot_that_moves_on_keeps_them() -> None:
    stuck, rolled, t = _pushed()
    assert _walk(stuck, rolled, t, 30.0, 0.3) > 0
    assert stuck.count == 1
