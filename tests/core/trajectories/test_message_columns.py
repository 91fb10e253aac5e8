"""Stamps in two columns and headings in four, as exports of bags have them."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import InputError, RecordingWarning

READ = crowdbot.Trajectories
BODY: dict[str, Any] = {"robot_radius": 0.2, "robot_mass": 20.0}
#: Whole seconds and nanoseconds that cross a second, and their seconds since the first.
STAMPS = [(7, 900_000_000), (8, 0), (8, 100_000_000), (8, 200_000_001)]
SECONDS = [0.0, 0.1, 0.2, 0.300000001]


def _turned(angle: float) -> tuple[float, float, float, float]:
    """Return a quaternion x, y, z, w of a turn about the vertical, tilted by 0.2 rad about x."""
    s, c, sr, cr = math.sin(angle / 2), math.cos(angle / 2), math.sin(0.1), math.cos(0.1)
    return c * sr, s * sr, s * cr, c * cr


def _table(path: Path, head: str, start: int = 0, sign: float = 1.0) -> Path:
    lines = [head]
    for k, (s, ns) in enumerate(STAMPS):
        turn = (sign * q for q in _turned(1.2 + 0.1 * k))
        lines.append(",".join(map(str, (start + s, ns, 0.05 * k, 0.1 * k, *turn))))
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("start", [0, 1_700_000_000])
@pytest.mark.parametrize(
    "head",
    [
        "sec,nanosec,x,y,qx,qy,qz,qw",
        "secs,nsecs,x,y,q_x,q_y,q_z,q_w",
        "header.stamp.sec,header.stamp.nanosec,pose.position.x,pose.position.y,"
        "pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w",
        "header.stamp.secs,header.stamp.nsecs,pose.pose.position.x,pose.pose.position.y,"
        "pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,"
        "pose.pose.orientation.w",
        "/odom/header/stamp/sec,/odom/header/stamp/nanosec,/odom/pose/pose/position/x,"
        "/odom/pose/pose/position/y,/odom/pose/pose/orientation/x,/odom/pose/pose/orientation/y,"
        "/odom/pose/pose/orientation/z,/odom/pose/pose/orientation/w",
        "timestamp_s,timestamp_ns,pos_x,pos_y,quat_x,quat_y,quat_z,quat_w",
        "stamp_sec,stamp_nanosec,position_x,position_y,orientation_x,orientation_y,"
        "orientation_z,orientation_w",
        "sec,nsec,px,py,ori_x,ori_y,ori_z,ori_w",
    ],
)
def test_stamps_and_quaternions(tmp_path: Path, head: str, start: int) -> None:
    run = READ.from_csv(_table(tmp_path / "odom.csv", head, start, sign=-1.0), **BODY)
    assert run.robot is not None
    expected = np.array(SECONDS) + (7.9 if start == 0 else 0.0)
    np.testing.assert_allclose(run.t, expected, atol=1e-9, rtol=0)
    np.testing.assert_allclose(run.robot.theta, [1.2, 1.3, 1.4, 1.5])
    np.testing.assert_allclose(run.robot.y, [0.0, 0.1, 0.2, 0.3])


def test_stamps_of_people_and_frames_of_pandas() -> None:
    s, ns = np.array(STAMPS).T
    place = {"x": [0.0, 0.1, 0.2, 0.3], "y": [0.0] * 4}
    run = READ.from_pandas(agents={"sec": 1_700_000_000 + s, "nanosec": ns, "id": [1] * 4, **place})
    np.testing.assert_allclose(run.t, SECONDS, atol=1e-9)
    columns = {"robot": {"t": "a", "qz": "c", "qw": "d"}}
    named = {"a": SECONDS, **place, "c": [0.0] * 4, "d": [-1.0] * 4}
    turned = READ.from_pandas(named, columns=columns, **BODY)
    assert turned.robot is not None
    np.testing.assert_allclose(turned.robot.theta, 0.0)


def test_stamp_and_orientation_of_the_same_message_are_taken(tmp_path: Path) -> None:
    head = (
        "/imu/header/stamp/sec,/imu/header/stamp/nanosec,/odom/pose/position/x,"
        "/odom/pose/position/y,/odom/pose/orientation/x,/odom/pose/orientation/y,"
        "/odom/pose/orientation/z,/odom/pose/orientation/w,/imu/orientation/z,/imu/orientation/w,"
        "/odom/header/stamp/sec,/odom/header/stamp/nanosec"
    )
    path = _table(tmp_path / "both.csv", head)
    rows = path.read_text().splitlines()
    rows[1:] = [f"{row},1,0,{k},5" for k, row in enumerate(rows[1:])]
    path.write_text("\n".join(rows))
    with pytest.warns(RecordingWarning, match="/imu/orientation/w are not used"):
        run = READ.from_csv(path, **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.t, np.arange(4) + 5e-9, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.robot.theta, [1.2, 1.3, 1.4, 1.5])


def test_lengths_of_other_sizes_and_whole_stamps(tmp_path: Path) -> None:
    rows = "".join(f"0,{0.1 * k},0,0.5,0,{0.05 * k},0\n" for k in range(6))
    (tmp_path / "zeros.csv").write_text("qx,t,qy,qz,qw,x,y\n" + rows)
    with pytest.warns(RecordingWarning, match=r"qx, qy, qz, qw do not rotate: .* is 0.5"):
        run = READ.from_csv(tmp_path / "zeros.csv", **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.theta, 0.0)
    whole = "".join(f"{0.1 * k},{k * 10**8},{0.05 * k},0\n" for k in range(20))
    (tmp_path / "whole.csv").write_text("t_s,t_ns,x,y\n" + whole)
    with pytest.warns(RecordingWarning, match="the column t_ns is not used"):
        run = READ.from_csv(tmp_path / "whole.csv", **BODY)
    np.testing.assert_allclose(run.t, 0.1 * np.arange(20))


def test_times_of_day_give_way_to_stamps_beside_them(tmp_path: Path) -> None:
    head = "time,.header.stamp.secs,.header.stamp.nsecs,x,y\n"  # as rosbag_to_csv writes them
    rows = (f"2019/03/11/08:20:2{k}.5,1552292420,{k}00000000,{0.1 * k},0\n" for k in range(5))
    (tmp_path / "odom.csv").write_text(head + "".join(rows))
    run = READ.from_csv(tmp_path / "odom.csv", **BODY)
    np.testing.assert_allclose(run.t, 0.1 * np.arange(5), atol=1e-9)


@pytest.mark.parametrize("frame", [(0.813, -0.027, 0.581, 0.028), (-0.5, 0.5, -0.5, 0.5)])
def test_frames_of_cameras_and_drones_give_no_heading(
    tmp_path: Path, frame: tuple[float, ...]
) -> None:
    rows = (f"{0.1 * k} 0 {0.05 * k} 0 {' '.join(map(str, frame))}\n" for k in range(9))
    (tmp_path / "V102.txt").write_text("".join(rows))
    with pytest.warns(RecordingWarning, match="z axis points sideways"):
        run = READ.from_csv(tmp_path / "V102.txt", **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.theta, math.pi / 2)


def test_groups_of_names_whose_columns_are_empty(tmp_path: Path) -> None:
    head = (  # as bagToCsv writes it
        "rosbagTimestamp,header,seq,stamp,secs,nsecs,frame_id,pose,pose,position,x,y,z,"
        "orientation,x,y,z,w,twist,twist,linear,x,y,z\n"
    )
    rows = (
        f"{1_700_000_000_000_000_000 + k},,{k},,1700000000,{k}00000000,odom,,,,"
        f"{0.08 * k},{0.06 * k},0,,0,0,{math.sin(0.35)},{math.cos(0.35)},,,,9,9,9\n"
        for k in range(5)
    )
    (tmp_path / "odom.csv").write_text(head + "".join(rows))
    with pytest.warns(RecordingWarning, match=r"rosbagTimestamp, header.seq, .*not used"):
        run = READ.from_csv(tmp_path / "odom.csv", **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.t, 0.1 * np.arange(5), atol=1e-9)
    np.testing.assert_allclose(run.robot.x, 0.08 * np.arange(5))
    np.testing.assert_allclose(run.robot.y, 0.06 * np.arange(5))
    np.testing.assert_allclose(run.robot.theta, 0.7)


def test_a_heading_comes_before_a_quaternion(tmp_path: Path) -> None:
    rows = "".join(f"{0.1 * k},{0.05 * k},0,0,1,0\n" for k in range(6))
    (tmp_path / "both.csv").write_text("t,x,y,theta,qz,qw\n" + rows)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = READ.from_csv(tmp_path / "both.csv", **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.theta, 0.0)


def test_a_row_without_a_half_of_its_stamp_is_named(tmp_path: Path) -> None:
    (tmp_path / "odom.csv").write_text("sec,nanosec,x,y\n7,0,0,0\n7,,1,0\n")
    with pytest.raises(InputError, match=r"odom\.csv:3: a row has no nanosec"):
        READ.from_csv(tmp_path / "odom.csv", **BODY)
