"""Files of people alone are read alike by ``import``, ``realism`` and in Python."""

from __future__ import annotations

import re
import sqlite3
import warnings
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from crowdbot import Trajectories
from crowdbot.cli import main
from crowdbot.core.realism.near_robots.recordings import read_clips
from crowdbot.core.trajectories.data_sets.people_files import holds_people, people_run, people_table
from crowdbot.errors import InputError, RecordingWarning

#: id, frame, x and y in cm, z: 60 cm a second at 16 frames a second.
ROWS = "".join(f"{i}\t{f}\t{60 * f / 16}\t{100 * i}\t170\n" for i in (1, 2) for f in range(20))


def _import(file: Path) -> np.ndarray:
    """t, id, x, y that ``crowdbot import`` writes."""
    out = file.parent / "scene.yaml"
    assert main(["import", str(file), "--out", str(out)]) == 0
    return np.loadtxt(file.parent / "scene.recorded.csv", delimiter=",", skiprows=1)


@pytest.mark.parametrize("name", ["a.txt", "a.csv", "a.tsv"])
@pytest.mark.parametrize("rate", ["# framerate: 16", "#framerate: 16.00 fps"])
def test_a_comment_states_the_frame_rate_to_all(tmp_path: Path, name: str, rate: str) -> None:
    file = tmp_path / name
    file.write_text(f"{rate}\n# id frame x/cm y/cm z/cm\n{ROWS}")
    rows = _import(file)
    assert rows.shape == (40, 4)
    np.testing.assert_allclose(rows[-1], [19 / 16, 2, 0.6 * 19 / 16, 2.0])
    run = people_run(people_table(file), ())
    assert run.agents is not None
    np.testing.assert_allclose(run.t[-1], 19 / 16)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.ndjson", '{"track": {"f": 0, "p": 1, "x": 0, "y": 5}}\n'
                     '{"track": {"f": 10, "p": 1, "x": 0.4, "y": 5}}\n'),
        ("a.txt", "780 1 0 5\n790 1 0.4 5\n"),
        ("a.csv", "t,x1,y1\n0,0,5\n0.4,0.4,5\n"),
        ("b.txt", "time;id;x;y\n0;1;0;5\n0,4;1;0,4;5\n"),
        ("c.csv", "t,id,x,y\n1700000000.5,1,0,5\n1700000000.9,1,0.4,5\n"),
    ],
)  # fmt: skip
def test_import_reads_what_realism_reads(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    wanted = np.array([[0.0, 1.0, 0.0, 5.0], [0.4, 1.0, 0.4, 5.0]])
    np.testing.assert_allclose(_import(tmp_path / name), wanted, atol=1e-6)


def test_other_texts_are_no_people(tmp_path: Path) -> None:
    for text in ("POLYGON ((0 0, 1 0, 1 1))", "", "a,b,c\n1,2,3\n", "1,2,3,4,5,6\n"):
        assert not holds_people(tmp_path / "a.csv", text)


def test_robots_are_no_people(tmp_path: Path) -> None:
    rows = [f"{k},{who},{k},0" for k in range(3) for who in ("robot_1", "ann", "robotics_student")]
    (tmp_path / "a.csv").write_text("t,id,x,y\n" + "\n".join(rows))
    with pytest.warns(RecordingWarning, match=r"a\.csv:2: rows of a robot are left out .*: 3"):
        run = Trajectories.from_csv(agents=tmp_path / "a.csv")
    assert run.agents is not None
    assert run.agents.x.shape == (3, 2)


def test_more_cells_than_names_are_refused(tmp_path: Path) -> None:
    """A decimal comma that also separates, and R's tables, whose first row has no name above."""
    for text in ("t,id,x,y\n0,1,2,5,3,5\n", "t id x y\n1 0 7 2 3\n"):
        (tmp_path / "a.csv").write_text(text)
        with pytest.raises(InputError, match=r"a\.csv:2: . cells, and the first row has 4"):
            Trajectories.from_csv(agents=tmp_path / "a.csv")


def test_frames_among_robots_have_the_stated_rate(tmp_path: Path) -> None:
    rows = [f"{k},robot,{k / 16},0,0.2\n{k},1,{9 - k / 16},1," for k in range(64)]
    (tmp_path / "a.csv").write_text("# framerate: 16\nframe,id,x,y,radius\n" + "\n".join(rows))
    (clip,) = read_clips(tmp_path / "a.csv")
    assert clip.t[-1] - clip.t[0] == pytest.approx(63 / 16, abs=0.1)


def test_columns_of_trackers_have_usual_names(tmp_path: Path) -> None:
    """A tracker's export names centres, and numbers frames beside times and tracks."""
    rows = [f"{k},{8 * k},{0.4 * k},7,{k}.5,{2 * k}.25,1" for k in range(6)]
    (tmp_path / "a.csv").write_text(
        "sample_index,frame,time_s,track_id,x_center,y_center,person_id\n" + "\n".join(rows)
    )
    table = people_table(tmp_path / "a.csv")
    np.testing.assert_allclose(table.numbers("t"), 0.4 * np.arange(6))
    np.testing.assert_allclose(table.numbers("y"), 2 * np.arange(6) + 0.25)
    assert set(table.numbers("id")) == {1.0}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "t,id,x,y,w,h\n" + "".join(f"{k},1,{k},0,50,90\n" for k in range(6)),
            r"corners of boxes\? People stand at x \+ w/2, y \+ h",
        ),
        (
            "t,id,x,y\n"
            + "".join(f"{k + 0.01 * i},{i},{k},{i}\n" for k in range(4) for i in range(3)),
            "3 are there together, and no two at one time: a stamp for each row",
        ),
        (
            "t,id,x,y\n" + "".join(f"{k / 10},1,{90 * k},0\n" for k in range(9)),
            "or in pixels",
        ),
    ],
)
def test_odd_tables_are_told(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.warns(RecordingWarning) as caught:
        Trajectories.from_csv(agents=tmp_path / "a.csv")
    assert any(re.search(message, str(warning.message)) for warning in caught)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("header:\n  stamp:\n    sec: 3\n", "is what 'ros2 topic echo' prints"),
        ("t,x,y\n" + "1.62766E+18,0,0\n" * 3, r"csv:3: t is 1\.62766E\+18 in row after row"),
    ],
)
def test_tables_of_a_robot_that_are_none(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        Trajectories.from_csv(tmp_path / "a.csv", robot_radius=0.2, robot_mass=5.0)


def test_the_frame_of_a_camera_is_told(tmp_path: Path) -> None:
    """A visual odometry moves along z; what drives on a floor may go over a ramp."""
    for ahead, seen in ((0.1, True), (0.01, False)):
        rows = [f"{k / 10} {0.02 * k} 0.001 {ahead * k} 0 0 0 1" for k in range(9)]
        (tmp_path / "a.txt").write_text("\n".join(rows))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            Trajectories.from_csv(tmp_path / "a.txt", robot_radius=0.2, robot_mass=5.0)
        assert any("the frame of a camera" in str(w.message) for w in caught) == seen


def _database(file: Path, fps: str | None = "10.0") -> None:
    """Write what JuPedSim writes: two people walk along x at 1 m/s, from frame 5 on."""
    with closing(sqlite3.connect(file)) as base:
        base.executescript(
            "CREATE TABLE metadata(key TEXT PRIMARY KEY, value TEXT NOT NULL);"
            "CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL,"
            "pos_x REAL NOT NULL, pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL);"
        )
        if fps is not None:
            base.execute("INSERT INTO metadata VALUES ('fps', ?)", [fps])
        rows = [(5 + k, i, 0.1 * k, i) for k in range(20) for i in (1, 2)]
        base.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, 1, 0)", rows)
        base.commit()


def test_a_database_of_jupedsim(tmp_path: Path) -> None:
    file = tmp_path / "a.sqlite"
    _database(file)
    rows = _import(file)
    assert rows.shape == (40, 4)
    np.testing.assert_allclose(rows[-1], [1.9, 2.0, 1.9, 2.0])
    with pytest.warns(RecordingWarning, match="ori_x, ori_y are not used"):
        run = Trajectories.from_eth_ucy(file, frame_rate=5.0)
    assert run.t[-1] == pytest.approx(3.8)


@pytest.mark.parametrize("fps", [None, "0", "many"])
def test_a_database_without_frame_rate(tmp_path: Path, fps: str | None) -> None:
    _database(tmp_path / "a.sqlite", fps)
    with pytest.raises(InputError, match=r"a\.sqlite: its metadata does not say .* \(fps\)"):
        people_table(tmp_path / "a.sqlite")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"SQLite format 3\0xxxx", r"a\.sqlite: is not a database of JuPedSim's people"),
        (b"frame id x y\n", r"a\.sqlite: the table has no rows"),
    ],
)
def test_damaged_databases(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "a.sqlite").write_bytes(content)
    with pytest.raises(InputError, match=message):
        people_table(tmp_path / "a.sqlite")


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "t,id,x,y\n0,1,0,0\n0,1,1,0\n", r"a\.csv:3: two rows of id 1 at t = 0 s"),
        ("a.txt", "# fps: 25\n# fps: 16\n1 0 0 0\n", "its comments state 16 and 25 frames"),
        ("a.txt", '0 200 300 230 380 0 0 0 0 "Pedestrian"\n', "as in the Stanford Drone Dataset"),
        (
            "a.csv",
            "t,id,lat,lon\n0,1,48,11\n",
            "columns x, y are missing; the table has t, id",
        ),
    ],
)
def test_import_says_why_a_table_is_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, text: str, message: str
) -> None:
    (tmp_path / name).write_text(text)
    assert main(["import", str(tmp_path / name)]) == 1
    assert re.search(message, capsys.readouterr().err)


def test_degrees_in_whole_seconds_are_no_frames(tmp_path: Path) -> None:
    rows = [f"{k},1,{11 + 1e-5 * k},{48 + 1e-5 * k}" for k in range(9)]
    (tmp_path / "a.csv").write_text("t,id,x,y\n" + "\n".join(rows))
    with pytest.warns(RecordingWarning, match="longitude and latitude"):
        Trajectories.from_csv(agents=tmp_path / "a.csv")
