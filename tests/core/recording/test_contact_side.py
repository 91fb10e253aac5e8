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
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.writer import RecordingWriter
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


def test_a_writer_that_is_told_no_bearing(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    writer = RecordingWriter(path, header_of(RUN), record="none")
    writer.state(0.0, RUN.robot[0], RUN.agents[0])  # type: ignore[index]
    writer.contact(0.0, 0.1, -1, 1.0, 2.0, 3.0)
    writer.close(None, True, "timeout")
    contacts = Recording(path).trajectories().contacts
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
