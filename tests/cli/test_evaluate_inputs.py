"""``crowdbot evaluate`` on many runs, on foreign and broken files, on commands and answers."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lz4.frame  # type: ignore[import-untyped]
import pytest
from mcap.data_stream import RecordBuilder
from mcap.reader import make_reader
from mcap.records import Chunk, Header
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from crowdbot.cli import main
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.container.records import MAX_CHUNK
from crowdbot.core.recording.reading.commands import read_commands
from crowdbot.core.recording.recording import Recording
from crowdbot.core.scoring.scores_csv import COLUMNS, read_scores_csv, write_scores_csv
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.cli.test_evaluate_command import CROWD_ALONE, CROWDED, DRIVER, ROBOT_ALONE, T, record
from tests.plugins.metrics.scenes import scene

Captured = pytest.CaptureFixture[str]
Rewrite = Callable[[str, str, bytes], list[tuple[str, str, bytes]]]


def rewritten(
    source: Path, target: Path, change: Rewrite, compression: CompressionType | None = None
) -> Path:
    """A recording, message by message, as somebody else would have written it."""
    with source.open("rb") as stream, target.open("wb") as out:
        writer = Writer(out, compression=compression or CompressionType.ZSTD)
        writer.start(profile="ros2", library="somebody")
        channels: dict[tuple[str, str], int] = {}
        for schema, channel, message in make_reader(stream).iter_messages():
            assert schema is not None
            for topic, kind, data in change(channel.topic, schema.name, message.data):
                if (topic, kind) not in channels:
                    encoding = "cdr" if kind else "json"
                    number = writer.register_schema(kind, "ros2msg", b"") if kind else 0
                    channels[topic, kind] = writer.register_channel(topic, encoding, number)
                writer.add_message(channels[topic, kind], message.log_time, data, 0)
        writer.finish()  # type: ignore[no-untyped-call]
    return target


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    return record(tmp_path / "run.mcap", CROWDED)


def scores(capsys: Captured, *argv: object) -> list[dict[str, Any]]:
    assert main(["evaluate", *map(str, argv), "--json"]) == 0
    found: list[dict[str, Any]] = json.loads(capsys.readouterr().out)
    return found


def refused(capsys: Captured, *argv: object, code: int = 1) -> str:
    assert main(["evaluate", *map(str, argv)]) == code
    captured = capsys.readouterr()
    assert "Traceback" not in captured.err
    return captured.err


# ---------------------------------------------------------------------- other files
@pytest.mark.parametrize(
    ("run", "reason"),
    [(CROWD_ALONE, "invalid_no_robot"), (ROBOT_ALONE, "no_agents")],
    ids=["no robot", "no people"],
)
def test_a_body_is_missing(
    run: Trajectories, reason: str, tmp_path: Path, capsys: Captured
) -> None:
    (found,) = scores(capsys, record(tmp_path / "x.mcap", run))
    assert reason in {s["reason"] for s in found["scores"]}
    assert all((s["value"] is None) == (s["status"] != "ok") for s in found["scores"])


@pytest.mark.parametrize("compression", [CompressionType.LZ4, CompressionType.NONE])
def test_other_compressions_and_more_topics(
    compression: CompressionType, recording: Path, tmp_path: Path, capsys: Captured
) -> None:
    def chatty(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        return [("/log", "", b'{"a": 1}'), ("/x/contacts", "a/msg/B", b""), (topic, kind, data)]

    other = rewritten(recording, tmp_path / "other.mcap", chatty, compression)
    assert scores(capsys, other)[0]["scores"] == scores(capsys, recording)[0]["scores"]


def test_topics_below_the_name_of_a_robot(
    recording: Path, tmp_path: Path, capsys: Captured
) -> None:
    def two(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        return [("/r1" + topic, kind, data), ("/r2" + topic, kind, data)]

    def one(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        return two(topic, kind, data)[:1]

    expected = scores(capsys, recording)[0]["scores"]
    single = rewritten(recording, tmp_path / "one.mcap", one)
    assert scores(capsys, single)[0]["scores"] == expected
    both = rewritten(recording, tmp_path / "two.mcap", two)
    assert scores(capsys, both, "--robot", "r2")[0]["scores"] == expected
    fleet = {s["variant"] for s in scores(capsys, both)[0]["scores"] if s["metric"] == "success"}
    assert fleet == {"corrected", "corrected@r1", "corrected@r2"}
    assert "there are: r1, r2" in refused(capsys, both, "--robot", "r3")


def test_topics_that_hold_something_else(recording: Path, tmp_path: Path, capsys: Captured) -> None:
    def wrong(kind_of: str) -> Rewrite:
        def change(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
            return [(topic, kind_of if topic == "/crowdbot/state" else kind, data)]

        return change

    for kind in ("std_msgs/msg/String", "", "no_such/msg/Type"):
        path = rewritten(recording, tmp_path / "wrong.mcap", wrong(kind))
        assert "/crowdbot/state holds" in refused(capsys, path)


def test_nothing_in_it(recording: Path, tmp_path: Path, capsys: Captured) -> None:
    empty = rewritten(recording, tmp_path / "empty.mcap", lambda *_: [])
    assert "no recording of crowdbot" in refused(capsys, empty)

    def header_only(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        return [(topic, kind, data)] if topic == "/crowdbot/header" else []

    path = rewritten(recording, tmp_path / "header.mcap", header_only)
    assert "holds no sample" in refused(capsys, path)


def test_a_bomb_in_lz4(tmp_path: Path, capsys: Captured) -> None:
    frame = lz4.frame.compress(bytes(2 * MAX_CHUNK))
    for announced, message in ((2 * MAX_CHUNK, "refused"), (1000, "no recording")):
        builder = RecordBuilder()
        builder.write(MCAP0_MAGIC)
        Header("ros2", "x").write(builder)
        Chunk("lz4", frame, 0, 0, 0, announced).write(builder)
        (tmp_path / "x.mcap").write_bytes(builder.end())  # type: ignore[no-untyped-call]
        assert message in refused(capsys, tmp_path / "x.mcap")


def test_a_header_that_contradicts_itself(
    recording: Path, tmp_path: Path, capsys: Captured
) -> None:
    def change(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        if topic != "/crowdbot/header":
            return [(topic, kind, data)]
        message = ros.from_cdr(data, kind)
        message.hash_names = ["a", "b"]
        return [(topic, kind, ros.to_cdr(message))]

    path = rewritten(recording, tmp_path / "x.mcap", change)
    assert "contradicts itself" in refused(capsys, path)


# ------------------------------------------------------------------------- many runs
@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """Four runs of which one is broken, one that goes on, and a calibration run."""
    root = tmp_path / "runs"
    for i in range(4):
        folder = root / f"s/dwa/seed-{i}"
        folder.mkdir(parents=True)
        record(folder / "run.mcap", scene(T, DRIVER, goal_time=5.0 + i))
        document = {"scenario": "s", "planner": {"name": "dwa", "label": "dwa+1f3a"}, "seed": i}
        (folder / "run.json").write_text(json.dumps(document), encoding="utf-8")
    (root / "s/dwa/seed-2/run.mcap").write_bytes(b"nothing")
    for other in ("references/robot_alone-1", "s/dwa/seed-9.partial"):
        shutil.copytree(root / "s/dwa/seed-0", root / other)
    return root


@pytest.mark.slow
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_bad_run_stops_no_other(jobs: str, campaign: Path, capsys: Captured) -> None:
    argv = ["evaluate", str(campaign), "--metrics", "success", "--json", "--jobs", jobs]
    assert main(argv) == 1
    captured = capsys.readouterr()
    found = json.loads(captured.out)
    assert [r["seed"] for r in found] == [0, 1, None, 3]
    assert [len(r["scores"]) for r in found] == [1, 1, 0, 1]
    assert "seed-2" in found[2]["error"]
    lines = captured.err.splitlines()  # on a slow machine progress is among them
    (error,) = [line for line in lines if line.startswith("error: ")]
    assert "not an MCAP file" in error
    assert lines[-1] == "scored 3 of 4 runs, 1 failed"


def test_one_table_of_all_runs(campaign: Path, tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "all.csv"
    assert main(["evaluate", str(campaign), "--metrics", "s*", "--out", str(out)]) == 1
    assert capsys.readouterr().out == ""
    with out.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == (*COLUMNS, "run")
    assert {r["seed"] for r in rows} == {"0", "1", "3"}
    assert {r["planner"] for r in rows} == {"dwa+1f3a"}
    assert {r["run"] for r in rows} == {str(campaign / f"s/dwa/seed-{i}") for i in (0, 1, 3)}
    assert main(["evaluate", str(campaign / "s/dwa/seed-0"), "--out", f"{out}.json", "-q"]) == 0
    assert len(json.loads(Path(f"{out}.json").read_text(encoding="utf-8"))) == 1
    assert "must end in .csv or .json" in refused(capsys, campaign, "--out", "x.txt", code=2)
    assert "cannot be written" in refused(
        capsys, campaign / "s/dwa/seed-0", "--out", "/dev/null/x.csv"
    )
    assert sorted(p.name for p in tmp_path.iterdir()) == ["all.csv", "all.csv.json", "runs"]


def test_the_table_of_a_run_equals_that_of_simulate(
    recording: Path, tmp_path: Path, capsys: Captured
) -> None:
    """Value by value, as text: what ``simulate`` writes is `write_scores_csv`."""
    import crowdbot

    written = crowdbot.score(Recording(recording).trajectories())
    write_scores_csv(tmp_path / "scores.csv", written, "s", "dwa", 0)
    assert main(["evaluate", str(recording), "--out", str(tmp_path / "again.csv")]) == 0
    capsys.readouterr()
    with (tmp_path / "again.csv").open(encoding="utf-8", newline="") as file:
        again = [list(row.values())[3:-1] for row in csv.DictReader(file)]
    with (tmp_path / "scores.csv").open(encoding="utf-8", newline="") as file:
        first = [list(row.values())[3:] for row in csv.DictReader(file)]
    assert again == first
    assert len(read_scores_csv(tmp_path / "scores.csv")) == len(first)


def test_experimental_metrics_on_request(recording: Path, capsys: Captured) -> None:
    plain = {s["metric"] for s in scores(capsys, recording)[0]["scores"]}
    more = {s["metric"] for s in scores(capsys, recording, "--experimental")[0]["scores"]}
    assert "jerk" in more - plain
    assert plain < more
    (named,) = scores(capsys, recording, "--metrics", "jerk")
    assert {s["metric"] for s in named["scores"]} == {"jerk"}


# ---------------------------------------------------------------- commands and answers
def twists(path: Path, *, stamped: bool = False) -> Path:
    """Two topics: the user drives straight on, shared control turns from 1 s on."""
    with path.open("wb") as out:
        writer = Writer(out)
        writer.start(profile="ros2")
        kind = "geometry_msgs/msg/Twist" + "Stamped" * stamped
        schema = writer.register_schema(kind, "ros2msg", ros.definition(kind))
        user, final = (writer.register_channel(t, "cdr", schema) for t in ("/user", "/final"))
        for channel, t, v, w in (
            (user, 0.0, 1.0, 0.0),
            (final, 0.0, 1.0, 0.0),
            (final, 1.0, 0.0, 1.0),
            (user, 3.0, 1.0, 0.0),
        ):
            message = ros.twist(v, 0.0, w)
            if stamped:
                header = ros.header(0, "base_link")
                message = ros.new("geometry_msgs/TwistStamped", header=header, twist=message)
            writer.add_message(channel, round(t * 1e9) + 10**18, ros.to_cdr(message), 0)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


@pytest.mark.parametrize("stamped", [False, True])
def test_commands_of_a_recording_without_a_run(
    stamped: bool, tmp_path: Path, capsys: Captured
) -> None:
    path = twists(tmp_path / "drive.mcap", stamped=stamped)
    topics = ("--user-topic", "/user", "--command-topic", "/final")
    (found,) = scores(capsys, path, *topics, "--v-max", 1, "--w-max", 1, "--metrics", "agreement")
    assert [s["value"] for s in found["scores"]] == pytest.approx([2 / 3, 2 / 3])
    assert "limits are not recorded" in refused(capsys, path, *topics)
    wrong = ("--user-topic", "/usr", "--v-max", 1, "--w-max", 1)
    assert "did you mean '/user'" in refused(capsys, path, *wrong)


def test_commands_hold_until_the_next(tmp_path: Path) -> None:
    path = twists(tmp_path / "drive.mcap")
    found = read_commands(path, "/user", "/final", v_max=1.0, w_max=1.0)
    assert found.t.tolist() == [0.0, 1.0, 3.0]
    assert found.w_sc.tolist() == [0.0, 1.0, 1.0]
    assert found.v_user.tolist() == [1.0, 1.0, 1.0]
    assert found.t_end == 3.0


def test_limits_come_from_the_run(recording: Path, tmp_path: Path, capsys: Captured) -> None:
    def drive(topic: str, kind: str, data: bytes) -> list[tuple[str, str, bytes]]:
        twist = ros.to_cdr(ros.twist(1.0, 0.0, 0.0))
        ends = ("/crowdbot/header", "/crowdbot/end")  # the first instant and the last
        more = [("/user", "geometry_msgs/msg/Twist", twist)] if topic in ends else []
        return [(topic, kind, data), *more]

    path = rewritten(recording, tmp_path / "x.mcap", drive)
    same = ("--user-topic", "/user", "--command-topic", "/user", "--metrics", "agreement")
    (found,) = scores(capsys, path, *same)
    assert [s["value"] for s in found["scores"]] == [1.0, 1.0]
    state = ("--user-topic", "/crowdbot/state", "--command-topic", "/user")
    assert "not geometry_msgs/msg/Twist" in refused(capsys, path, *state)


def test_tables_of_commands_and_answers(tmp_path: Path, capsys: Captured) -> None:
    table = tmp_path / "commands.csv"
    table.write_text("t,v_user,w_user,v_sc,w_sc\n0,1,0,0,1\n1,1,0,0,1\n2,1,0,0,1\n")
    limits = ("--v-max", 1, "--w-max", 1)
    (found,) = scores(capsys, "--commands", table, *limits, "--metrics", "agreement")
    assert [s["value"] for s in found["scores"]] == pytest.approx([0.5, 0.5])
    answers = tmp_path / "answers.csv"
    rows = [f"use,satisfaction_{i},7" for i in range(1, 8)]
    answers.write_text("\n".join(["questionnaire,item,value", *rows]) + "\n")
    (found,) = scores(capsys, "--questionnaires", answers, "--metrics", "use")
    assert [s["value"] for s in found["scores"]] == [None, None, None, 7.0]
    assert "are needed" in refused(capsys, "--commands", table)
    assert "no such file" in refused(capsys, "--commands", tmp_path / "x.mcap")
    other = record(tmp_path / "no_joystick.mcap", CROWDED)
    assert "name its two topics" in refused(capsys, "--commands", other)
    assert "belong to one run" in refused(capsys, "a", "b", "--commands", table, code=2)
    assert "name one" in refused(capsys, "--user-topic", "/u", "--questionnaires", "q", code=2)
    assert "nothing to score" in refused(capsys, code=2)
