"""Tables of others whose units, axes or names of columns are not ours."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import InputError, RecordingWarning

READ = crowdbot.Trajectories
BODY: dict[str, Any] = {"robot_radius": 0.2, "robot_mass": 20.0}


def _table(path: Path, head: str, row: str, n: int = 40) -> Path:
    """A table whose row is a format of k, t = k / 10 and x = k / 2."""
    rows = [row.format(k=k, t=k / 10, x=0.5 * k) for k in range(n)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


def test_units_after_names(tmp_path: Path) -> None:
    path = _table(tmp_path / "r.csv", "t_s,pos_x_mm,pos_y_mm,heading_deg", "{t},{k}00,0,0")
    run = READ.from_csv(path, **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.x, 0.1 * np.arange(40))
    people = {"t": [0.0, 0.1], "id": [1, 1], "x_cm": [0, 10], "y_cm": [100, 100]}
    found = READ.from_pandas(agents={**people, "radius_cm": [30, 30]}).agents
    assert found is not None
    assert (found.x[1, 0], found.y[1, 0], found.radius[0]) == pytest.approx((0.1, 1.0, 0.3))


def _arc(tmp_path: Path, head: str, factor: float) -> crowdbot.Trajectories:
    rows = [
        f"{0.1 * k},{math.cos(0.02 * k)},{math.sin(0.02 * k)},{0.02 * k + math.pi / 2},"
        f"{0.2 * factor}"
        for k in range(40)
    ]
    (tmp_path / "r.csv").write_text("\n".join([f"t,x,y,theta,{head}", *rows]))
    return READ.from_csv(tmp_path / "r.csv", **BODY)


def test_rates_of_turning_in_degrees(tmp_path: Path) -> None:
    for head in ("w [deg/s]", "omega_deg"):
        robot = _arc(tmp_path, head, 180 / math.pi).robot
        assert robot is not None
        np.testing.assert_allclose(robot.w, 0.2)
    assert _arc(tmp_path, "w", 1.0).implausible() == []
    with pytest.warns(RecordingWarning, match=r"w is 11.5 rad/s .* changes by 0.2 rad/s: degrees"):
        _arc(tmp_path, "w", 180 / math.pi)


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("__time,/odom/pose/pose/position/x,/odom/pose/pose/position/y", "{t},{x},1"),
        (
            "%time,field.pose.pose.position.x,field.pose.pose.position.y",
            "17600000{k:02d}000000000,{x},1",  # ns since 1970
        ),
        ("timestamp,pose.position.x,pose.position.y", "{t},{x},1"),
    ],
)
def test_fields_of_messages(tmp_path: Path, head: str, row: str) -> None:
    run = READ.from_csv(_table(tmp_path / "r.csv", head, row), **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.x, 0.5 * np.arange(40))
    np.testing.assert_allclose(run.robot.y, 1.0)


def test_two_poses_in_a_row_are_not_guessed(tmp_path: Path) -> None:
    head = "t,/a/position/x,/a/position/y,/b/position/x,/b/position/y"
    with pytest.raises(InputError, match="columns x, y are missing"):
        READ.from_csv(_table(tmp_path / "r.csv", head, "{t},{x},1,0,0"), **BODY)


@pytest.mark.parametrize("stamp", ["10:00:0{k}.5", "01.05.2026 10:00:0{k}"])
def test_times_of_day_are_refused_with_what_to_write(tmp_path: Path, stamp: str) -> None:
    path = _table(tmp_path / "r.csv", "time,x,y", stamp + ",{x},0", n=9)
    with pytest.raises(InputError, match=r"r.csv:2: t: '.*' is neither .* ISO 8601: write 2026-"):
        READ.from_csv(path, **BODY)


def test_y_upwards_is_told(tmp_path: Path) -> None:
    with pytest.warns(RecordingWarning, match=r"y is 0 m in all rows, and z is not"):
        READ.from_csv(_table(tmp_path / "r.csv", "t,x,y,z", "{t},{x},0,{x}"), **BODY)
    READ.from_csv(_table(tmp_path / "r.csv", "t,x,y,z", "{t},{x},0,0.1"), **BODY)


def test_longitude_and_latitude_are_told(tmp_path: Path) -> None:
    path = _table(tmp_path / "r.csv", "t,x,y", "{t},2.35{k:04d},48.85")
    with pytest.warns(RecordingWarning, match="speed 1e-05 m/s, .* longitude"):
        READ.from_csv(path, **BODY)
    noise = np.random.default_rng(1).normal(0.0, 1e-4, 100).cumsum() * 0.1
    at = {"t": np.arange(100) / 10, "x": noise - noise.mean(), "y": np.zeros(100)}
    at["x"][-1] = at["x"][0]  # a robot that stands
    assert READ.from_pandas(at, **BODY).implausible() == []


@pytest.mark.parametrize(
    ("columns", "body", "expected"),
    [
        ({"radius": 25}, {}, "people: median radius 25 m: centimetres"),
        ({"radius": 250}, {}, "people: median radius 250 m: millimetres"),
        ({"mass": 75_000}, {}, "people: median mass 75000 kg: grams"),
        ({}, {"robot_radius": 200}, "robot_radius 200 m: millimetres"),
        ({}, {"robot_mass": 50_000}, "robot_mass 50000 kg: grams"),
    ],
)
def test_bodies_in_other_units(
    columns: dict[str, float], body: dict[str, Any], expected: str
) -> None:
    t = np.arange(20) / 10
    robot = {"t": t, "x": t, "y": 0 * t}
    people = {"t": t, "id": 0 * t, "x": 5 - t, "y": 0 * t + 1}
    people |= {name: np.full(20, value) for name, value in columns.items()}
    with pytest.warns(RecordingWarning, match=expected):
        READ.from_pandas(robot, people, **{**BODY, **body})


@pytest.mark.parametrize("nowhere", [-1, -9999, 999])
def test_numbers_that_stand_for_no_place_are_told(nowhere: float) -> None:
    t = np.arange(40) / 10
    x, y = 5 - t, 1 + 0 * t
    x[25:] = y[25:] = nowhere
    with pytest.warns(
        RecordingWarning, match=rf"in 15 samples .* exactly \({nowhere:g}, "
    ) as caught:
        READ.from_pandas(agents={"t": t, "id": 0 * t + 3, "x": x, "y": y})
    assert len(caught) == 1  # nor is it reported as a jump


def test_people_in_another_unit_of_time_are_refused_where_no_one_would_be_left() -> None:
    t = np.arange(40) / 10
    robot = {"t": t, "x": t, "y": 0 * t}
    people = {"t": 1000 * t, "id": 0 * t, "x": 5 - t, "y": 0 * t}
    message = r"the rows of a person are 100 s apart \(median\), .* max_gap = 1 s"
    with pytest.raises(InputError, match=message):
        READ.from_pandas(robot, people, resample="robot", **BODY)
    people["t"] = t + 0.03
    READ.from_pandas(robot, people, resample="robot", **BODY)
