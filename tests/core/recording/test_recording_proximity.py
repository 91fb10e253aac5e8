"""Readings of sonars and multi-layer lidars, as ROS tools see them in a recording."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.registry.registry import discover
from crowdbot.core.sensing.build import build_sensor
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.plugin import Reading, SensorInfo
from crowdbot.testing.sensor_scenes import context

REGISTRY = discover(allow=())
FIELDS: dict[str, dict[str, Any]] = {
    "us0": {"kind": "ultrasound", "mount": {"x": 0.17, "z": 0.15}},
    "eye": {"kind": "infrared"},
    "dome": {"kind": "lidar3d", "angle_step": "45 deg", "layers": 3},
}


def info_of(fields: dict[str, Any]) -> SensorInfo:
    spec = REGISTRY.spec_model("sensor", fields["kind"]).model_validate(fields)
    info: SensorInfo = build_sensor(REGISTRY, cast(SensorSpec, spec), context()).info()
    return info


INFOS = {name: info_of(fields) for name, fields in FIELDS.items()}


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("proximity") / "run.mcap"
    header = RecordingHeader(
        scenario="test/one", robot=RobotHeader(radius=0.2, mass=6.3), sensors=INFOS
    )
    writer = RecordingWriter(path, header)
    writer.state(0.0, (0.0,) * 5, None)
    for t in (0.0, 0.125):
        writer.reading("us0", Reading(t, np.array([1.25 + t])))
        writer.reading("eye", Reading(t, np.array([np.inf])))
        writer.reading("dome", Reading(t, dome(t)))
    writer.close(None, True, "timeout")
    return path


def dome(t: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    ranges = np.arange(24.0).reshape(3, 8) + 1.0 + t
    ranges[1, 2] = np.inf
    return ranges


def decoded(path: Path, topic: str) -> list[Any]:
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        return [m.decoded_message for m in reader.iter_decoded_messages(topics=[topic])]


def test_ranges(path: Path) -> None:
    near, free = decoded(path, "/us0/range"), decoded(path, "/eye/range")
    assert [m.range for m in near] == [1.25, 1.375]
    assert [m.range for m in free] == [math.inf, math.inf]
    assert (near[0].radiation_type, free[0].radiation_type) == (0, 1)
    assert near[1].field_of_view == pytest.approx(0.659, abs=1e-3)
    assert free[1].field_of_view == pytest.approx(math.radians(1.0))
    assert (near[0].min_range, near[0].max_range) == (pytest.approx(0.2), pytest.approx(4.5))
    assert near[1].header.frame_id == INFOS["us0"].frame
    assert (near[1].header.stamp.sec, near[1].header.stamp.nanosec) == (0, 125_000_000)


def test_point_cloud(path: Path) -> None:
    first, second = decoded(path, "/dome/points")
    assert [(f.name, f.offset, f.datatype, f.count) for f in second.fields] == [
        ("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1),
    ]  # fmt: skip
    assert (second.height, second.width, second.point_step, second.row_step) == (3, 8, 12, 96)
    assert (second.is_bigendian, second.is_dense) == (False, False)
    points = np.frombuffer(second.data, "<f4").reshape(3, 8, 3)
    ranges = np.linalg.norm(points, axis=-1)
    assert np.isnan(points[1, 2]).all()
    ranges[1, 2] = np.inf
    np.testing.assert_allclose(ranges, dome(0.125), rtol=1e-6)
    azimuth = np.degrees(np.arctan2(points[0, :, 1], points[0, :, 0]))
    assert np.mod(azimuth, 360) == pytest.approx(np.mod(np.arange(8) * 45.0 - 180.0, 360), abs=1e-3)
    height = np.degrees(np.arcsin(points[:, 0, 2] / dome(0.125)[:, 0]))
    assert height == pytest.approx([-15.0, 0.0, 15.0], abs=1e-3)
    assert first.header.stamp.nanosec == 1  # 0 would be "the latest"


def test_the_header_reads_back(path: Path) -> None:
    sensors = Recording(path).info.header.sensors
    for name, info in INFOS.items():
        assert info.angles is not None
        assert sensors[name].angles is not None
        np.testing.assert_array_equal(sensors[name].angles, info.angles)
        assert (sensors[name].shape, sensors[name].mount) == (info.shape, info.mount)
    assert all(scan.cone for scan in Recording(path).scans())


def test_cones_for_the_replay(path: Path) -> None:
    found = {cone.sensor: cone for cone in Recording(path).scans()}
    assert set(found) == {"us0", "eye"}
    assert found["us0"].ranges.tolist() == [[1.25], [1.375]]
    assert found["us0"].t.tolist() == [0.0, 0.125]
    assert found["us0"].cone
    np.testing.assert_array_equal(found["eye"].angles, INFOS["eye"].angles)
    assert len(Recording(path, max_rate=4.0).scans()[0].t) == 1


def test_a_sensor_may_use_its_array_again(tmp_path: Path) -> None:
    path, array = tmp_path / "run.mcap", np.zeros(1)
    header = RecordingHeader(
        scenario="test/one", robot=RobotHeader(radius=0.2, mass=6.3), sensors=INFOS
    )
    writer = RecordingWriter(path, header)
    writer.state(0.0, (0.0,) * 5, None)
    for k in range(3):
        array[0] = 1.0 + k
        writer.reading("us0", Reading(0.125 * k, array))
    writer.close(None, True, "timeout")
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        read = [m.range for _, _, _, m in reader.iter_decoded_messages(["/us0/range"])]
    assert read == [1.0, 2.0, 3.0]


def test_rows_are_in_the_order_in_which_they_were_handed_over(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    header = RecordingHeader(
        scenario="test/one", robot=RobotHeader(radius=0.2, mass=6.3), sensors=INFOS
    )
    writer = RecordingWriter(path, header)
    for k in range(5000):  # more than wait for a flush
        writer.state(k / 16, (float(k), 0.0, 0.0, 0.0, 0.0), None)
        writer.signal(k / 16, "k", float(k))
    writer.close(None, True, "timeout")
    run = Recording(path).trajectories()
    assert run.robot is not None
    assert run.robot.x.tolist() == run.signals["k"][:, 1].tolist() == list(range(5000))
