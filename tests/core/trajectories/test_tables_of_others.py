"""Tables as programs of others write them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import InputError, RecordingWarning

READ = crowdbot.Trajectories
BODY: dict[str, Any] = {"robot_radius": 0.2, "robot_mass": 20.0}
ROWS = [(i, f, 0.05 * f + i, 0.5 * i, 1.75) for i in range(1, 5) for f in range(30)]


def _written(path: Path, head: str, scale: float = 1.0, columns: int = 5) -> Path:
    lines = [
        " ".join(f"{v:.4f}" if k > 1 else str(v) for k, v in enumerate(row[:columns]))
        for row in ((i, f, x * scale, y * scale, z * scale) for i, f, x, y, z in ROWS)
    ]
    path.write_text(head + "\n".join(lines) + "\n")
    return path


def _check(run: crowdbot.Trajectories, rate: float = 25.0) -> None:
    assert run.agents is not None
    assert run.agents.id.tolist() == [1, 2, 3, 4]
    np.testing.assert_allclose(run.t, np.arange(30) / rate)
    np.testing.assert_allclose(run.agents.x[:, 1], 2.0 + 0.05 * np.arange(30), atol=1e-3)
    np.testing.assert_allclose(run.agents.y[:, 3], 2.0, atol=1e-3)


@pytest.mark.parametrize(
    ("head", "scale"),
    [
        ("# description: corridor\n# framerate: 25 fps\n# id frame x/m y/m z/m\n", 1.0),
        ("# framerate: 25.0\n# id frame x/cm y/cm z/cm\n", 100.0),
        ("#framerate: 25\n#ID\tFR\tX\tY\tZ\n", 1.0),
        ("# PeTrack\n# all lengths in cm\n# PersID Frame X Y Z\n# 25 fps\n", 100.0),
        ("# frame rate: 25,0\n", 1.0),
        ("# x and y in m\n# framerate=25\n#pers frame x y z\n", 1.0),
        ("% fps: 25\nid frame x[mm] y[mm] z[mm]\n", 1000.0),
    ],
)
def test_petrack_and_jupedsim(tmp_path: Path, head: str, scale: float) -> None:
    _check(READ.from_csv(agents=_written(tmp_path / "a.txt", head, scale)))


def test_petrack_as_a_data_set(tmp_path: Path) -> None:
    head = "# framerate: 25\n# id frame x/cm y/cm z/cm\n"
    _check(READ.from_eth_ucy(_written(tmp_path / "a.txt", head, 100.0)))
    with pytest.warns(RecordingWarning) as warned:
        _check(READ.from_eth_ucy(_written(tmp_path / "b.txt", "", columns=4)), 2.5)
    assert "the first column is read as the id" in str(warned[0].message)
    assert "walk at 0.12 m/s" in str(warned[1].message)
    with pytest.raises(InputError, match=r"5 columns; 4 .*or a comment that names others"):
        READ.from_eth_ucy(_written(tmp_path / "c.txt", ""))


def test_a_table_without_names_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no header row .*such as 't,id,x,y'"):
        READ.from_csv(agents=_written(tmp_path / "a.csv", ""))


def test_two_frame_rates_are_refused(tmp_path: Path) -> None:
    same = "# framerate: 25\n# 25.0 fps\n# id frame x/m y/m z/m\n"
    _check(READ.from_csv(agents=_written(tmp_path / "same.txt", same)))
    path = _written(tmp_path / "a.txt", same.replace("25.0 fps", "frame rate: 10"))
    with pytest.raises(InputError, match="state 10 and 25 frames per second"):
        READ.from_csv(agents=path)
    with pytest.raises(InputError, match="state 10 and 25 frames per second"):
        READ.from_eth_ucy(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("t,id,x,y\n0,1,0,0\n0.1,1,-inf,0\n", "x.csv:3: x is infinite; leave unknown cells empty"),
        ("t,id,x,y\n", "the table has no rows"),
        ('[\n {"t": 0, "id": 1, "x": 0, "y": 0}]', "is JSON, not a table of rows"),
        ('{"t": [0]}', "is JSON, not a table of rows"),
        ("<fcd-export/>", "is XML or HTML, not a table of rows"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "x.csv"
    path.write_text(content)
    with pytest.raises(InputError, match=message):
        READ.from_csv(agents=path)


def test_frames_need_a_rate(tmp_path: Path) -> None:
    path = _written(tmp_path / "a.csv", "id frame x y z\n")
    with pytest.raises(InputError, match=r"times are numbers of frames; .*frame_rate=25"):
        READ.from_csv(agents=path)
    _check(READ.from_csv(agents=path, frame_rate=25))


def test_trajectories_of_pedpy() -> None:
    table = np.array(ROWS)
    data = {"id": table[:, 0].astype(int), "frame": table[:, 1].astype(int)}
    data |= {"x": table[:, 2], "y": table[:, 3]}
    _check(READ.from_pandas(agents=SimpleNamespace(data=data, frame_rate=25.0)))
    _check(READ.from_pandas(agents=data, frame_rate=25.0))


@pytest.mark.parametrize("unit", ["s", "ms", "ns"])
def test_units_in_brackets(tmp_path: Path, unit: str) -> None:
    path, per = tmp_path / "a.csv", {"s": 1.0, "ms": 1e3, "ns": 1e9}[unit]
    head = f"time [{unit}],x [cm],y (cm),theta [deg]"
    rows = [f"{0.1 * k * per:.1f},{5.0 * k:.1f},{3.0 * k},{30.0:.1f}" for k in range(10)]
    path.write_text("\n".join([head, *rows]))
    run = READ.from_csv(path, **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.t, 0.1 * np.arange(10), atol=1e-9)
    np.testing.assert_allclose(run.robot.x, 0.05 * np.arange(10), atol=1e-9)
    np.testing.assert_allclose(run.robot.theta, math.radians(30.0))


@pytest.mark.parametrize(
    "head", ["t,x1,y1,x2,y2", "time;x_1;y_1;x_2;y_2", "t,ped1_x,ped1_y,p2_x,p2_y"]
)
def test_wide_tables(tmp_path: Path, head: str) -> None:
    path, mark = tmp_path / "a.csv", ";" if ";" in head else ","
    rows = [[0.1 * k, 0.1 * k, 1.0, 5.0, 0.2 * k] for k in range(10)]
    lines = [mark.join(f"{v:.2f}" for v in row) for row in rows]
    lines[0] = mark.join(["0.0", "0.0", "1.0", "", ""])  # the second comes later
    path.write_text("\n".join([head, *lines]))
    run = READ.from_csv(agents=path)
    assert run.agents is not None
    assert run.agents.id.tolist() == [1, 2]
    np.testing.assert_allclose(run.agents.x[:, 0], 0.1 * np.arange(10), atol=1e-6)
    assert np.isnan(run.agents.x[0, 1])
    np.testing.assert_allclose(run.agents.y[1:, 1], 0.2 * np.arange(1, 10), atol=1e-6)


@pytest.mark.parametrize("unit", [1, 10**3, 10**6], ids=["ns", "us", "ms"])
def test_stamps_since_1970(tmp_path: Path, unit: int) -> None:
    path = tmp_path / "r.csv"
    stamps = [(1_760_000_000_000_000_000 + k * 10**8) // unit for k in range(20)]
    path.write_text(
        "# robot 7, lab\nt,x,y\n" + "".join(f"{s},{i * 0.05},0\n" for i, s in enumerate(stamps))
    )
    run = READ.from_csv(path, **BODY)
    np.testing.assert_allclose(run.t, 0.1 * np.arange(20))


@pytest.mark.parametrize("degrees", [3.0, 45.0, 90.0, 137.0, 180.0])
def test_headings_in_degrees_are_noticed(degrees: float) -> None:
    t, yaw = 0.1 * np.arange(30), math.radians(degrees)
    robot = {"t": t, "x": 0.5 * t * math.cos(yaw), "y": 0.5 * t * math.sin(yaw)}
    with pytest.warns(RecordingWarning, match="degrees"):
        READ.from_pandas({**robot, "theta": np.full(30, degrees)}, **BODY)
    right = READ.from_pandas({**robot, "theta": np.full(30, yaw + 0.15)}, **BODY)
    assert right.implausible() == []


def _people(path: Path, text: str | bytes) -> crowdbot.Trajectories:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return READ.from_csv(agents=path, agent_radius=0.2)


def test_viswalk(tmp_path: Path) -> None:
    head = "$VISION\n* File: corridor.inpx\n$PEDESTRIAN:NO;COORDCENTX;SIMSEC;COORDCENTY\n"
    rows = (f"{i};{x:.4f};{f / 25};{y:.4f}\n" for i, f, x, y, _ in ROWS)
    _check(_people(tmp_path / "a.pp", head + "".join(rows)))


def test_footsteps_of_vadere(tmp_path: Path) -> None:
    head = "pedestrianId simTime endTime-PID1 startX-PID1 startY-PID1 endX-PID1 endY-PID1\n"
    rows = (f"{i} {f / 25} {f / 25 + 0.4} {x:.4f} {y:.4f} 0 0\n" for i, f, x, y, _ in ROWS)
    with pytest.warns(RecordingWarning, match="columns endTime-PID1, endX-PID1, endY-PID1 are not"):
        _check(_people(tmp_path / "postvis.traj", head + "".join(rows)))


@pytest.mark.parametrize("word", ["NULL", "N/A", "None", "nan", "-", ""])
def test_words_for_unknown_values(tmp_path: Path, word: str) -> None:
    first, second = "0,1,0,0\n0.1,1,{0},{0}\n0.2,1,0.2,0\n", "0,2,1,1\n0.1,2,1.1,1\n0.2,2,1.2,1\n"
    run = _people(tmp_path / "a.csv", "t,id,x,y\n" + first.format(word) + second)
    assert run.agents is not None
    assert np.isnan(run.agents.x[:, 0]).tolist() == [False, True, False]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("t,id,x,y\n0,1,2,3\n".encode("utf-16"), "it is UTF-16, save it as UTF-8"),
        ("# Füße\nt,id,x,y\n0,1,2,3\n".encode("latin-1"), "save it as UTF-8 if it is text"),
        (b"\x1f\x8b\x08\x00" + bytes(range(128, 200)), "unpack it with 'gunzip'"),
        (b"PK\x03\x04\x14\x00\x06\x00", "it is a spreadsheet or a zip archive"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:a\n", "'git lfs pull' fetches"),
        (b"\n<!DOCTYPE html>\n<html></html>\n", "a web page, perhaps the message of a failed"),
    ],
)
def test_files_that_are_no_text_of_a_table(tmp_path: Path, content: bytes, expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        _people(tmp_path / "a.csv", content)


# ---------------------------------------------------------------- columns that say too little
@pytest.mark.parametrize(
    ("head", "expected"),
    [
        ("t,x1,y1,x2", "column 'x2' has none for y beside it"),
        ("t,x1,y1,ped2.y", "column 'ped2.y' has none for x beside it"),
        ("t,x1,y1,x1", "two columns are called 'x1'"),
        ("t,id,x,y,x", "two columns are called 'x'"),
    ],
)
def test_columns_that_are_half_or_twice_there(tmp_path: Path, head: str, expected: str) -> None:
    rows = "\n".join(",".join([f"{k}", *"1234"[: head.count(",")]]) for k in range(3))
    file = tmp_path / "people.csv"
    file.write_text(f"{head}\n{rows}\n", encoding="utf-8")
    with pytest.raises(InputError, match=f"people.csv:1: {expected}"):
        crowdbot.Trajectories.from_csv(agents=file)


def test_zeros_for_people_who_are_not_there_are_told(tmp_path: Path) -> None:
    rows = [f"{k / 10},{k / 10},0,{0 if k < 15 else 5 - k / 10},0" for k in range(40)]
    file = tmp_path / "people.csv"
    file.write_text("t,x1,y1,x2,y2\n" + "\n".join(rows), encoding="utf-8")
    with pytest.warns(RecordingWarning, match=r"in 15 samples 1 of them \(2\) stand at exactly"):
        crowdbot.Trajectories.from_csv(agents=file)


# ------------------------------------------------------------------ order and use of columns
def _in_order(path: Path, order: str, head: str) -> Path:
    rows = (dict(zip(("id", "frame", "x", "y", "z"), row, strict=True)) for row in ROWS)
    path.write_text(
        head + "".join(" ".join(str(row[n]) for n in order.split()) + "\n" for row in rows)
    )
    return path


@pytest.mark.parametrize(
    "order", ["id x y z frame", "frame id y x", "y x frame id", "z y x frame id", "frame x y id"]
)
def test_columns_are_read_by_their_names(tmp_path: Path, order: str) -> None:
    path = _in_order(tmp_path / "a.txt", order, f"# framerate: 25\n# {order}\n")
    _check(READ.from_csv(agents=path))
    _check(READ.from_eth_ucy(path))


def test_columns_with_wrong_or_no_names_are_refused(tmp_path: Path) -> None:
    lies = _in_order(tmp_path / "a.txt", "frame id x y", "# framerate: 25\n# id frame x y\n")
    with pytest.raises(InputError, match=r"28 m/s .* by 0.05 m .* ids and frames are exchanged"):
        READ.from_csv(agents=lies)
    with pytest.raises(InputError, match="ids and frames are exchanged"):
        READ.from_eth_ucy(lies)
    bare = _in_order(tmp_path / "b.txt", "id x y z frame", "# framerate: 25\n")
    message = r"b.txt:3: .* 1.05 cannot be the number of a frame"
    with pytest.raises(InputError, match=message):
        READ.from_csv(agents=bare)
    with pytest.raises(InputError, match=message):
        READ.from_eth_ucy(bare)
    swapped = _in_order(tmp_path / "c.txt", "frame id x y z", "# framerate: 25\n")
    with pytest.warns(RecordingWarning, match="the first column is read as the frame"):
        _check(READ.from_eth_ucy(swapped))


def _robot(path: Path, head: str, *columns: Any) -> crowdbot.Trajectories:
    rows = (",".join(str(c(k) if callable(c) else c) for c in columns) for k in range(30))
    path.write_text("\n".join([head, *rows]) + "\n")
    return READ.from_csv(path, **BODY)


@pytest.mark.parametrize(
    ("head", "heading"),
    [("yaw", 0.3), ("heading", 0.3), ("heading_deg", math.degrees(0.3)), ("YAW[deg]", 17.188734)],
)
def test_other_names_of_the_heading(tmp_path: Path, head: str, heading: float) -> None:
    run = _robot(
        tmp_path / "r.csv", f"t,x,y,{head}", lambda k: k / 10,
        lambda k: 0.05 * k * math.cos(0.2), lambda k: 0.05 * k * math.sin(0.2), heading,
    )  # fmt: skip
    assert run.robot is not None
    np.testing.assert_allclose(run.robot.theta, 0.3, atol=1e-6)
    frame = {"t": run.t, "x": run.robot.x, "y": run.robot.y, head: np.full(30, heading)}
    same = READ.from_pandas(frame, **BODY).robot
    assert same is not None
    np.testing.assert_allclose(same.theta, 0.3, atol=1e-6)


def test_columns_that_are_not_used_are_told(tmp_path: Path) -> None:
    with pytest.warns(RecordingWarning, match=r"r.csv: the columns speed, battery are not used"):
        _robot(tmp_path / "r.csv", "t,x,y,z,speed,battery", lambda k: k, lambda k: 0.5 * k, *"0015")
    head = "# framerate: 25 fps\n# id frame x/m y/m angle/deg\n"
    with pytest.warns(RecordingWarning, match="the column angle/deg is not used"):
        _check(READ.from_csv(agents=_written(tmp_path / "a.txt", head)))
    with pytest.warns(RecordingWarning, match="the column angle/deg is not used"):
        _check(READ.from_eth_ucy(tmp_path / "a.txt"))
    people = {"t": [0.0, 0.1], "id": [1, 1], "x": [0.0, 0.1], "y": [0.0, 0.0]}
    with pytest.warns(RecordingWarning, match="frame 'agents': the column yaw_deg is not used"):
        READ.from_pandas(agents={**people, "yaw_deg": [90, 90]})
    with pytest.raises(InputError, match="the column vy is missing"):
        READ.from_pandas(agents={**people, "vx": [1.0, 1.0]})
    wide = {"t": [0.0, 0.1], "pos_x": [0.0, 0.1], "pos_y": [0, 0], "vel_x": [1, 1], "vel_y": [0, 0]}
    with pytest.raises(InputError, match="the column id is missing"):
        READ.from_pandas(agents=wide)


# -------------------------------------------------------------------------- units of times
@pytest.mark.parametrize("first", [0, 7, 5_000])
@pytest.mark.parametrize(
    ("unit", "per"), [("milliseconds", 1e3), ("microseconds", 1e6), ("nanoseconds", 1e9)]
)
@pytest.mark.parametrize("rate", [1, 10, 25, 100])
def test_units_of_times_from_a_small_first_one(
    tmp_path: Path, unit: str, per: float, rate: int, first: int
) -> None:
    def of(name: str) -> crowdbot.Trajectories:
        return _robot(
            tmp_path / "r.csv", f"{name},x,y", lambda k: first + round(k * per / rate),
            lambda k: 0.7 * k / rate, 0,
        )  # fmt: skip

    with pytest.warns(RecordingWarning, match=rf"{unit}\? .*frame_rate={per:.0f} reads these"):
        of("t")
    counted = READ.from_csv(tmp_path / "r.csv", frame_rate=per, **BODY)
    np.testing.assert_allclose(counted.t - counted.t[0], np.arange(30) / rate)
    short = {1e3: "ms", 1e6: "us", 1e9: "ns"}[per]
    run = of(f"t_{short}")
    np.testing.assert_allclose(run.t - run.t[0], np.arange(30) / rate)


def test_stamps_that_are_not_filled_in_are_refused(tmp_path: Path) -> None:
    for lost in (0, 9, 29):
        with pytest.raises(InputError, match=rf"r.csv:{lost + 2}: t: 0 is not a time since 1970"):
            _robot(
                tmp_path / "r.csv", "t,x,y",
                lambda k, lost=lost: 0 if k == lost else 1_760_000_000 * 10**9 + k * 10**8,
                lambda k: 0.1 * k, 0,
            )  # fmt: skip


# ----------------------------------------------------------------------------------- jumps
def test_jumps_are_told_and_what_metrics_do(tmp_path: Path) -> None:
    def at(rate: float, jump: float) -> crowdbot.Trajectories:
        return _robot(
            tmp_path / "r.csv", "t,x,y", lambda k: k / rate,
            lambda k: 0.5 * k / rate + (jump if k > 12 else 0.0), 0,
        )  # fmt: skip

    teleport = r"1 jump, of 4.05 m at t = 1.3 s: .*faster than 10 m/s .* leave them out"
    with pytest.warns(RecordingWarning, match=teleport):
        run = at(10.0, 4.0)
    assert _top_speed(run) == pytest.approx(0.5)
    with pytest.warns(RecordingWarning, match=r"1 jump, of 4.5 m at t = 13 s: .*as motion"):
        run = at(1.0, 4.0)
    assert _top_speed(run) > 2.0
    assert at(10.0, 0.0).implausible() == at(10.0, 0.2).implausible() == []


def _top_speed(run: crowdbot.Trajectories) -> float:
    scores = {s.variant: s.value for s in crowdbot.score(run, metrics=["speed"])}
    assert scores["max"] is not None
    return float(scores["max"])


def test_an_id_that_is_used_again_is_told() -> None:
    t = np.tile(0.1 * np.arange(40), 2)
    x = np.where(t > 2.0, t + 6.0, t) + np.repeat([0.0, 0.5], 40) * (t > 2.0)
    people = {"t": t, "id": np.repeat([1, 2], 40), "x": x, "y": np.repeat([0.0, 1.0], 40)}
    with pytest.warns(RecordingWarning, match=r"people: 2 jumps, the longest of 6.6 m at t = 2.1"):
        READ.from_pandas(agents=people)
    jump = np.isclose(t, 2.1).astype(float)
    assert READ.from_pandas(agents={**people, "jump": jump}).implausible() == []


@pytest.mark.parametrize(
    "head",
    [
        "# timestamp tx ty tz qx qy qz qw\n",
        "# timestamp x y z qx qy qz qw\n",
        "",  # as evo writes it
        "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_x [],q_RS_y [],q_RS_z [],"
        "q_RS_w []\n",
    ],
)
def test_poses_of_benchmarks_whose_comment_names_the_columns(tmp_path: Path, head: str) -> None:
    z, w = math.sin(0.25), math.cos(0.25)
    rows = [[1.3e9 + 0.1 * k, 0.3 * k, 0.1 * k, 0, 0, 0, z, w] for k in range(9)]
    mark = "," if "," in head else " "
    if mark == ",":
        rows = [[round(row[0] * 1e9), *row[1:]] for row in rows]
    lines = (mark.join(map(str, row)) + "\n" for row in rows)
    (tmp_path / "groundtruth.txt").write_text("# ground truth\n" + head + "".join(lines))
    run = READ.from_csv(tmp_path / "groundtruth.txt", **BODY)
    assert run.robot is not None
    np.testing.assert_allclose(run.t - run.t[0], 0.1 * np.arange(9), atol=1e-6)
    np.testing.assert_allclose(run.robot.x, 0.3 * np.arange(9))
    np.testing.assert_allclose(run.robot.y, 0.1 * np.arange(9))
    np.testing.assert_allclose(run.robot.theta, 0.5)


@pytest.mark.parametrize(
    ("kinds", "others"), [(("ped", "veh"), "ped, veh"), (("Pedestrian",) * 2, "")]
)
def test_what_moves_besides_people_is_told(
    tmp_path: Path, kinds: tuple[str, str], others: str
) -> None:
    rows = (f"{0.4 * f},{i},{i},{0.4 * f},{kinds[i]}\n" for f in range(5) for i in (0, 1))
    (tmp_path / "a.csv").write_text("t,id,x,y,type\n" + "".join(rows))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        READ.from_csv(agents=tmp_path / "a.csv")
    texts = [str(warning.message) for warning in caught]
    assert len(texts) == bool(others)
    assert all(f"type says {others}: all rows are read as people" in text for text in texts)


def test_a_row_for_each_value_is_told(tmp_path: Path) -> None:
    head = "elapsed time,receive time,header.stamp,topic,value\n"
    (tmp_path / "plot.csv").write_text(head + "0,1.7e9,1.7e9,/odom.pose.pose.position.x,1\n")
    with pytest.raises(InputError, match=r"plot\.csv:1: .* one column for each topic"):
        READ.from_csv(tmp_path / "plot.csv", **BODY)


def test_matrices_of_kitti_are_refused_with_the_columns_to_take(tmp_path: Path) -> None:
    (tmp_path / "00.txt").write_text("1 0 0 0.1 0 1 0 0.2 0 0 1 0.3\n")
    with pytest.raises(InputError, match=r"00\.txt:1: .* KITTI.* column 12 and minus column 4"):
        READ.from_csv(tmp_path / "00.txt", **BODY)
    (tmp_path / "heads.csv").write_text("0,1,1,1,100,200,110,210,95,200,115,260\n")
    with pytest.raises(InputError, match=r"heads\.csv:1: the table has no header row"):
        READ.from_csv(agents=tmp_path / "heads.csv")


@pytest.mark.parametrize("head", ["NO_OF_FRAMES\t200", "Format Version,1.23,Take Name,A"])
def test_exports_of_markers_are_named(tmp_path: Path, head: str) -> None:
    (tmp_path / "a.csv").write_text(f"{head}\n1,2,3\n")
    with pytest.raises(InputError, match=r"export of markers, not a table .* with t,id,x,y"):
        READ.from_csv(agents=tmp_path / "a.csv")


def test_a_spreadsheet_says_what_is_between_cells(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("sep=;\nt;id;x;y\n0;1;2,5;3\n1;1;3,5;3\n")
    agents = READ.from_csv(agents=tmp_path / "a.csv").agents
    assert agents is not None
    assert agents.x[:, 0].tolist() == [2.5, 3.5]


def test_frames_of_a_video_taken_for_annotations_are_told(tmp_path: Path) -> None:
    rows = (f"{f} 1 {0.05 * f} 0\n" for f in range(20))
    (tmp_path / "a.txt").write_text("".join(rows))
    with pytest.warns(RecordingWarning, match=r"walk at 0.12 m/s .*frame_rate=25"):
        READ.from_eth_ucy(tmp_path / "a.txt")
    run = READ.from_eth_ucy(tmp_path / "a.txt", frame_rate=25)
    assert run.t[-1] == pytest.approx(19 / 25)


@pytest.mark.parametrize(
    ("way", "off"),
    [
        (lambda k: (0.05 * k, 0.03 * k), "0.54"),
        (lambda k: (0.05 * k, 0.05 * k), "0.79"),
        (lambda k: (math.cos(0.1 * k), math.sin(0.1 * k)), "0.8"),
    ],
)
def test_a_heading_that_was_not_filled_in_is_told(
    tmp_path: Path, way: Callable[[int], tuple[float, float]], off: str
) -> None:
    rows = ("{:.1f},{:.4f},{:.4f},0\n".format(0.1 * k, *way(k)) for k in range(70))
    (tmp_path / "r.csv").write_text("t,x,y,yaw\n" + "".join(rows))
    with pytest.warns(RecordingWarning, match=rf"is 0 rad in all samples, {off}\S* rad off"):
        READ.from_csv(tmp_path / "r.csv", **BODY)


@pytest.mark.parametrize(
    "head",
    [
        "# written by a program\n#framerate: 25\n#unit: m\n",
        "#framerate: 25\n#X,Y,Z: the agents coordinates (in metres)\n"
        "#ID\tFR\tX\tY\tZ\tA\tB\tANGLE\tCOLOR\t\n",
    ],
)
@pytest.mark.parametrize("end", ["\n", "\t\n"])
def test_jupedsims_ellipses_and_rows_that_end_with_a_tab(
    tmp_path: Path, head: str, end: str
) -> None:
    rows = [
        f"{who}\t{frame}\t{0.05 * frame + who}\t{who}\t0\t0.15\t0.15\t-118.4\t0{end}"
        for frame in range(9)
        for who in (31, 32)
    ]
    path = tmp_path / "a.txt"
    path.write_text(head + "".join(rows))
    for as_table in (True, False):
        with pytest.warns(RecordingWarning, match="(?i)columns a, b, angle, color are not used"):
            run = READ.from_csv(agents=path) if as_table else READ.from_eth_ucy(path)
        assert run.agents is not None
        assert run.agents.id.tolist() == [31, 32]
        assert run.t == pytest.approx(np.arange(9) / 25.0)
        assert run.agents.x[:, 0] == pytest.approx(31 + 0.05 * np.arange(9))
