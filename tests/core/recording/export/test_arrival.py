"""A run ends between two samples; what is exported says all the same that the robot arrived."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot import cli
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.core.recording.recording_cases import ZONE, Run, random_run, write_run

BODY: Any = {"robot_radius": 0.2, "robot_mass": 10.0}


def _approach(v: float, gap: float, heading: float = 0.0) -> Run:
    """A robot whose last sample is ``gap`` m before the zone."""
    t = np.arange(40) / 16.0
    along = v * (t - t[-1])
    x, y = 45.0 - gap + along * np.cos(heading), 0.5 + along * np.sin(heading)
    constant = np.zeros_like(t)
    robot = np.column_stack((x, y, constant + heading, constant + v, constant))
    return replace(random_run(), robot=robot)


@pytest.mark.parametrize(
    ("topic", "record", "ahead"),
    [("/robot/pose", "all", 2e-3), ("/robot/pose", "none", -2e-3), ("/tf", "all", -2e-3),
     ("/tf", "used", 0.0)],
)  # fmt: skip
def test_a_bag_says_when_the_robot_arrived(
    tmp_path: Path, topic: str, record: str, ahead: float
) -> None:
    run = _approach(0.6, 0.03)
    arrived = float(run.t[-1]) + (0.03 + ahead) / 0.6  # it slowed down, or gained speed
    path, out = tmp_path / "run.mcap", tmp_path / "bag"
    write_run(path, run, record=record, goal_time=arrived)  # type: ignore[arg-type]
    assert cli.main(["export", str(path), "--to", "rosbag2", "--out", str(out)]) == 0
    found = Trajectories.from_rosbag(out, robot=topic, goal_zone=ZONE, **BODY)
    assert found.robot is not None
    assert found.robot.goal_time == pytest.approx(arrived, abs=4e-3)
    assert found.robot.x[-1] == pytest.approx(45.0, abs=3e-3)
    assert found.robot.y[-1] == pytest.approx(0.5, abs=1e-3)


def test_a_robot_that_did_not_arrive_gets_no_further_pose(tmp_path: Path) -> None:
    path, out = tmp_path / "run.mcap", tmp_path / "bag"
    write_run(path, _approach(0.6, 0.03), goal_time=None)
    assert cli.main(["export", str(path), "--to", "rosbag2", "--out", str(out)]) == 0
    found = Trajectories.from_rosbag(out, robot="/robot/pose", goal_zone=ZONE, **BODY)
    assert found.robot is not None
    assert found.robot.goal_time is None
    assert found.t[-1] == pytest.approx(39 / 16.0)
