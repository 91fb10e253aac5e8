"""A sensor's own message, read back by mcap_ros2 and rosbags, neither of which knows its type."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.declared_message import message_from
from crowdbot.core.recording.export.bag import BagOptions, write_ros1, write_ros2
from crowdbot.core.recording.topics import sensor_topics
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.errors import PluginError
from crowdbot.plugin import Array, Reading, SensorInfo, SensorMessage
from tests.core.recording.recording_cases import (
    LIDAR,
    ODOMETRY,
    SMELL,
    header_of,
    random_run,
    write_samples,
)

GAS = "test_msgs/msg/GasCloud"
PEAK = "test_msgs/msg/GasPeak"
DEFINITIONS = {
    PEAK: "float64 x\nfloat64 ppm\n",
    GAS: "std_msgs/Header header\nstring gas\nbool alarm\nuint8 level\nfloat32[] ppm\n"
    "float64[2] wind\ngeometry_msgs/Vector3 drift\ntest_msgs/GasPeak[] peaks\nstring[] notes\n",
}


def fields(values: Array) -> dict[str, Any]:
    return {
        "gas": "CO",
        "alarm": values[0] > 1.0,
        "level": 7,
        "ppm": values,
        "wind": [0.5, -0.25],
        "drift": {"x": values[1], "y": 0.0, "z": 0.0},
        "peaks": [{"x": 1.0, "ppm": values[0]}, {"x": 2.0, "ppm": values[2]}],
        "notes": ["seen", "smelt"],
    }


SENSOR = SensorInfo(
    category="nose", frame="nose", mount=(0.0, 0.0, 1.0, 0.0), rate=4.0, shape=(3,),
    ros_type=GAS, message=SensorMessage(fields=fields, definitions=DEFINITIONS, topic="gas"),
)  # fmt: skip
VALUES = np.array([1.5, 0.25, 3.0])


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording with two messages of the sensor."""
    path, run = tmp_path_factory.mktemp("own") / "run.mcap", random_run()
    sensors = {"front": LIDAR, "wheels": ODOMETRY, "nose": SMELL, "sniffer": SENSOR}
    writer = RecordingWriter(path, header_of(run, sensors=sensors))
    write_samples(writer, run)
    for t in (0.0, 0.25):
        writer.reading("sniffer", Reading(t, VALUES + t))
    writer.close(None, True, "timeout")
    return path


def assert_gas(message: Any, t: float, frame: str = "nose") -> None:
    a, b, c = (VALUES + t).tolist()
    stamp = message.header.stamp
    assert stamp.sec + stamp.nanosec / 1e9 == pytest.approx(t, abs=2e-9)
    assert message.header.frame_id == frame
    assert (message.gas, message.alarm, message.level) == ("CO", True, 7)
    assert list(message.ppm) == [a, b, c]  # few digits: single precision has them exactly
    assert (list(message.wind), message.drift.x) == ([0.5, -0.25], b)
    assert [(p.x, p.ppm) for p in message.peaks] == [(1.0, a), (2.0, c)]
    assert list(message.notes) == ["seen", "smelt"]


def test_mcap_ros2_decodes_it(path: Path) -> None:
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        found = [(s, m) for s, _, _, m in reader.iter_decoded_messages(["/sniffer/gas"])]
    assert [schema.name for schema, _ in found if schema] == [GAS, GAS]
    for t, (_, message) in zip((0.0, 0.25), found, strict=True):
        assert_gas(message, t)


def test_rosbags_decodes_it_from_bags_of_both_ros(path: Path, tmp_path: Path) -> None:
    write_ros2(path, tmp_path / "two", BagOptions(offset=0))
    write_ros1(path, tmp_path / "one.bag", BagOptions(offset=0))
    for bag in (tmp_path / "two", tmp_path / "one.bag"):
        with AnyReader([bag]) as reader:
            wanted = [c for c in reader.connections if c.topic == "/sniffer/gas"]
            rows = list(reader.messages(connections=wanted))
            assert len(rows) == 2
            for (connection, _, raw), t in zip(rows, (0.0, 0.25), strict=True):
                assert_gas(reader.deserialize(raw, connection.msgtype), t)


def test_a_recording_names_the_types_it_has(path: Path) -> None:
    """A process that does not have the plugin learns them from the file."""
    text = ros.definition(GAS).decode()
    with path.open("rb") as file:
        schemas = make_reader(file).get_summary().schemas.values()  # type: ignore[union-attr]
    (kept,) = (s.data.decode() for s in schemas if s.name == GAS)
    assert kept == text
    ros.declare({GAS: kept})


@pytest.mark.parametrize(
    ("changes", "because"),
    [
        ({"definitions": {GAS: "float64 gas\n"}}, "test_msgs/msg/GasCloud"),
        ({"definitions": {"test_msgs/msg/Odd": "float64\n"}}, "msg/Odd: Could not parse"),
        ({"definitions": {"test_msgs/msg/Lost": "far_msgs/Away x\n"}}, "far_msgs/msg/Away"),
    ],
)
def test_definitions_that_are_none(changes: dict[str, Any], because: str) -> None:
    ros.declare(DEFINITIONS)
    assert SENSOR.message is not None
    with pytest.raises(PluginError, match=f"'nose'.*{because}"):
        sensor_topics({"nose": replace(SENSOR, message=replace(SENSOR.message, **changes))})


def test_a_type_without_a_definition() -> None:
    message = SensorMessage(fields=fields)
    unknown = replace(SENSOR, ros_type="test_msgs/msg/Nowhere", message=message)
    with pytest.raises(PluginError, match="no definition of test_msgs/msg/Nowhere"):
        sensor_topics({"nose": unknown})


@pytest.mark.parametrize(
    ("changed", "because"),
    [
        (
            lambda f: {k: v for k, v in f.items() if k != "level"},
            r"missing or unknown: \['level'\]",
        ),
        (lambda f: f | {"colour": 3}, r"missing or unknown: \['colour'\]"),
        (lambda f: f | {"wind": [1.0]}, r"1 numbers where float64\[2\] is wanted"),
        (lambda f: f | {"drift": {"x": 1.0}}, r"missing or unknown: \['y', 'z'\]"),
        (lambda f: f | {"level": "high"}, "invalid literal"),
        (lambda f: f | {"peaks": 3}, "not iterable"),
    ],
)
def test_fields_that_are_not_those_of_the_type(changed: Any, because: str) -> None:
    message = SensorMessage(fields=lambda v: changed(fields(v)), definitions=DEFINITIONS)
    topic = sensor_topics({"nose": replace(SENSOR, message=message)})["nose"]
    assert topic.name == "/nose"
    with pytest.raises(PluginError, match=f"GasCloud of sensor 'nose': .*{because}"):
        topic.message(0, VALUES)


def test_types_of_humble_need_no_definition() -> None:
    """As the joystick's; of a temperature, which has no encoder either."""
    kind = "sensor_msgs/msg/Temperature"

    def degrees(values: Array) -> Mapping[str, Any]:
        return {"temperature": values[0], "variance": 0.0}

    info = replace(SENSOR, ros_type=kind, message=SensorMessage(fields=degrees))
    topic = sensor_topics({"nose": info})["nose"]
    found = ros.from_cdr(topic.message(5, VALUES), topic.msgtype)
    assert (found.temperature, found.header.stamp.nanosec) == (1.5, 5)


def test_nested_messages_may_be_objects() -> None:
    ros.declare(DEFINITIONS)
    head = ros.header(1, "a")
    found = message_from(GAS, fields(VALUES) | {"header": head})
    assert found.header is head
