"""Clocks and frames of bags."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import InputError, RecordingWarning, UnknownNameError
from tests.core.trajectories.bag.bag_kit import (
    TIMES,
    Row,
    array,
    check_walkers,
    header,
    make,
    marker,
    marker_rows,
    odometry,
    pose,
    read,
    robot_rows,
    transform,
    twist,
    walkers,
    write,
)

WALL = 1.76e9


def _later(rows: list[Row], by: float) -> list[Row]:
    """The same messages, recorded later than they were stamped."""
    return [(topic, t + by, message) for topic, t, message in rows]


# ------------------------------------------------------------------------------- clocks
def test_a_clock_that_begins_at_zero(tmp_path: Path) -> None:
    times = [round(t - 0.1, 3) for t in TIMES]
    bag = write(tmp_path / "bag", _later(robot_rows(times) + marker_rows(times), WALL))
    run = read(bag)
    assert run.t[-1] == pytest.approx(times[-1])
    assert run.agents is not None
    np.testing.assert_allclose(run.agents.x[:, 0], 5.0 - 0.8 * run.t, atol=1e-6)


def test_a_stamp_that_is_not_filled_in(tmp_path: Path) -> None:
    rows = robot_rows()
    topic, t, message = rows[10]
    message.header = header(0.0)
    bag = write(tmp_path / "bag", _later(rows, 0.2) + _later(marker_rows(), 0.2))
    run = read(bag)
    check_walkers(run)
    np.testing.assert_allclose(np.diff(run.t), 0.1, atol=1e-6)
    assert (topic, t) == ("/odom", TIMES[10])


def test_two_clocks_of_which_one_is_a_simulators(tmp_path: Path) -> None:
    times = [WALL + t for t in TIMES]
    people = [
        ("/people", WALL + t, array(marker(WALL + t, i, (x, y)) for i, x, y in walkers(t)))
        for t in TIMES
    ]
    assert len(times) == len(people)
    bag = write(tmp_path / "bag", _later(robot_rows(), WALL) + people)
    with pytest.warns(RecordingWarning, match="two clocks, .* times of recording are taken"):
        check_walkers(read(bag))


def test_two_clocks_that_nothing_compares(tmp_path: Path) -> None:
    people = [
        ("/people", WALL + t, array(marker(WALL + t, i, (x, y)) for i, x, y in walkers(t)))
        for t in TIMES
    ]
    bag = write(tmp_path / "bag", robot_rows() + people)
    with pytest.raises(InputError, match=r"at no time both: two clocks\? clock_offset="):
        read(bag)
    check_walkers(read(bag, clock_offset=-WALL))


def test_a_reset_in_the_middle(tmp_path: Path) -> None:
    short = TIMES[:12]
    first = robot_rows(short) + marker_rows(short)
    bag = write(
        tmp_path / "bag", _later(first, 100.0) + _later(robot_rows() + marker_rows(), 200.0)
    )
    with pytest.warns(RecordingWarning, match="goes back after 1.2 s: the longest of 2 parts"):
        run = read(bag)
    check_walkers(run)
    assert len(run.t) == len(TIMES)


def test_ids_that_are_places_in_a_list_are_told(tmp_path: Path) -> None:
    """A detector that sorts people anew for each message."""
    rows: list[Row] = []
    for k, t in enumerate(TIMES):
        people = walkers(t)[:: 1 if k % 2 else -1]
        rows.append(("/people", t, array(marker(t, i, p[1:]) for i, p in enumerate(people))))
    bag = write(tmp_path / "bag", robot_rows() + rows)
    with pytest.warns(RecordingWarning, match=r"but 0.8 m/s if each .* ids that change"):
        read(bag)


def test_stamps_in_disorder_are_told(tmp_path: Path) -> None:
    """A late message and one that overtook it, as over a network."""
    rows = robot_rows()
    (topic, first, late), (_, second, soon) = rows[4:6]
    rows[4:6] = [(topic, first, soon), (topic, second, late)]
    bag = write(tmp_path / "bag", rows + marker_rows())
    with pytest.warns(RecordingWarning, match="/odom go back 1 times, by up to 0.1 s: its"):
        check_walkers(read(bag))


def test_a_reset_of_one_topic_alone(tmp_path: Path) -> None:
    rows = _later(robot_rows(TIMES[:12]), 100.0) + _later(robot_rows(), 200.0)
    bag = write(tmp_path / "bag", rows + _later(marker_rows(), 200.0))
    with pytest.warns(RecordingWarning, match="/odom goes back after 1.2 s"):
        check_walkers(read(bag))


def test_topics_that_are_reset_differently_are_refused(tmp_path: Path) -> None:
    twice = _later(robot_rows(TIMES[:12]), 100.0) + _later(robot_rows(), 200.0)
    rows = twice + _later(robot_rows(), 300.0)
    people = _later(marker_rows(TIMES[:12]), 200.0) + _later(marker_rows(), 300.0)
    bag = write(tmp_path / "bag", rows + people)
    with pytest.raises(InputError, match="that of /odom 2 times, that of /people 1 times"):
        read(bag)


# ------------------------------------------------------------------------------- frames
def _in_odom() -> list[Row]:
    """The robot in a frame ``odom`` that lies at (3, -1) in the map, turned by 90 degrees."""
    rows: list[Row] = []
    for t in TIMES:
        x, y = 0.5 * t - 3.0, 1.0
        at = pose(y, -x, -math.pi / 2)
        rows.append(("/odom", t, odometry(t, at, twist(0.5), frame="odom")))
    return rows


def test_frames_that_differ_are_transformed(tmp_path: Path) -> None:
    tree: list[Row] = [
        ("/tf", t, transform(t, "map", "odom", (3.0, -1.0, 0.0), math.pi / 2)) for t in TIMES
    ]
    bag = write(tmp_path / "bag", _in_odom() + marker_rows() + tree)
    with pytest.warns(RecordingWarning, match="'odom' are transformed into 'map'"):
        run = read(bag)
    check_walkers(run)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.x, 0.5 * np.array(TIMES), atol=1e-6)
    np.testing.assert_allclose(run.robot.y, 0.0, atol=1e-6)
    np.testing.assert_allclose(np.cos(run.robot.theta), 1.0, atol=1e-6)


def test_frames_that_differ_without_a_transform_are_refused(tmp_path: Path) -> None:
    bag = write(tmp_path / "bag", robot_rows(frame="odom") + marker_rows())
    with pytest.raises(InputError, match=r"'map' and 'odom', and no transform .*same_frame=True"):
        read(bag)
    check_walkers(read(bag, same_frame=True))


def test_people_in_the_robots_own_frame(tmp_path: Path) -> None:
    rows: list[Row] = []
    for t in TIMES:
        turned = 0.3 * t
        c, s = math.cos(turned), math.sin(turned)
        at = pose(0.5 * t, 0.0, turned)
        rows.append(("/odom", t, odometry(t, at, twist(0.5 * c, -0.5 * s), frame="odom")))
        seen = []
        for i, x, y in walkers(t):
            dx, dy = x - 0.5 * t - 0.2 * c, y - 0.2 * s
            seen.append(marker(t, i, (c * dx + s * dy, c * dy - s * dx), frame="laser"))
        rows.append(("/people", t, array(seen)))
    rows.append(("/tf_static", TIMES[0], transform(0.0, "base_link", "laser", (0.2, 0.0, 0.4))))
    with pytest.warns(RecordingWarning, match="'laser' are transformed into 'odom'"):
        check_walkers(read(write(tmp_path / "bag", rows)), [1, 2])


def test_poses_that_are_only_in_tf(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/tf", t, transform(t, "odom", "base_footprint", (0.5 * t - 1.0, 0.0, 0.0))) for t in TIMES
    ]
    rows.append(("/tf_static", TIMES[0], transform(0.0, "map", "odom", (1.0, 0.0, 0.0))))
    bag = write(tmp_path / "bag", rows + marker_rows())
    for robot in ("/tf", "/tf:base_footprint"):
        run = read(bag, robot=robot)
        check_walkers(run)
        assert run.robot is not None
        np.testing.assert_allclose(run.robot.x, 0.5 * np.array(TIMES), atol=1e-6)
    with pytest.raises(UnknownNameError, match="did you mean 'base_footprint'"):
        read(bag, robot="/tf:base_footprin")


def test_a_topic_without_a_pose_names_those_that_have_one(tmp_path: Path) -> None:
    rows: list[Row] = [("/cmd_vel", t, twist(0.5)) for t in TIMES]
    bag = write(tmp_path / "bag", rows + robot_rows() + marker_rows())
    with pytest.raises(InputError, match=r"geometry_msgs/msg/Twist, .* no pose; these have: /odom"):
        read(bag, robot="/cmd_vel")
    own = [("/a/tf", t, transform(t, "map", "a/base_link", (0.0, 0.0, 0.0))) for t in TIMES]
    bag = write(tmp_path / "namespace", own + marker_rows())
    with pytest.raises(InputError, match=r"/a/tf holds tf2_msgs/msg/TFMessage, which has no pose$"):
        read(bag, robot="/a/tf")


def test_transforms_of_two_robots(tmp_path: Path) -> None:
    rows = marker_rows()
    for t in TIMES:
        rows.append(("/tf", t, transform(t, "map", "a/base_link", (0.5 * t, 0.0, 0.0))))
        rows.append(("/tf", t, transform(t, "map", "b/base_link", (9.0, 9.0, 0.0))))
    bag = write(tmp_path / "bag", rows)
    with pytest.raises(InputError, match=r"bases of 2 robots; .* which of a/base_link, b/"):
        read(bag, robot="/tf")
    run = read(bag, robot="/tf:b/base_link")
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.x, 9.0)


# ------------------------------------------------------------------------------- robots
def test_turtlesim(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/pose", t, make("turtlesim/Pose", 1.0 + 0.5 * t, 2.0, 0.0, 0.5, 0.0)) for t in TIMES
    ]
    run = read(write(tmp_path / "bag", rows), robot="/pose", people=None)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.x, 1.0 + 0.5 * np.array(TIMES), atol=1e-5)
    assert run.robot.v is not None
    np.testing.assert_allclose(run.robot.v, 0.5)


def test_a_robot_that_goes_sideways(tmp_path: Path) -> None:
    rows: list[Row] = []
    for t in TIMES:
        at = pose(-0.5 * t, 0.2 * t, math.pi / 2)
        rows.append(("/odom", t, odometry(t, at, twist(0.2, 0.5))))
    run = read(write(tmp_path / "bag", rows), people=None)
    assert run.robot is not None
    assert run.robot.vx is not None
    assert run.robot.vy is not None
    np.testing.assert_allclose(run.robot.vx, -0.5, atol=1e-9)
    np.testing.assert_allclose(run.robot.vy, 0.2, atol=1e-9)
    speed = {s.variant: s.value for s in crowdbot.score(run, metrics=["speed"])}
    assert speed["avg"] == pytest.approx(math.hypot(0.5, 0.2), abs=1e-3)
