"""Sensors with roll and pitch: recordings, frames, replays, and what planners make of them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.scenery import static_frames
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.replay.encode_scans import encode_scans
from crowdbot.core.sensing.points import LidarPoints
from crowdbot.plugin import Reading, SensorInfo
from tests.core.recording.recording_cases import LIDAR, LIMITS, ODOMETRY, WALLS, ZONE

TILT = (0.3, 0.4)
TILTED = replace(LIDAR, tilt=TILT)


def _header(**sensors: SensorInfo) -> RecordingHeader:
    robot = RobotHeader(radius=0.2, mass=6.0, limits=LIMITS, base_height=0.05)
    return RecordingHeader(
        scenario="s", robot=robot, sensors={**sensors, "odometry": ODOMETRY}, walls=WALLS,
        goal_zone=ZONE,
    )  # fmt: skip


def _write(path: Path, header: RecordingHeader) -> Path:
    writer = RecordingWriter(path, header, record="used")
    writer.state(0.0, (0.0, 0.0, 0.0, 0.0, 0.0), None)
    writer.reading("front", Reading(0.0, np.full(33, 2.0)))
    writer.close(None, complete=True, status="time_limit")
    return path


def test_tilts_come_back(tmp_path: Path) -> None:
    path = _write(tmp_path / "a.mcap", _header(front=TILTED))
    info = Recording(path).info
    assert info.topics["/crowdbot/tilts"] == ("crowdbot_msgs/msg/SensorTilts", 1)
    assert info.header.sensors["front"].tilt == TILT
    assert info.header.sensors["odometry"].tilt == (0.0, 0.0)
    (scan,) = Recording(path).scans()
    assert scan.tilt == TILT
    (again,) = Recording(path, max_rate=8.0).scans()
    assert again.tilt == TILT
    meta, _ = encode_scans([scan])
    assert meta["scans"][0]["tilt"] == list(TILT)


def test_a_run_of_level_sensors_has_no_such_topic(tmp_path: Path) -> None:
    path = _write(tmp_path / "a.mcap", _header(front=LIDAR))
    assert "/crowdbot/tilts" not in Recording(path).info.topics
    (scan,) = Recording(path).scans()
    assert scan.tilt == (0.0, 0.0)
    assert "tilt" not in encode_scans([scan])[0]["scans"][0]


def test_the_static_frame_has_the_whole_rotation() -> None:
    frames = {f.child_frame_id: f.transform for f in static_frames(_header(front=TILTED))}
    turn = frames["front_lidar"].rotation
    expected = Rotation.from_euler("xyz", [*TILT, LIDAR.mount[3]])
    found = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])
    assert (found * expected.inv()).magnitude() < 1e-12


def test_what_a_tilted_lidar_sees_of_the_floor_is_no_obstacle() -> None:
    """30 degrees down from 0.5 m: the floor is at 1 m, a point above it at 0.8 m is 0.1 m high."""
    pitch = math.radians(30.0)
    down = replace(
        LIDAR, mount=(0.2, 0.0, 0.5, 0.0), tilt=(0.0, pitch), angles=np.array([0.0]), shape=(1,)
    )
    points = LidarPoints({"front": down})
    for away, kept in ((1.0, False), (0.95, False), (0.8, True)):
        found = points({"front": Reading(0.0, np.array([away]))}, 0.0, (0.0, 0.0))
        assert (len(found) == 1) == kept
    np.testing.assert_allclose(found, [[0.2 + 0.8 * math.cos(pitch), 0.0]], atol=1e-12)


def test_one_that_looks_up_keeps_what_it_sees() -> None:
    up = replace(LIDAR, mount=(0.0, 0.0, 0.3, 0.0), tilt=(0.0, -0.5), angles=np.array([0.0]),
                 shape=(1,))  # fmt: skip
    found = LidarPoints({"up": up})({"up": Reading(0.0, np.array([9.0]))}, 0.0, (0.0, 0.0))
    assert found == pytest.approx(np.array([[9.0 * math.cos(0.5), 0.0]]))
