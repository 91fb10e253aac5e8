"""Recordings as people have them: separators, names, stamps, clocks, what is left out."""

from __future__ import annotations

import json
import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import crowdbot
from crowdbot.core.trajectories.own_recordings import heading_of_motion
from crowdbot.core.trajectories.preprocess import with_velocities
from crowdbot.core.trajectories.resample import interpolated, steady_times
from crowdbot.errors import InputError, RecordingWarning, UnknownNameError

BODY: dict[str, Any] = {"robot_radius": 0.2, "robot_mass": 5.0}
T = np.arange(0.0, 10.0, 0.5)


def table(path: Path, columns: dict[str, Any], mark: str = ",") -> Path:
    rows = zip(*columns.values(), strict=True)
    lines = [mark.join(columns), *(mark.join(str(c) for c in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


def straight(path: Path, **more: Any) -> Path:
    return table(path, {"t": T, "x": 0.5 * T, "y": 0.0 * T, **more})


def test_heading_and_velocities_may_be_left_out(tmp_path: Path) -> None:
    run = crowdbot.Trajectories.from_csv(straight(tmp_path / "robot.csv"), **BODY)
    assert run.robot is not None
    np.testing.assert_array_equal(run.robot.theta, np.zeros(len(T)))
    robot = with_velocities(run).robot
    assert robot is not None
    np.testing.assert_allclose(robot.v, 0.5)
    np.testing.assert_allclose(robot.w, 0.0)
    speed = crowdbot.score(run, metrics="speed").find("speed", "avg")
    assert speed.value == pytest.approx(0.5)


@pytest.mark.parametrize("mark", [",", ";", "\t", " "])
def test_separators(tmp_path: Path, mark: str) -> None:
    path = table(tmp_path / "robot.csv", {"t": T, "x": T, "y": -T}, mark)
    run = crowdbot.Trajectories.from_csv(path, **BODY)
    assert run.robot is not None
    np.testing.assert_array_equal(run.robot.y, -T)


def test_decimal_commas(tmp_path: Path) -> None:
    path = tmp_path / "robot.csv"
    path.write_text("t;x;y\n0,5;1,25;-1e-1\n1,0;;2\n")
    run = crowdbot.Trajectories.from_csv(path, **BODY)
    assert run.robot is not None
    assert run.t.tolist() == [0.5, 1.0]
    assert run.robot.x[0] == 1.25
    assert math.isnan(run.robot.x[1])


def test_names_of_columns_and_of_people(tmp_path: Path) -> None:
    robot = table(tmp_path / "r.csv", {"sec": T, "pos_x": T * 0.5, "pos_y": 0 * T})
    agents = table(
        tmp_path / "a.csv",
        {"t": [0.0, 0.0, 0.5], "track": ["ada", "bob", "ada"], "x": [1, 2, 3], "y": [0, 0, 0]},
    )
    trips = table(tmp_path / "t.csv", {"agent": ["bob"], "t0": [0], "t1": [0.5], "reached": [1]})
    names = {"robot": {"t": "sec", "x": "pos_x", "y": "pos_y"}, "agents": {"id": "track"}}
    run = crowdbot.Trajectories.from_csv(robot, agents, trips, columns=names, **BODY)
    assert run.agents is not None
    assert run.trips is not None
    assert run.agents.id.tolist() == [0, 1]
    assert run.agents.x[:2].tolist()[0] == [1.0, 2.0]
    assert run.trips.agent.tolist() == [1]
    trips.write_text("agent,t0,t1,reached\nbo,0,1,1\n")
    with pytest.raises(InputError, match="no one is called 'bo'; did you mean 'bob'"):
        crowdbot.Trajectories.from_csv(robot, agents, trips, columns=names, **BODY)
    with pytest.raises(InputError, match="no column 'pos_xx'; did you mean 'pos_x'"):
        crowdbot.Trajectories.from_csv(robot, columns={"robot": {"x": "pos_xx"}}, **BODY)
    with pytest.raises(InputError, match="'xx' is not a column of ours"):
        crowdbot.Trajectories.from_csv(robot, columns={"robot": {"xx": "pos_x"}}, **BODY)
    with pytest.raises(InputError, match="columns: write"):
        crowdbot.Trajectories.from_csv(robot, columns={"x": "pos_x"}, **BODY)  # type: ignore[dict-item]


def test_stamps_count_from_the_robots_first(tmp_path: Path) -> None:
    robot = table(
        tmp_path / "r.csv",
        {
            "t": ["2026-05-01T10:00:00Z", "2026-05-01T10:00:00.500Z", "2026-05-01T12:00:01+02:00"],
            "x": [0, 1, 2],
            "y": [0, 0, 0],
        },
    )
    agents = table(
        tmp_path / "a.csv", {"t": ["2026-05-01 10:00:00.5"], "id": [3], "x": [1], "y": [2]}
    )
    run = crowdbot.Trajectories.from_csv(robot, agents, **BODY)
    assert run.t.tolist() == [0.0, 0.5, 1.0]
    assert run.agents is not None
    assert np.isfinite(run.agents.x[:, 0]).tolist() == [False, True, False]
    with pytest.raises(InputError, match="one table has stamps, the other seconds"):
        crowdbot.Trajectories.from_csv(robot, table(
            tmp_path / "b.csv", {"t": [0.5], "id": [3], "x": [1], "y": [2]}), **BODY)  # fmt: skip
    (tmp_path / "c.csv").write_text("t,x,y\n2026-05-01T10:00:00Z,0,0\n2026-13-01T10:00:00Z,0,0\n")
    with pytest.raises(InputError, match=r"c\.csv:3: t: not a stamp"):
        crowdbot.Trajectories.from_csv(tmp_path / "c.csv", **BODY)


def test_other_clocks_are_resampled(tmp_path: Path) -> None:
    robot = straight(tmp_path / "r.csv")
    at = np.array([10.1, 10.4, 11.0, 14.0, 14.3])
    agents = table(tmp_path / "a.csv", {"t": at, "id": 0 * at, "x": at, "y": 0.5 * at})
    with pytest.raises(InputError, match=r"a\.csv:2: t = 10\.1 s is not a sample.*resample"):
        crowdbot.Trajectories.from_csv(robot, agents, **BODY)
    run = crowdbot.Trajectories.from_csv(robot, agents, resample="robot", clock_offset=-10, **BODY)
    assert run.agents is not None
    assert run.t.tolist() == T.tolist()
    known = {0.5: 10.5, 1.0: 11.0, 4.0: 14.0}  # not between 11 and 14: nobody was seen for 3 s
    expected = [known.get(t, math.nan) for t in T]
    np.testing.assert_allclose(run.agents.x[:, 0], expected)
    fine = crowdbot.Trajectories.from_csv(
        robot, agents, resample=10, clock_offset=-10, max_gap=5, **BODY
    )
    assert fine.robot is not None
    assert len(fine.t) == 96
    np.testing.assert_allclose(fine.robot.x, 0.5 * fine.t)
    assert np.isfinite(fine.agents.x[:, 0]).sum() == 43  # type: ignore[union-attr]
    for wrong in ("people", 0.0, math.nan):
        with pytest.raises(InputError, match="resample"):
            crowdbot.Trajectories.from_csv(robot, agents, resample=wrong, **BODY)  # type: ignore[arg-type]


def test_headings_turn_the_shorter_way(tmp_path: Path) -> None:
    path = table(tmp_path / "r.csv", {"t": [0, 1], "x": [0, -1], "y": [0, 0], "theta": [3.1, -3.1]})
    run = crowdbot.Trajectories.from_csv(path, resample=2, **BODY)
    assert run.robot is not None
    assert math.cos(run.robot.theta[1]) == pytest.approx(-1.0)


@pytest.mark.parametrize(
    ("goal", "arrived"),
    [
        ({"robot_goal": (3.0, 0.0), "robot_goal_radius": 0.5}, 5.0),
        ({"robot_goal": (3.0, 0.0), "robot_goal_radius": 0.6}, 4.8),
        ({"robot_goal": (3.0, 0.0)}, 5.6),  # within its own radius
        ({"goal_zone": [(3, -1), (4, -1), (4, 1), (3, 1)]}, 6.0),
        ({"robot_goal": (30.0, 0.0), "robot_goal_radius": 0.5}, None),
        ({"robot_goal": (3.0, 0.0), "robot_goal_time": None}, None),
        ({"robot_goal": (3.0, 0.0), "robot_goal_time": 7.0}, 7.0),
    ],
)
def test_arrival_is_derived(tmp_path: Path, goal: dict[str, Any], arrived: float | None) -> None:
    run = crowdbot.Trajectories.from_csv(straight(tmp_path / "r.csv"), **BODY, **goal)
    assert run.robot is not None
    assert run.robot.goal_time == (None if arrived is None else pytest.approx(arrived))
    assert crowdbot.score(run, metrics="success")[0].value == (arrived is not None)


def test_without_a_goal_metrics_of_the_task_are_undefined(tmp_path: Path) -> None:
    run = crowdbot.Trajectories.from_csv(
        straight(tmp_path / "r.csv"), robot_speed_limit=1.0, **BODY
    )
    task = ["success", "success_no_collision", "timeout", "spl", "stl", "safe_efficiency",
            "final_distance_to_goal", "min_distance_to_goal", "path_efficiency"]  # fmt: skip
    scores = crowdbot.score(run, metrics=task)
    assert {(s.status, s.reason) for s in scores} == {("undefined", "invalid_no_goal")}


@given(st.floats(-3.1, 3.1), st.integers(2, 30))
def test_a_body_looks_where_it_moves(angle: float, n: int) -> None:
    t = np.arange(n, dtype=float)
    theta = heading_of_motion(t, np.cos(angle) * t, np.sin(angle) * t)
    np.testing.assert_allclose(theta, angle, atol=1e-9)


def test_a_body_that_stands_looks_where_it_moved() -> None:
    t = np.arange(8.0)
    x = np.array([0.0, 0, 0, 1, 2, 2, 2, 2])
    y = np.array([0.0, 0, 0, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(heading_of_motion(t, x, y), np.zeros(8))
    np.testing.assert_array_equal(heading_of_motion(t, y, -x)[5:], -0.5 * np.pi * np.ones(3))
    np.testing.assert_array_equal(heading_of_motion(t, y, y), np.zeros(8))
    np.testing.assert_array_equal(heading_of_motion(t[:1], y[:1], y[:1]), [0.0])


@given(st.lists(st.floats(0.1, 2.0), min_size=1, max_size=8), st.floats(-5, 5), st.floats(-5, 5))
def test_straight_lines_stay_straight(steps: list[float], a: float, b: float) -> None:
    known = np.cumsum(steps)
    t = steady_times(float(known[0]), float(known[-1]), 7.0)
    np.testing.assert_allclose(interpolated(known, a + b * known, t), a + b * t, atol=1e-9)
    outside = interpolated(known, a + b * known, np.array([known[0] - 1.0, known[-1] + 1.0]))
    assert np.isnan(outside).all()


# ------------------------------------------------------------------ what cannot be
def _circle(scale: float = 1.0) -> dict[str, Any]:
    t = np.arange(0.0, 30.0, 0.1)
    return {"t": t, "x": scale * 3 * np.cos(t / 5), "y": scale * 3 * np.sin(t / 5)}


def _frames() -> dict[str, Any]:
    """The same circle, of a camera with 25 pictures a second."""
    k = np.arange(300)
    return {"t": k, "x": 3 * np.cos(k / 125), "y": 3 * np.sin(k / 125)}


def _winding() -> dict[str, Any]:
    """To the north-east in curves: exchanging x and y changes the direction little."""
    t = np.arange(300) * 0.1
    theta = 0.25 * np.pi + 0.42 * np.sin(t / 2)
    x, y = (np.cumsum(0.06 * part) for part in (np.cos(theta), np.sin(theta)))
    return {"t": t, "x": x, "y": y, "theta": theta}


def _people(x: Any, y: Any, t: Any) -> dict[str, Any]:
    return {"t": t, "id": np.zeros(len(t)), "x": x, "y": y}


def _wrong() -> dict[str, tuple[dict[str, Any], dict[str, Any] | None, str]]:
    good = _circle()
    t, x, y = good["t"], good["x"], good["y"]
    theta = t / 5 + 0.5 * np.pi
    winding = _winding()
    far = _people(0.5 * t, np.full(len(t), 50.0), t)
    return {
        "mm": (_circle(1000.0 * 3), None, "the robot: median speed 1.8e.03 m/s.*millimetres"),
        "cm": (_circle(100.0), None, "median speed 60 m/s: positions in centimetres"),
        "people mm": (good, _people(1000 * x, 1000 * y, t), "people: median speed 600 m/s.*milli"),
        "ms": ({**good, "t": 1000 * t}, None, "median time between samples 100 s: milliseconds"),
        "ns": ({**good, "t": 1e9 * t}, None, "nanoseconds"),
        "frames": (_frames(), None, "whole numbers.*frame_rate=25 reads these, with .* 0.6 m/s"),
        "degrees": ({**good, "theta": np.degrees(theta)}, None, "taken as degrees, in 100 %"),
        "y first": ({**good, "theta": 0.5 * np.pi - theta}, None, "x and y exchanged, in 100 %"),
        "winding": (
            {**winding, "x": winding["y"], "y": winding["x"]},
            None,
            "in 6. % of the samples; with x and y exchanged, in 100 %",
        ),
        "north": ({**good, "theta": theta - 0.5 * np.pi}, None, "turned by (-)?90 degrees"),
        "own frame": (
            {**good, "theta": theta, "vx": np.full(len(t), 0.6), "vy": 0 * t},
            None,
            "in the robot's own frame",
        ),
        "far": (good, far, "never nearer to the robot than 4"),
        "exchanged": (
            {**good, "x": x + 40, "y": y},
            _people(y, x + 40, t),
            "with x and y of people exchanged",
        ),
    }


@pytest.mark.parametrize("name", _wrong())
def test_what_cannot_be_is_warned_of_with_the_evidence(name: str) -> None:
    robot, agents, message = _wrong()[name]
    with pytest.warns(RecordingWarning, match=message):
        crowdbot.Trajectories.from_pandas(robot, agents, **BODY)


def test_times_may_be_numbers_of_frames(tmp_path: Path) -> None:
    robot = tmp_path / "robot.csv"
    robot.write_text("Bild;Pos X;Pos Y\n" + "".join(f"{k};{0.02 * k};0\n" for k in range(50)))
    people = tmp_path / "people.csv"
    people.write_text("Bild;Wer;Pos X;Pos Y\n" + "".join(f"{k};ada;9;1\n" for k in range(50)))
    names = {"t": "Bild", "x": "Pos X", "y": "Pos Y"}
    columns = {"robot": names, "agents": {**names, "id": "Wer"}}
    run = crowdbot.Trajectories.from_csv(robot, people, columns=columns, frame_rate=25, **BODY)
    np.testing.assert_allclose(run.t, np.arange(50) / 25)
    assert run.robot is not None
    np.testing.assert_allclose(np.diff(run.robot.x) / np.diff(run.t), 0.5)
    with pytest.raises(InputError, match="frame_rate is a number of frames per second, not 0"):
        crowdbot.Trajectories.from_csv(robot, columns={"robot": names}, frame_rate=0, **BODY)


@pytest.mark.parametrize("kind", ["text", "numpy", "pandas"])
def test_stamps_keep_their_nanoseconds(kind: str) -> None:
    """As seconds since 1970 they would be 119 ns off; the robot would jerk."""
    ns = 1_777_629_600_123_456_789 + np.arange(5) * 33_333_333
    stamps: Any = ns.astype("datetime64[ns]")
    if kind == "text":
        stamps = [f"{stamp}Z" for stamp in stamps]
    elif kind == "pandas":
        pandas = pytest.importorskip("pandas")
        stamps = [pandas.Timestamp(stamp, tz="Europe/Vienna") for stamp in stamps]
    robot = {"t": stamps, "x": np.arange(5.0), "y": np.zeros(5)}
    trips = {"agent": [1], "t0": stamps[:1], "t1": stamps[-1:], "reached": [1]}
    people = {"t": stamps, "id": [1] * 5, "x": np.arange(5.0), "y": np.ones(5)}
    run = crowdbot.Trajectories.from_pandas(robot, people, trips, **BODY)
    assert run.t.tolist() == [0.0, 0.033333333, 0.066666666, 0.099999999, 0.133333332]
    assert run.trips is not None
    assert run.trips.t1.tolist() == [0.133333332]


def test_trips_have_the_clock_of_the_run() -> None:
    stamps = np.array([0, 10**9], "datetime64[ns]")
    robot = {"t": stamps, "x": [0.0, 1.0], "y": [0.0, 0.0]}
    trips = {"agent": [1], "t0": [0.0], "t1": [1.0], "reached": [1]}
    people = {"t": stamps, "id": [1, 1], "x": [0.0, 1.0], "y": [1.0, 1.0]}
    with pytest.raises(InputError, match="one table has stamps, the other seconds"):
        crowdbot.Trajectories.from_pandas(robot, people, trips, **BODY)


def test_a_missing_stamp_is_told() -> None:
    robot = {"t": np.array([0, "NaT"], "datetime64[ns]"), "x": [0.0, 1.0], "y": [0.0, 0.0]}
    with pytest.raises(InputError, match="a row has no t"):
        crowdbot.Trajectories.from_pandas(robot, **BODY)


def test_stamps_are_no_frames(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("t,x,y\n2026-05-01T10:00:00Z,0,0\n2026-05-01T10:00:01Z,1,0\n")
    with pytest.raises(InputError, match=r"r\.csv:2: t holds stamps; frame_rate is for frames"):
        crowdbot.Trajectories.from_csv(path, frame_rate=25, **BODY)


def test_what_is_missing_is_said_with_the_nearest_right_thing(tmp_path: Path) -> None:
    (tmp_path / "robot.csv").write_text("t,x,y\n0,0,0\n1,1,0\n")
    with pytest.raises(InputError, match=r"did you mean '.*robot\.csv'"):
        crowdbot.Trajectories.from_csv(tmp_path / "robt.csv", **BODY)
    with pytest.raises(InputError, match="a robot needs robot_radius"):
        crowdbot.Trajectories.from_csv(tmp_path / "robot.csv", robot_mass=3.0)


def test_a_plausible_recording_is_quiet() -> None:
    good = _circle()
    t, x, y = good["t"], good["x"], good["y"]
    theta = t / 5 + 0.5 * np.pi
    people = _people(x + 1, y, t)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for more in ({}, {"theta": theta}, {"theta": theta + np.pi}, {"theta": theta + 40 * np.pi}):
            run = crowdbot.Trajectories.from_pandas({**good, **more}, people, **BODY)
            assert run.implausible() == []


# --------------------------------------------------------------- frames, bags, data sets
def test_data_frames(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = straight(tmp_path / "r.csv")
    run = crowdbot.Trajectories.from_csv(path, **BODY)
    frame = pandas.read_csv(path)
    again = crowdbot.Trajectories.from_pandas(frame, **BODY)
    assert run.robot is not None
    assert again.robot is not None
    np.testing.assert_array_equal(run.robot.x, again.robot.x)
    frame["t"] = pandas.Timestamp("2026-05-01T10:00:00Z") + pandas.to_timedelta(frame["t"], "s")
    stamped = crowdbot.Trajectories.from_pandas(frame, **BODY)
    np.testing.assert_allclose(stamped.t, T)
    named = frame.rename(columns={"x": "east"})
    with pytest.raises(InputError, match="frame 'robot':1: the column x is missing"):
        crowdbot.Trajectories.from_pandas(named, **BODY)
    renamed = crowdbot.Trajectories.from_pandas(named, columns={"robot": {"x": "east"}}, **BODY)
    assert renamed.robot is not None
    with pytest.raises(InputError, match="a data frame is wanted, not an int"):
        crowdbot.Trajectories.from_pandas(3, **BODY)


def _bag(folder: Path) -> Path:
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = store.types
    point, quaternion = kinds["geometry_msgs/msg/Point"], kinds["geometry_msgs/msg/Quaternion"]

    def header(t: float) -> Any:
        stamp = kinds["builtin_interfaces/msg/Time"](sec=int(t), nanosec=round(t % 1 * 1e9))
        return kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="map")

    def pose(x: float, y: float) -> Any:
        turn = quaternion(x=0.0, y=0.0, z=math.sin(0.25), w=math.cos(0.25))
        return kinds["geometry_msgs/msg/Pose"](position=point(x=x, y=y, z=0.0), orientation=turn)

    with Writer(folder, version=8) as writer:
        robot = writer.add_connection("/pose", "geometry_msgs/msg/PoseStamped", typestore=store)
        crowd = writer.add_connection("/crowd", "geometry_msgs/msg/PoseArray", typestore=store)
        for k in range(20):
            t = 1000.0 + 0.1 * k
            message = kinds["geometry_msgs/msg/PoseStamped"](header(t), pose(0.05 * k, 0.02 * k))
            writer.write(robot, round(t * 1e9), store.serialize_cdr(message, message.__msgtype__))
            t += 0.03
            people = [pose(1.0 + 0.1 * k, 1.0), pose(2.0, 2.0)]
            array = kinds["geometry_msgs/msg/PoseArray"](header(t), people)
            writer.write(crowd, round(t * 1e9), store.serialize_cdr(array, array.__msgtype__))
    return folder


def test_topics_of_a_bag(tmp_path: Path) -> None:
    bag = _bag(tmp_path / "bag")
    run = crowdbot.Trajectories.from_rosbag(bag, robot="/pose", people="/crowd", **BODY)
    assert run.robot is not None
    assert run.agents is not None
    np.testing.assert_allclose(run.t, 0.1 * np.arange(20), atol=1e-6)
    np.testing.assert_allclose(run.robot.theta, 0.5)
    assert run.agents.id.tolist() == [0, 1]
    assert np.isnan(run.agents.x[0]).all()
    np.testing.assert_allclose(run.agents.x[1:, 0], 0.97 + 0.1 * np.arange(1, 20) + 0.0, atol=1e-6)
    lone = crowdbot.Trajectories.from_rosbag(bag, people="/crowd")
    assert lone.robot is None
    assert len(lone.t) == 20
    with pytest.raises(UnknownNameError, match="unknown topic '/poses'; did you mean '/pose'"):
        crowdbot.Trajectories.from_rosbag(bag, robot="/poses", **BODY)
    with pytest.raises(InputError, match="which topics"):
        crowdbot.Trajectories.from_rosbag(bag)
    with pytest.raises(InputError, match="has no list of people"):
        crowdbot.Trajectories.from_rosbag(bag, people="/pose")
    with pytest.raises(InputError, match="has no pose"):
        crowdbot.Trajectories.from_rosbag(bag, robot="/crowd", **BODY)
    with pytest.raises(InputError, match="no such file"):
        crowdbot.Trajectories.from_rosbag(tmp_path / "no", robot="/pose", **BODY)
    (tmp_path / "text.bag").write_text("no bag")
    with pytest.raises(InputError, match="not a bag"):
        crowdbot.Trajectories.from_rosbag(tmp_path / "text.bag", robot="/pose", **BODY)


def test_trajnet(tmp_path: Path) -> None:
    path = tmp_path / "a.ndjson"
    lines: list[dict[str, Any]] = [
        {"scene": {"id": 4, "p": 1, "s": 10, "e": 30, "fps": 2.5, "tag": 0}}
    ]
    for f in (0, 10, 20, 30):
        lines += [{"track": {"f": f, "p": p, "x": 0.04 * f, "y": float(p)}} for p in (1, 2)]
    lines.append({"track": {"f": 30, "p": 1, "x": 0, "y": 0, "prediction_number": 0}})
    path.write_text("\n".join(map(json.dumps, lines)))
    run = crowdbot.Trajectories.from_trajnet(path)
    assert run.agents is not None
    np.testing.assert_allclose(run.t, [0.0, 0.4, 0.8, 1.2])
    assert run.agents.y[0].tolist() == [1.0, 2.0]
    driven = crowdbot.Trajectories.from_trajnet(path, scene=4, robot=1)
    assert driven.robot is not None
    assert driven.agents is not None
    assert (len(driven.t), driven.agents.id.tolist()) == (3, [2])
    with pytest.raises(UnknownNameError, match="unknown scene '5'"):
        crowdbot.Trajectories.from_trajnet(path, scene=5)
    with pytest.raises(UnknownNameError, match="unknown person '7'"):
        crowdbot.Trajectories.from_trajnet(path, robot=7)
    path.write_text('{"track": {"f": 1}}\n')
    with pytest.raises(InputError, match=r"a\.ndjson:1: not a scene or track"):
        crowdbot.Trajectories.from_trajnet(path)


def test_eth_and_ucy(tmp_path: Path) -> None:
    path = tmp_path / "obsmat.txt"
    rows = [f"{780 + 6 * k} 1 {0.4 * k} 0 5 1.0 0 0.0" for k in range(4)]
    rows += [f"{780 + 6 * k} 2 {3 - 0.4 * k} 0 6 -1.0 0 0.0" for k in range(4)]
    path.write_text("\n".join(rows))
    run = crowdbot.Trajectories.from_eth_ucy(path, robot=1)
    assert run.robot is not None
    assert run.agents is not None
    np.testing.assert_allclose(run.t, [0.0, 0.4, 0.8, 1.2])
    np.testing.assert_allclose(run.robot.y, 5.0)
    assert run.agents.vx[0, 0] == -1.0
    path.write_text("10\t1\t0.0\t1.0\n20\t1\t0.4\t1.0\n")
    plain = crowdbot.Trajectories.from_eth_ucy(path)
    np.testing.assert_allclose(plain.t, [0.0, 0.4])
    np.testing.assert_allclose(crowdbot.Trajectories.from_eth_ucy(path, frame_rate=5).t, [0, 2])
    path.write_text("10 1 0.0\n")
    with pytest.raises(InputError, match=r"obsmat\.txt:1: 3 columns"):
        crowdbot.Trajectories.from_eth_ucy(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("a,b\n1,2\n", "the columns t, x, y are missing; the table has a, b; columns={'robot'"),
        ("t,x\n1,2\n", "the column y is missing; the table has t, x; columns="),
        ("t,x,y\n0,0,0\n0,1,0\n", r":3: t does not increase"),
        ("t,x,y\n0,0\n", r":2: the row is too short: 2 cells of 3"),
        ("t,x,y\n0,east,0\n", r":2: x: could not convert"),
        ("t,x,y\n,0,0\n", r":2: a row has no t"),
        ("t,x,y\n", "the table has no rows"),
        ('t,x,y\n"0,0,0\n', "not a table"),
    ],
)
def test_tables_that_are_wrong(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        crowdbot.Trajectories.from_csv(path, **BODY)


@given(st.text(max_size=80))
def test_any_text_is_a_table_or_our_error(text: str) -> None:
    path = _scratch(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            crowdbot.Trajectories.from_csv(path, **BODY)
        except InputError:
            return


_SCRATCH: list[Path] = []


@pytest.fixture(autouse=True, scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    _SCRATCH.append(tmp_path_factory.mktemp("tables"))


def _scratch(text: str) -> Path:
    path = _SCRATCH[-1] / "any.csv"
    path.write_text(text, encoding="utf-8", errors="ignore")
    return path
