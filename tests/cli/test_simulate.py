"""`crowdbot simulate` from the outside: what it leaves behind, and what it answers."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from rosbags.highlevel import AnyReader

from crowdbot import cli
from crowdbot.core.recording.recording import Recording
from tests.cli.simulate_cases import FILES, ID, Shell, finished, limit, process
from tests.paths import ROOT

pytestmark = pytest.mark.slow

COLUMNS = (
    "scenario,planner,seed,category,metric,symbol,variant,value,unit,better,status,reason,"
    "lower,upper"
)


# ---------------------------------------------------------------- a complete run
@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of one run of 3 s of `dwa`, everything recorded."""
    out = tmp_path_factory.mktemp("whole")
    assert (
        cli.main(
            ["simulate", "challenge-2020", ID, *limit(3.0), "--record", "all", "--out", str(out)]
        )
        == 0
    )
    (record,) = out.glob("challenge-2020/*+*/**/run.json")
    return record.parent


def test_the_run_directory_is_whole(whole: Path) -> None:
    assert {p.name for p in whole.iterdir()} == FILES
    parts = whole.parts[-4:]
    assert parts[0] == "challenge-2020"
    assert parts[1].startswith(f"{ID}+time_limit=3_s-")
    assert parts[2:] == ("dwa", "seed-0")
    record = json.loads((whole / "run.json").read_text())
    assert record["status"] == "timeout"
    assert record["sim_time"] == 3.0
    assert record["scenario"] == f"{ID}+{parts[1].rpartition('-')[2]}"
    assert record["planner"]["kind"] == "dwa"
    assert record["planner"]["horizon" if "horizon" in record["planner"] else "name"]
    assert record["seed"] == 0
    for key in ("spec", "realisation", "trajectory"):
        assert record["hashes"][key].startswith("cb1-sha256:")
    assert record["versions"]["crowdbot"]
    assert record["plugins"][0]["name"] == "builtin"
    assert record["wall_time"] > 0.0
    assert record["real_time_factor"] > 0.0
    assert "time limit" in record["reason"]
    for name, path in record["references"].items():
        assert (whole / path).is_file(), name
    root = whole.parents[3]
    kept = {p.name.rsplit("-", 1)[0] for p in (root / "references").iterdir()}
    assert kept == {"robot_alone", "crowd_alone"}


def test_the_resolved_scenario_reads_back(whole: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.scenarios.library import open_spec
    from crowdbot.dsl.identity.canonical import content_hash

    registry = discover()
    (scenario,) = open_spec(str(whole / "scenario.yaml"), registry).scenarios
    record = json.loads((whole / "run.json").read_text())
    assert content_hash(scenario, registry.spec_versions(scenario)) == record["hashes"]["spec"]
    assert cli.main(["validate", str(whole / "scenario.yaml")]) == 0
    capsys.readouterr()


def test_scores_csv(whole: Path) -> None:
    text = (whole / "scores.csv").read_text(encoding="utf-8")
    assert text.splitlines()[0] == COLUMNS
    rows = list(csv.DictReader(text.splitlines()))
    assert {r["symbol"] for r in rows} >= {"T_rtg", "L_rp", "E_v", "R", "C"}
    for row in rows:
        assert (row["value"] != "") == (row["status"] == "ok")
        assert row["better"] in ("higher", "lower", "reference", "none")
        assert row["value"].lower() not in ("nan", "inf", "-inf")


def test_another_reader_opens_the_recording(whole: Path) -> None:
    with AnyReader([whole / "run.mcap"]) as reader:
        topics = {c.topic: c.msgtype for c in reader.connections}
        counts = {c.topic: c.msgcount for c in reader.connections}
    assert "sensor_msgs/msg/LaserScan" in topics.values()
    assert "nav_msgs/msg/Odometry" in topics.values()
    assert "rosgraph_msgs/msg/Clock" in topics.values()
    assert {"/tf", "/tf_static", "/clock"} <= set(topics)
    (front,) = [t for t in topics if "front_lidar" in t]
    assert 48 <= counts[front] <= 49  # 16 Hz for 3 s


def test_evaluate_says_the_same_bit_by_bit(whole: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert cli.main(["evaluate", str(whole), "--variant", "all", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    again = {(row["metric"], row["variant"]): row for row in _rows(document)}
    rows = list(csv.DictReader((whole / "scores.csv").read_text().splitlines()))
    assert rows
    for row in rows:
        other = again[row["metric"], row["variant"]]
        assert other["status"] == row["status"]
        value = None if row["value"] == "" else float(row["value"])
        assert other["value"] == value, row["metric"]


def _rows(document: Any) -> list[dict[str, Any]]:
    """The score rows in a JSON answer, wherever it keeps them."""
    if isinstance(document, dict):
        if {"metric", "variant", "value"} <= set(document):
            return [document]
        return [r for v in document.values() for r in _rows(v)]
    return [r for v in document for r in _rows(v)] if isinstance(document, list) else []


def test_the_replay_is_offline(whole: Path) -> None:
    page = (whole / "replay.html").read_text(encoding="utf-8")
    assert "<canvas" in page
    assert 'src="http' not in page
    assert 'href="http' not in page
    assert ID in page


# ------------------------------------------------------------- again, and at once
def _hash(directory: Path) -> str:
    return str(json.loads((directory / "run.json").read_text())["hashes"]["trajectory"])


def test_complete_runs_are_reused_unless_forced(shell: Shell) -> None:
    first = shell("--planner", "goal_seek", "--json").json
    assert first["reused"] is False
    (run,) = shell.runs()
    stamp = (run / "run.mcap").stat().st_mtime_ns
    second = shell("--planner", "goal_seek", "--json").json
    assert second["reused"] is True
    assert (run / "run.mcap").stat().st_mtime_ns == stamp
    assert {k: v for k, v in second.items() if k != "reused"} == {
        k: v for k, v in first.items() if k != "reused"
    }
    third = shell("--planner", "goal_seek", "--force", "--json").json
    assert third["reused"] is False
    assert (run / "run.mcap").stat().st_mtime_ns != stamp
    assert third["hashes"] == first["hashes"]
    assert third["run_id"] == first["run_id"]
    assert shell.leftovers() == []


def test_references_are_computed_once(shell: Shell) -> None:
    def stamps() -> dict[str, int]:
        folders = (shell.out / "references").iterdir()
        return {p.name: (p / "run.mcap").stat().st_mtime_ns for p in folders}

    assert shell("--planner", "goal_seek").code == 0
    first = stamps()
    assert len(first) == 2
    assert shell("--planner", "goal_seek", "--seed", "1").code == 0
    second = stamps()
    assert shell("--planner", "stop_and_go").code == 0
    third = stamps()
    crowd = [n for n in first if n.startswith("crowd_alone")]
    assert [n for n in third if n.startswith("crowd_alone")] == crowd
    assert len(second) == 3  # another seed, another robot alone
    assert len(third) == 4
    assert all(third[n] == first[n] for n in first)


def test_without_references(shell: Shell) -> None:
    answer = shell("--planner", "goal_seek", "--no-references", "--json")
    assert answer.code == 0
    assert answer.json["references"] == {}
    assert not (shell.out / "references").exists()
    again = shell("--planner", "goal_seek", "--json").json
    assert again["reused"] is False
    assert set(again["references"]) == {"robot_alone", "crowd_alone"}


def test_what_is_recorded_changes_nothing_else(shell: Shell) -> None:
    hashes, topics = set(), {}
    for record in ("none", "used", "all"):
        answer = shell("--planner", "goal_seek", "--record", record, "--json")
        assert answer.json["reused"] is False
        hashes.add(answer.json["hashes"]["trajectory"])
        with AnyReader([Path(answer.json["directory"]) / "run.mcap"]) as reader:
            topics[record] = {c.topic for c in reader.connections if c.msgcount}
    assert len(hashes) == 1
    assert any("lidar" in t for t in topics["all"])
    assert not any("lidar" in t for t in topics["used"])
    assert any("odom" in t for t in topics["all"])  # topics of ROS tools (decision 0016)
    assert topics["none"] < topics["used"] < topics["all"]
    for record in ("used", "none"):  # what is there holds more
        answer = shell("--planner", "goal_seek", "--record", record, "--json")
        assert (answer.json["reused"], answer.json["recorded"]) == (True, "all")


def test_the_document_says_what_simulate_records(shell: Shell) -> None:
    """Where it does not, that is what the planner used; the option comes first."""
    brief = ("--planner", "goal_seek", "--no-references", "--json")
    assert shell(*brief).json["recorded"] == "all"
    assert shell(*brief, "--force", "--record", "none").json["recorded"] == "none"
    silent = ROOT / "scenario_specs" / "examples" / "bidirectional_corridor.yaml"
    answer = shell.run([str(silent), "half", *limit(1.0), "--out", str(shell.out), *brief])
    assert answer.json["recorded"] == "used"


def test_a_scenario_without_people(shell: Shell) -> None:
    answer = shell("--planner", "goal_seek", "--set", "crowd=null", "--json")
    assert answer.code == 0
    assert answer.json["references"] == {}
    assert {p.name for p in Path(answer.json["directory"]).iterdir()} == FILES


def test_arrival(shell: Shell) -> None:
    start = "robots.robot.task.start=[44.5 m, 0 m, 0 deg]"
    answer = shell("--planner", "goal_seek", "--set", start, "--json", seconds=5.0)
    assert answer.code == 0
    assert answer.json["status"] == "arrived"
    assert answer.json["goal_time"] == pytest.approx(0.5 / 0.65 + 0.325, abs=0.1)


def test_runs_at_once_are_the_same_run(tmp_path: Path) -> None:
    """Two in one folder, one in another, all at the same time."""
    folders = [tmp_path / "one", tmp_path / "one", tmp_path / "two"]
    running = [process(f, "--planner", "dwa", "--json") for f in folders]
    answers = [finished(p) for p in running]
    assert [a.code for a in answers] == [0, 0, 0]
    assert len({a.json["hashes"]["trajectory"] for a in answers}) == 1
    for folder in folders[1:]:
        (record,) = folder.glob("challenge-2020/*+*/**/run.json")
        assert {p.name for p in record.parent.iterdir()} == FILES
        Recording(record.parent / "run.mcap").trajectories()
        assert len(list((folder / "references").iterdir())) == 2
        assert not [p for p in folder.rglob("*") if ".partial" in p.name or ".old" in p.name]


def test_leftovers_of_an_interrupted_run_are_replaced(shell: Shell) -> None:
    answer = shell("--planner", "goal_seek", "--no-references", "--json")
    run = Path(answer.json["directory"])
    partial = run.with_name("seed-0.partial")
    run.rename(partial)
    (partial / "rubbish.txt").write_text("old")
    assert shell("--planner", "goal_seek", "--no-references").code == 0
    assert {p.name for p in run.iterdir()} == FILES
    assert not partial.exists()


def test_quiet_and_plain_output(shell: Shell) -> None:
    answer = shell("--planner", "goal_seek", "-q")
    assert answer.code == 0
    assert answer.err == ""
    assert answer.out == ""  # nothing went wrong
    assert "\x1b[" not in shell("--planner", "goal_seek").out
