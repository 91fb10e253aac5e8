"""Exports: others read them, and what they say is what was recorded."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from ruamel.yaml import YAML

from crowdbot import cli
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.export.stamps import moved
from crowdbot.core.recording.export.tables import geojson, tables, trajnet
from crowdbot.core.recording.recording import Recording
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.core.recording.recording_cases import WALLS, bits, random_run, write_run

RUN = random_run()


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "run.mcap"
    write_run(path, RUN)
    return path


def _export(path: Path, to: str, *more: str) -> Path:
    out = path.parent / f"out{'.bag' if to == 'rosbag1' else ''}"
    assert cli.main(["export", str(path), "--to", to, "--out", str(out), *more]) == 0
    return out


def _read(path: Path) -> dict[str, list[tuple[int, Any]]]:
    found: dict[str, list[tuple[int, Any]]] = {}
    with AnyReader([path]) as reader:
        for connection, ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append((ns, message))
    return found


def _raw(path: Path) -> dict[str, list[tuple[int, bytes]]]:
    found: dict[str, list[tuple[int, bytes]]] = {}
    with AnyReader([path]) as reader:
        for connection, ns, data in reader.messages():
            found.setdefault(connection.topic, []).append((ns, data))
    return found


def test_a_bag_of_ros_2_is_a_folder_of_version_8(recording: Path) -> None:
    out = _export(recording, "rosbag2")
    about = YAML(typ="safe").load(out / "metadata.yaml")["rosbag2_bagfile_information"]
    assert about["version"] == 8
    assert about["storage_identifier"] == "mcap"
    assert [out / name for name in about["relative_file_paths"]] == [out / "out.mcap"]
    assert (out / "out.mcap").is_file()


def test_a_bag_has_all_that_was_recorded_and_what_users_of_ros_expect(recording: Path) -> None:
    found = _read(_export(recording, "rosbag2"))
    assert len(found["/scan"]) == len(RUN.t)
    assert "/front/scan" not in found
    assert {"/map", "/goal_pose", "/robot/path", "/people_markers", "/contact_markers"} <= set(
        found
    )
    assert {"/odom", "/tf", "/tf_static", "/clock", "/cmd_vel", "/pedestrians"} <= set(found)
    ((_, goal),) = found["/goal_pose"]
    assert (goal.pose.position.x, goal.pose.position.y) == (46.5, 0.0)
    _, path = found["/robot/path"][-1]
    assert path.poses[0].pose.position.x == pytest.approx(RUN.robot[0, 0], abs=5e-4)  # type: ignore[index]


def test_people_have_heading_id_and_speed(recording: Path) -> None:
    found = _read(_export(recording, "rosbag2"))
    _, message = found["/people_markers"][0]
    first = message.markers[1]
    assert RUN.agents is not None
    vx, vy = RUN.agents[0, 2:, 0]
    assert first.id == 100
    assert first.scale.x == pytest.approx(np.hypot(vx, vy), abs=5e-4)
    turn = first.pose.orientation
    assert 2.0 * np.arctan2(turn.z, turn.w) == pytest.approx(np.arctan2(vy, vx), abs=1e-3)


def test_the_map_has_the_walls(recording: Path) -> None:
    ((_, grid),) = _read(_export(recording, "rosbag2"))["/map"]
    cells = grid.data.reshape(grid.info.height, grid.info.width)
    origin, cell = grid.info.origin.position, grid.info.resolution
    rows, columns = np.nonzero(cells == 100)
    x, y = origin.x + cell * (columns + 0.5), origin.y + cell * (rows + 0.5)
    assert np.all(np.minimum(np.abs(y - 5.0), np.abs(y + 5.0)) <= cell)
    for x0, y0, x1, _ in WALLS:
        near = np.abs(y - y0) <= cell
        assert set(np.floor((x[near] - x0) / cell).astype(int)) >= set(range(int((x1 - x0) / cell)))


@pytest.mark.parametrize("record", ["none", "used"])
def test_what_follows_from_samples_is_the_same_in_each_bag(
    recording: Path, tmp_path: Path, record: Any
) -> None:
    path = tmp_path / "less" / "run.mcap"
    path.parent.mkdir()
    write_run(path, RUN, record=record)
    whole, less = (_raw(_export(p, "rosbag2")) for p in (recording, path))
    for topic in (
        "/clock", "/tf", "/tf_static", "/robot/pose", "/pedestrians", "/pedestrians_marker",
        "/people_markers", "/walls_marker", "/goal_zone", "/goal_pose", "/map",
    ):  # fmt: skip
        assert less[topic] == whole[topic], topic
    assert len(less["/contact_markers"]) == len(whole["/contact_markers"])
    assert {"/scan": record == "used", "/cmd_vel": record == "used"} == {
        topic: topic in less for topic in ("/scan", "/cmd_vel")
    }


def test_odometry_that_was_not_recorded_makes_no_tree(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, RUN, record="none")
    assert cli.main(["export", str(path), "--to", "rosbag2", "--tf", "odometry"]) == 1
    error = capsys.readouterr().err
    assert "there is no /odom in it; --record none leaves odometry out" in error
    assert sorted(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("record", ["none", "used"])
def test_a_bag_has_map_and_goal_whatever_was_recorded(tmp_path: Path, record: Any) -> None:
    path = tmp_path / "run.mcap"
    write_run(path, RUN, record=record)
    found = _read(_export(path, "rosbag2", "--no-markers"))
    assert {"/map", "/goal_pose", "/robot/path"} <= set(found)
    assert len(found["/map"]) == 1


def test_own_names_and_no_markers(recording: Path) -> None:
    found = _read(_export(recording, "rosbag2", "--own-names", "--no-markers"))
    assert "/front/scan" in found
    assert not {"/scan", "/people_markers", "/contact_markers"} & set(found)


@pytest.mark.parametrize("to", ["rosbag1", "rosbag2"])
def test_stamps_may_begin_later(recording: Path, to: str) -> None:
    plain = {r.topic: r for r in reversed(list(Records(recording)))}
    found = _read(_export(recording, to, "--offset", "100"))
    for topic in ("/scan", "/odom", "/pedestrians", "/goal_zone"):
        ns, message = found[topic][0]
        assert ns >= 100 * 10**9
        assert message.header.stamp.sec >= 100
    assert found["/clock"][0][1].clock.sec == 100
    assert found["/tf"][0][1].transforms[0].header.stamp.sec == 100
    assert plain["/odom"].ns == 0


def test_the_tree_may_follow_odometry(recording: Path) -> None:
    found = _read(_export(recording, "rosbag2", "--tf", "odometry"))
    pairs = {(t.header.frame_id, t.child_frame_id) for _, m in found["/tf"] for t in m.transforms}
    assert pairs == {("odom", "base_footprint")}
    assert len(found["/tf"]) == len(found["/odom"])
    assert found["/tf"][3][1].transforms[0].transform.translation.x == pytest.approx(
        found["/odom"][3][1].pose.pose.position.x
    )


def test_a_bag_of_ros_1_has_the_same_messages(recording: Path) -> None:
    first = _read(_export(recording, "rosbag1"))
    (recording.parent / "out.bag").unlink()
    second = _read(_export(recording, "rosbag2"))
    assert {t: len(m) for t, m in first.items()} == {t: len(m) for t, m in second.items()}
    for (_, one), (_, two) in zip(first["/scan"], second["/scan"], strict=True):
        assert one.ranges.tobytes() == two.ranges.tobytes()


def test_csv_reads_back_bit_by_bit(recording: Path) -> None:
    out = _export(recording, "csv")
    run = Recording(recording).trajectories()
    back = Trajectories.from_csv(
        robot=out / "robot.csv", agents=out / "people.csv", trips=out / "trips.csv",
        contacts=out / "contacts.csv", robot_radius=0.2, robot_mass=6.3,
    )  # fmt: skip
    assert run.robot is not None
    assert back.robot is not None
    assert bits(back.robot.theta) == bits(run.robot.theta)
    assert run.agents is not None
    assert back.agents is not None
    for name in ("id", "x", "y", "vx", "vy", "radius", "mass", "jump"):
        there = np.isfinite(run.agents.x) if name in ("x", "y", "vx", "vy") else slice(None)
        assert bits(getattr(back.agents, name)[there]) == bits(getattr(run.agents, name)[there])
    assert bits(back.contacts) == bits(run.contacts)
    assert bits(back.trips) == bits(run.trips)


def test_parquet_has_the_same_tables(recording: Path) -> None:
    import pyarrow.parquet as pq  # type: ignore[import-untyped]

    out = _export(recording, "parquet")
    for name, table in tables(Recording(recording).trajectories()).items():
        found = pq.read_table(out / f"{name}.parquet").to_pydict()
        for column, values in table.items():
            assert np.array_equal(found[column], np.asarray(values).tolist(), equal_nan=True)


def test_geojson_cuts_ways_where_somebody_is_teleported(recording: Path) -> None:
    features = json.loads(geojson(Recording(recording).trajectories()))["features"]
    kinds = [f["properties"]["what"] for f in features]
    assert kinds.count("wall") == 2
    assert kinds.count("robot") == 1
    first = [f for f in features if f["properties"].get("id") == 100]
    assert len(first) == 2
    assert sum(len(f["geometry"]["coordinates"]) for f in first) == len(RUN.t)
    last = [f for f in features if f["properties"].get("id") == 118]
    assert len(last) == 2  # absent in between


def test_trajnet_has_frames_and_a_scene(recording: Path) -> None:
    lines = [
        json.loads(line)
        for line in trajnet([(Recording(recording).trajectories(), "x")]).splitlines()
    ]
    assert lines[0]["scene"] == {"id": 0, "p": 0, "s": 0, "e": 6, "fps": 2.5, "tag": "x"}
    robot = [line["track"] for line in lines[1:] if line["track"]["p"] == 0]
    assert [r["f"] for r in robot] == list(range(7))
    assert robot[2]["x"] == pytest.approx(1.0 + 0.5 * 0.8, abs=0.05)


def test_what_exists_is_not_written_over(
    recording: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = _export(recording, "csv")
    assert cli.main(["export", str(recording), "--to", "csv", "--out", str(out)]) == 1
    assert "exists already" in capsys.readouterr().err
    assert cli.main(["export", str(recording.parent / "none"), "--to", "csv"]) == 1
    assert sorted(p.name for p in recording.parent.iterdir()) == ["out", "run.mcap"]


def test_a_message_without_a_stamp_stays_as_it_is() -> None:
    assert moved(b"anything", "std_msgs/msg/String", 5) == b"anything"
    assert moved(b"anything", "none/msg/None", 5) == b"anything"


def test_any_format_may_have_any_name(recording: Path) -> None:
    for to in ("rosbag1", "rosbag2", "csv", "geojson", "trajnet"):
        out = recording.parent / f"v1.0 {to}"
        assert cli.main(["export", str(recording), "--to", to, "--out", str(out)]) == 0, to
        assert out.exists()
    head = (recording.parent / "v1.0 rosbag1").read_bytes()[:13]
    assert head == b"#ROSBAG V2.0\n"


@pytest.mark.parametrize("to", ["rosbag2", "rosbag1"])
@pytest.mark.filterwarnings("ignore::crowdbot.RecordingWarning")  # one person is teleported
def test_our_own_bags_are_read_back(recording: Path, to: str) -> None:
    assert RUN.robot is not None
    assert RUN.agents is not None
    bag = _export(recording, to)
    known = np.isfinite(RUN.agents[:, 0])
    for people in ("/pedestrians", "/people_markers", "/pedestrians_marker"):
        run = Trajectories.from_rosbag(
            bag, robot="/robot/pose", people=people, robot_radius=0.3, robot_mass=70.0
        )
        assert run.robot is not None
        assert run.agents is not None
        np.testing.assert_allclose(run.robot.x, RUN.robot[:, 0], atol=2e-3)
        if people == "/pedestrians_marker":  # names no one
            continue
        assert run.agents.id.tolist() == [100 + 3 * i for i in range(RUN.agents.shape[2])]
        there = np.isfinite(run.agents.x) & known
        assert np.mean(there == known) > 0.9  # markers are written at a lower rate
        there[:, 0] = False  # teleported
        np.testing.assert_allclose(run.agents.x[there], RUN.agents[:, 0][there], atol=2e-3)
