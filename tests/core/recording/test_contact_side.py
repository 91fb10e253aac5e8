"""Where on the robot a contact was: kept by recordings and tables, unknown in older ones."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.geometry.footprint import body_side
from crowdbot.core.recording import RecordingWriter, read_trajectories, recording_info, typestore
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError
from crowdbot.plugin import Pinhole, SensorInfo
from tests.core.recording.recording_cases import header_of, random_run

RUN = random_run(n=3, m=2)
CAMERA = SensorInfo(
    category="camera", frame="eye", mount=(0.1, 0.0, 0.3, 0.0), rate=8.0, shape=(48, 64),
    ros_type="sensor_msgs/msg/Image", privileged=True,
    camera=Pinhole(width=64, height=48, focal=55.5, colour=True),
)  # fmt: skip


@given(st.floats(-10.0, 10.0))
def test_words_for_sides(bearing: float) -> None:
    """A quarter of the circle each, however many turns are in the angle; left mirrors right."""
    words = {"front": (1, 0), "left": (0, 1), "right": (0, -1), "rear": (-1, 0)}
    x, y = words[body_side(bearing)]
    assert x * math.cos(bearing) + y * math.sin(bearing) >= math.cos(0.25 * math.pi) - 1e-9
    mirrored = {"left": "right", "right": "left"}
    assert body_side(-bearing) == mirrored.get(body_side(bearing), body_side(bearing))


def test_no_word_for_what_is_not_known() -> None:
    assert body_side(math.nan) == "unknown"


def _write(path: Path, version: int) -> None:
    """A recording of either format: header, samples and one contact."""
    header = header_of(RUN, sensors={"eye": CAMERA}).to_message()
    header.version = version
    contact = {
        "header": ros.header(0, "map"), "t0": 0.25, "t1": 0.5, "agent": 100, "impulse": 1.5,
        "peak_force": 20.0, "relative_speed": 0.7, "bearing": -2.5,
    }  # fmt: skip
    store = typestore._store(oldest=version == 1)
    if version == 1:
        del contact["bearing"]
        fields = ("version", "scenario", "hash_names", "hashes", "robot", "agents", "sensors")
        given = {n: getattr(header, n) for n in (*fields, "walls", "goal_zone")}
        header = store.types["crowdbot_msgs/msg/RunHeader"](**given)
    file = McapFile(path)
    for topic, kind, message in (
        (Topic.HEADER, "crowdbot_msgs/msg/RunHeader", header),
        (Topic.CONTACTS, "crowdbot_msgs/msg/Contact",
         store.types["crowdbot_msgs/msg/Contact"](**contact)),
    ):  # fmt: skip
        file.put_bytes(topic, 0, kind, bytes(store.serialize_cdr(message, kind)))
    assert RUN.robot is not None
    assert RUN.agents is not None
    state = ros.new(
        "crowdbot_msgs/RunState", t=0.0, robot=RUN.robot[0], agents=RUN.agents[0].ravel(),
        has_jump=False, jump=np.zeros(0, np.bool_),
    )  # fmt: skip
    file.put(Topic.STATE, 0, state)
    file.close()


@pytest.mark.parametrize("version", [1, 2])
def test_both_formats_are_read(tmp_path: Path, version: int) -> None:
    path = tmp_path / "run.mcap"
    _write(path, version)
    contacts = read_trajectories(path).contacts
    assert contacts is not None
    assert contacts.impulse.tolist() == [1.5]
    sensor = recording_info(path).header.sensors["eye"]
    if version == 1:
        assert np.isnan(contacts.bearing).all()
        assert (sensor.camera, sensor.privileged) == (None, False)
    else:
        assert contacts.bearing.tolist() == [-2.5]
        assert (sensor.camera, sensor.privileged) == (CAMERA.camera, True)


def test_another_format_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    _write(path, 5)
    with pytest.raises(InputError, match="format 5; this crowdbot reads formats 1, 2, 3 and 4"):
        read_trajectories(path)


def test_a_writer_that_is_told_no_bearing(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    writer = RecordingWriter(path, header_of(RUN), record="none")
    writer.state(0.0, RUN.robot[0], RUN.agents[0])  # type: ignore[index]
    writer.contact(0.0, 0.1, -1, 1.0, 2.0, 3.0)
    writer.close(None, True, "timeout")
    contacts = read_trajectories(path).contacts
    assert contacts is not None
    assert np.isnan(contacts.bearing).all()


TABLE: dict[str, Any] = {
    "t0": [0.5], "t1": [0.75], "agent": [-1], "impulse": [2.0], "peak_force": [30.0],
    "relative_speed": [0.4],
}  # fmt: skip
ROBOT = {"t": [0.0, 1.0], "robot_x": [0, 1], "robot_y": [0, 0], "robot_theta": [0, 0],
         "robot_radius": 0.2, "robot_mass": 6.3}  # fmt: skip


def test_tables_without_bearings_are_accepted() -> None:
    given: dict[str, Any] = dict(ROBOT)
    old = Trajectories.from_arrays(**given, contacts=TABLE).contacts
    new = Trajectories.from_arrays(**given, contacts={**TABLE, "bearing": [1.5]}).contacts
    assert old is not None
    assert new is not None
    assert np.isnan(old.bearing).all()
    assert new.bearing.tolist() == [1.5]
    with pytest.raises(InputError, match="bearing has shape"):
        Trajectories.from_arrays(**given, contacts={**TABLE, "bearing": [1.5, 2.0]})
    with pytest.raises(InputError, match="contacts needs the columns"):
        Trajectories.from_arrays(**given, contacts={"t0": [0.5]})


@pytest.mark.parametrize(("extra", "expected"), [("", math.nan), (",bearing", -0.5)])
def test_contacts_from_a_csv_file(tmp_path: Path, extra: str, expected: float) -> None:
    robot, contacts = tmp_path / "robot.csv", tmp_path / "contacts.csv"
    robot.write_text("t,x,y,theta,v,w\n0,0,0,0,1,0\n1,1,0,0,1,0\n")
    values = "0.5,0.75,-1,2,30,0.4" + (",-0.5" if extra else "")
    contacts.write_text(f"t0,t1,agent,impulse,peak_force,relative_speed{extra}\n{values}\n")
    run = Trajectories.from_csv(robot, robot_radius=0.2, robot_mass=6.3, contacts=contacts)
    assert run.contacts is not None
    assert run.contacts.agent.tolist() == [-1]
    assert run.contacts.bearing == pytest.approx([expected], nan_ok=True)
    contacts.write_text("t0,t1,agent,impulse,peak_force,relative_speed\n0.5,0.75,,2,30,0.4\n")
    with pytest.raises(InputError, match="a row has no agent"):
        Trajectories.from_csv(robot, robot_radius=0.2, robot_mass=6.3, contacts=contacts)
