"""Velocities of bags that are not filled in, or that the positions contradict."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import RecordingWarning
from tests.core.trajectories.bag.bag_kit import (
    TIMES,
    Row,
    make,
    marker_rows,
    odometry,
    point,
    pose,
    read,
    robot_rows,
    transform,
    twist,
    walkers,
    write,
)


def _odometry(yaw: float, vx: float, vy: float = 0.0) -> list[Row]:
    """A robot that goes at 0.5 m/s where it looks, with a twist that may say something else."""
    step = 0.5 * math.cos(yaw), 0.5 * math.sin(yaw)
    return [
        ("/odom", t, odometry(t, pose(step[0] * t, step[1] * t, yaw), twist(vx, vy))) for t in TIMES
    ]


def test_a_twist_that_is_never_filled_in_is_unknown(tmp_path: Path) -> None:
    run = read(write(tmp_path / "bag", _odometry(0.0, 0.0)), people=None)
    speed = {s.variant: s.value for s in crowdbot.score(run, metrics=["speed"])}
    assert speed["avg"] == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("yaw", "vx", "vy", "expected"),
    [
        (math.pi / 2, 0.0, 0.5, "taken in the world's frame"),
        (math.pi, -0.5, 0.0, "taken in the world's frame"),
        (math.pi / 2, 1.8, 0.0, "1.8 m/s (median), the way of a second 0.5 m: km/h?"),
        (0.3, 500.0, 0.0, "mm/s?"),
        (0.3, 0.1, 0.0, "0.1 m/s (median), the way of a second 0.5 m;"),
    ],
)
def test_what_positions_contradict_is_told(
    tmp_path: Path, yaw: float, vx: float, vy: float, expected: str
) -> None:
    with pytest.warns(RecordingWarning) as found:
        read(write(tmp_path / "bag", _odometry(yaw, vx, vy)), people=None)
    (warning,) = found
    assert expected in str(warning.message)


@pytest.mark.parametrize("yaw", [0.0, 1.0, math.pi])
@pytest.mark.parametrize("vx", [0.5, 0.45, 0.6])
def test_what_agrees_is_not(tmp_path: Path, yaw: float, vx: float) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(write(tmp_path / "bag", _odometry(yaw, vx)), people=None)


def test_who_drives_backwards_is_not_told(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/odom", t, odometry(t, pose(-0.5 * t, 0.0, 0.2), twist(-0.5))) for t in TIMES
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(write(tmp_path / "bag", rows), people=None)


def test_speeds_of_people_are_compared_too(tmp_path: Path) -> None:
    def person(number: int, x: float, y: float) -> object:
        # the second one is a student, not a robot
        name = ("anna", "robotics_student")[number - 1]
        return make("people_msgs/Person", name, point(x, y), point(3.0, 0.0), 1.0, [], [])

    rows = robot_rows()
    for t in TIMES:
        head = odometry(t, pose(0, 0), twist()).header
        rows.append(
            ("/people", t, make("people_msgs/People", head, [person(*w) for w in walkers(t)]))
        )
    with pytest.warns(RecordingWarning, match="people: the recorded speed is 3 m/s"):
        run = read(write(tmp_path / "bag", rows))
    assert run.agents is not None
    assert run.agents.x.shape[1] == 2


def test_a_transform_that_ends_early_is_told(tmp_path: Path) -> None:
    rows = marker_rows()
    rows += [("/tf", t, transform(t, "map", "odom", (3.0, 2.0, 0.0))) for t in (0.1, 1.0, 2.0)]
    rows += [
        ("/tf", t, transform(t, "odom", "base_link", (0.5 * t - 3.0, -2.0, 0.0))) for t in TIMES
    ]
    with pytest.warns(RecordingWarning, match=r"'odom' to 'map' is sent from 0 to 1.9 s of 4.8 s"):
        run = read(write(tmp_path / "bag", rows), robot="/tf")
    np.testing.assert_allclose(run.t[-1], 1.9)
