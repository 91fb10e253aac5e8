"""Cameras, IMUs and frames in recordings, read back by readers of somebody else."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.plugin import CameraFrame, Reading, SensorInfo
from crowdbot.testing.sensor_scenes import context

pytestmark = pytest.mark.slow

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from urdf_parser_py.urdf import URDF  # type: ignore[import-not-found,import-untyped,unused-ignore]

EXTRA = (
    "robots.robot.sensors.camera="
    "{kind: rgbd_camera, width: 8, height: 6, mount: {x: -0.087, z: 0.287, yaw: 0.2}}",
    "robots.robot.sensors.imu={kind: imu, mount: {x: 0.056, y: 0.062, z: 0.0202}}",
    "robots.robot.sensors.bumper={kind: bumper}",
)
DEPTH = np.array([[0.0, 0.4, np.inf, 1.2345, 8.0, 65.535, 70.0, 2.0]] * 6, np.float32)


def _infos() -> tuple[Any, dict[str, SensorInfo]]:
    from dataclasses import replace

    registry = discover()
    world = pick(open_spec("challenge-2020", registry, EXTRA), "in-d0125-slow-c01-r02")
    robot = world.robots["robot"]
    found = {n: build_sensor(registry, x, context()).info() for n, x in robot.sensors.items()}
    framed = {n: i if i.category == "odometry" else replace(i, frame=n) for n, i in found.items()}
    return build_model(registry, robot.model), framed


def _recorded(folder: Path, record: Any, colour: bool = False) -> dict[str, list[Any]]:
    model, infos = _infos()
    about = RobotHeader(radius=0.178, mass=6.3, base_height=model.base_height)
    writer = RecordingWriter(
        folder / "run.mcap", RecordingHeader(scenario="x", robot=about, sensors=infos),
        record=record,
    )  # fmt: skip
    writer.state(0.0, (0.0, 0.0, 0.0, 0.0, 0.0), None)
    picture = np.arange(144, dtype=np.uint8).reshape(6, 8, 3) if colour else None
    writer.frame("camera", CameraFrame(0.125, depth_mm(DEPTH), picture))
    writer.reading("imu", Reading(0.25, np.array([0.1, 0.2, 0.3, 1.0, 2.0, 9.81])))
    writer.reading("bumper", Reading(0.25, np.array([0.0, 1.0, 0.0])))
    writer.close(None, True, "timeout")
    found: dict[str, list[Any]] = {}
    store = get_typestore(Stores.ROS2_HUMBLE)
    with AnyReader([folder / "run.mcap"], default_typestore=store) as reader:
        for connection, _, data in reader.messages():
            if not connection.topic.startswith("/crowdbot"):
                message = reader.deserialize(data, connection.msgtype)
                found.setdefault(connection.topic, []).append(message)
    return found


def test_depth_in_millimetres(tmp_path: Path) -> None:
    messages = _recorded(tmp_path, "all")
    (image,) = messages["/camera/depth/image_raw"]
    assert (image.encoding, image.height, image.width, image.step) == ("16UC1", 6, 8, 16)
    assert image.header.frame_id == "camera_optical"
    assert (image.header.stamp.sec, image.header.stamp.nanosec) == (0, 125_000_000)
    pixels = image.data.view("<u2").reshape(6, 8)
    assert pixels[0].tolist() == [0, 400, 0, 1234, 8000, 65535, 0, 2000]
    (about,) = messages["/camera/depth/camera_info"]
    assert (about.width, about.height, about.header) == (8, 6, image.header)
    assert about.k[0] == about.k[4] == pytest.approx(4.0 / math.tan(math.pi / 6))
    assert (about.k[2], about.k[5]) == (3.5, 2.5)
    assert "/camera/color/image_raw" not in messages


def test_colour_beside_depth(tmp_path: Path) -> None:
    (image,) = _recorded(tmp_path, "all", colour=True)["/camera/color/image_raw"]
    assert (image.encoding, image.step) == ("rgb8", 24)
    assert image.data.tolist() == list(range(144))


def test_only_all_records_what_no_replay_shows(tmp_path: Path) -> None:
    assert not _recorded(tmp_path, "none")
    assert set(_recorded(tmp_path, "used")) == {
        "/tf", "/tf_static", "/camera/depth/image_raw", "/camera/depth/camera_info",
    }  # fmt: skip


def test_imu_and_bumper(tmp_path: Path) -> None:
    messages = _recorded(tmp_path, "all")
    (imu,) = messages["/imu/imu"]
    turn, force = imu.angular_velocity, imu.linear_acceleration
    assert (turn.x, turn.y, turn.z) == (0.1, 0.2, 0.3)
    assert (force.x, force.y, force.z) == (1.0, 2.0, 9.81)
    assert imu.orientation_covariance[0] == -1.0
    assert imu.header.frame_id == "imu"
    assert messages["/bumper"][0].data.tolist() == [0.0, 1.0, 0.0]


def _matrix(q: Any, at: Any) -> NDArray[np.float64]:
    x, y, z, w = q
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, at
    return pose


def _from_rpy(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """x, y, z, w of turns about fixed x, then y, then z."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a / 2), math.sin(a / 2)) for a in (roll, pitch, yaw))
    return (
        sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy,
    )  # fmt: skip


def test_frames_of_recording_urdf_and_sensors_agree(tmp_path: Path) -> None:
    model, infos = _infos()
    (static,) = _recorded(tmp_path, "all")["/tf_static"]
    recorded = {
        t.child_frame_id: (t.header.frame_id, _matrix(
            (t.transform.rotation.x, t.transform.rotation.y, t.transform.rotation.z,
             t.transform.rotation.w),
            (t.transform.translation.x, t.transform.translation.y, t.transform.translation.z),
        ))
        for t in static.transforms
    }  # fmt: skip
    urdf = URDF.from_xml_string(to_urdf(model, infos, "robot").encode())
    described = {
        j.child: (j.parent, _matrix(_from_rpy(*j.origin.rpy), j.origin.xyz))
        for j in urdf.joints
        if j.type == "fixed"
    }
    assert recorded.pop("odom")[0] == "map"
    mounted = {i.frame for i in infos.values() if i.category != "odometry"}
    assert set(recorded) == set(described) == {*mounted, "base_link", "camera_optical"}
    for frame, (parent, pose) in recorded.items():
        assert described[frame][0] == parent
        np.testing.assert_allclose(described[frame][1], pose, atol=1e-9)
    for info in infos.values():
        if info.category != "odometry":
            x, y, z, yaw = info.mount
            expected = _matrix(_from_rpy(0, 0, yaw), (x, y, z))
            np.testing.assert_allclose(recorded[info.frame][1], expected, atol=1e-12)
    eye = recorded["camera_optical"][1][:3, :3]
    np.testing.assert_allclose(eye @ [0, 0, 1], [1, 0, 0], atol=1e-12)  # looks ahead
    np.testing.assert_allclose(eye @ [1, 0, 0], [0, -1, 0], atol=1e-12)  # right
    np.testing.assert_allclose(eye @ [0, 1, 0], [0, 0, -1], atol=1e-12)  # down
