"""``crowdbot evaluate`` on recordings and run directories."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.cli import main
from crowdbot.core.recording.header import AgentsHeader, RecordingHeader, RobotHeader
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.plugin import RobotLimits
from tests.plugins.metrics.scenes import REGISTRY, grid, line, scene

Captured = pytest.CaptureFixture[str]

T = grid(10)
LIMITS = RobotLimits(v_min=-0.5, v_max=1.0, w_max=2.0, a_max=1.0, alpha_max=2.0)
DRIVER, WALKER = line(T, (0, 0), (1, 0)), line(T, (10, 0), (-1, 0))
CROWDED = scene(T, DRIVER, [WALKER], goal_time=8.0)
ROBOT_ALONE = scene(T, DRIVER, goal_time=6.0)
CROWD_ALONE = scene(T, None, [line(T, (10, 0), (-1.3, 0))])


def record(path: Path, run: Trajectories, *, complete: bool = True) -> Path:
    """A recording of a run."""
    robot, agents = run.robot, run.agents
    header = RecordingHeader(
        scenario="test",
        robot=None
        if robot is None
        else RobotHeader(radius=robot.radius, mass=robot.mass, limits=LIMITS),
        agents=None
        if agents is None
        else AgentsHeader(id=agents.id, radius=agents.radius, mass=agents.mass),
    )
    writer = RecordingWriter(path, header, record="none")
    for k, t in enumerate(run.t.tolist()):
        pose = [float(getattr(robot, n)[k]) for n in ("x", "y", "theta", "v", "w") if robot]
        people = [getattr(agents, n)[k] for n in ("x", "y", "vx", "vy") if agents]
        writer.state(t, pose or None, np.stack(people) if people else None)
    goal_time = robot.goal_time if robot is not None else None
    writer.close(goal_time, complete, "arrived" if goal_time is not None else "timeout")
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A run directory with references."""
    run, references = tmp_path / "runs/s/dwa/seed-3", tmp_path / "runs/references"
    run.mkdir(parents=True)
    record(run / "run.mcap", CROWDED)
    for name, trajectories in (("robot_alone", ROBOT_ALONE), ("crowd_alone", CROWD_ALONE)):
        (references / name).mkdir(parents=True)
        record(references / name / "run.mcap", trajectories)
    write_record(run)
    return run


def write_record(run: Path, **changes: Any) -> None:
    up = "../../../references"
    document = {
        "scenario": "s",
        "planner": {"kind": "dwa", "name": "dwa"},
        "seed": 3,
        "references": {
            "robot_alone": f"{up}/robot_alone/run.mcap",
            "crowd_alone": f"{up}/crowd_alone/run.mcap",
        },
    }
    (run / "run.json").write_text(json.dumps({**document, **changes}), encoding="utf-8")


def evaluated(capsys: Captured, *argv: object) -> list[dict[str, Any]]:
    assert main(["evaluate", *map(str, argv), "--json"]) == 0
    found: list[dict[str, Any]] = json.loads(capsys.readouterr().out)
    return found


def failure(capsys: Captured, *argv: object, code: int = 1) -> str:
    assert main(["evaluate", *map(str, argv)]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Traceback" not in captured.err
    return captured.err


def test_a_run_directory_scores_bit_by_bit_as_its_arrays(folder: Path, capsys: Captured) -> None:
    (run,) = evaluated(capsys, folder)
    assert (run["scenario"], run["planner"], run["seed"]) == ("s", "dwa", 3)
    beside = folder.parents[2] / "references"
    expected = score(
        REGISTRY,
        Trajectories.from_mcap(folder / "run.mcap"),
        Trajectories.from_mcap(beside / "robot_alone/run.mcap"),
        Trajectories.from_mcap(beside / "crowd_alone/run.mcap"),
    )
    assert len(expected) > 60
    found = {(s["metric"], s["variant"]): s for s in run["scores"]}
    for one in expected:
        again = found[one.metric, one.variant]
        for name in ("value", "status", "reason", "lower", "upper", "unit", "better", "symbol"):
            assert again[name] == getattr(one, name)
        assert again["extras"] == dict(one.extras)
    assert found["relative_time_to_goal", "corrected"]["value"] == 0.75


def test_the_table(folder: Path, capsys: Captured) -> None:
    assert main(["evaluate", str(folder), "--metrics", "relative_*"]) == 0
    text = capsys.readouterr().out
    assert text.splitlines()[0].strip() == "s dwa seed 3"
    assert "T_rtg" in text
    assert "0.75" in text
    assert "collision" not in text
    assert max(map(len, text.splitlines())) <= 80


def test_recordings_and_given_references(folder: Path, capsys: Captured) -> None:
    recording = folder / "run.mcap"
    (plain,) = evaluated(capsys, recording, "--metrics", "effect_on_v*", "--variant", "literal")
    assert [s["reason"] for s in plain["scores"]] == ["no_reference"]
    assert (plain["run"], plain["seed"]) == (str(recording), None)
    alone = folder.parents[2] / "references/crowd_alone/run.mcap"
    (again,) = evaluated(capsys, recording, "--crowd-alone", alone, "--metrics", "effect_on_v*")
    assert [s["value"] for s in again["scores"]] == pytest.approx([1.3, 1.3])


def test_given_references_win(folder: Path, tmp_path: Path, capsys: Captured) -> None:
    other = record(tmp_path / "other.mcap", scene(T, DRIVER, goal_time=4.0))
    (run,) = evaluated(capsys, folder, "--robot-alone", other, "--metrics", "relative_time*")
    assert {s["value"] for s in run["scores"] if s["variant"] != "common"} == {0.5}


def test_several_runs_in_their_order(folder: Path, capsys: Captured) -> None:
    found = evaluated(capsys, folder / "run.mcap", folder, "--metrics", "risk")
    assert [r["run"] for r in found] == [str(folder / "run.mcap"), str(folder)]
    assert found[0]["scores"] == found[1]["scores"]


def test_an_interrupted_run(tmp_path: Path, capsys: Captured) -> None:
    partial = tmp_path / "seed-0.partial"
    partial.mkdir()
    record(partial / "run.mcap", CROWDED, complete=False)
    until = CROWDED.t[-1]
    expected = (
        f"run.mcap: the recording is cut: it can be read until {until:g} s; --allow-incomplete"
    )
    assert expected in failure(capsys, partial)
    assert main(["evaluate", str(partial), "--json"]) == 1
    captured = capsys.readouterr()
    (run,) = json.loads(captured.out)
    assert (run["complete"], run["until"], run["scores"]) == (False, until, [])
    assert expected in run["error"]
    assert expected in captured.err
    (run,) = evaluated(capsys, partial, "--allow-incomplete")
    assert (run["scenario"], run["complete"], run["until"]) == ("", False, until)
    assert main(["evaluate", str(partial), "--allow-incomplete"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == [str(partial), f"incomplete: read until {until:g} s"]


def test_a_cut_recording_among_others(folder: Path, tmp_path: Path, capsys: Captured) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes((folder / "run.mcap").read_bytes()[:-60])
    assert main(["evaluate", str(cut), str(folder / "run.mcap"), "--json"]) == 1
    first, second = json.loads(capsys.readouterr().out)
    assert (first["complete"], second["complete"]) == (False, True)
    assert first["until"] == second["until"]
    assert "is cut" in first["error"]


def test_nothing_is_written(folder: Path, capsys: Captured) -> None:
    before = {p: p.stat().st_mtime_ns for p in folder.rglob("*")}
    evaluated(capsys, folder)
    assert {p: p.stat().st_mtime_ns for p in folder.rglob("*")} == before


def test_what_is_not_there(folder: Path, tmp_path: Path, capsys: Captured) -> None:
    assert "no such run directory" in failure(capsys, tmp_path / "none")
    (tmp_path / "empty").mkdir()
    assert "run.json is missing" in failure(capsys, tmp_path / "empty")
    recording = folder / "run.mcap"
    assert "robot alone not found" in failure(capsys, recording, "--robot-alone", "none.mcap")
    (folder.parents[2] / "references/crowd_alone/run.mcap").unlink()
    assert "crowd alone not found" in failure(capsys, folder)
    recording.unlink()
    assert "recording not found" in failure(capsys, folder)
    failure(capsys, code=2)


def test_what_is_malformed(folder: Path, capsys: Captured) -> None:
    write_record(folder, references=["x"])
    assert "malformed" in failure(capsys, folder)
    write_record(folder, seed="three")
    assert "malformed" in failure(capsys, folder)
    for text in ("{", "[]", "\ud800".encode("utf-8", "surrogatepass")):
        data = text if isinstance(text, bytes) else text.encode()
        (folder / "run.json").write_bytes(data)
        assert "run.json" in failure(capsys, folder)


def test_a_file_that_is_no_recording(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "x.mcap").write_text("hello", encoding="utf-8")
    assert "x.mcap" in failure(capsys, tmp_path / "x.mcap")


def test_numbers_beyond_all_sizes_are_told_with_the_recording(
    folder: Path, capsys: Captured
) -> None:
    record(
        folder.parents[2] / "references/crowd_alone/run.mcap",
        scene(T, None, [line(T, (1e300, 0), (0.0, 0))]),
    )
    text = failure(capsys, folder)
    assert "references/crowd_alone/run.mcap: damaged: trajectories: agent_x has a number" in text
    assert text.startswith("error: ")


def test_names_that_nothing_answers_to(folder: Path, capsys: Captured) -> None:
    assert "did you mean 'risk'" in failure(capsys, folder, "--metrics", "rissk")
    assert "did you mean 'corrected'" in failure(capsys, folder, "--variant", "corected")


def test_brackets_in_names_are_text(folder: Path, capsys: Captured) -> None:
    write_record(folder, scenario="a[red]b")
    assert main(["evaluate", str(folder)]) == 0
    assert "a[red]b dwa" in capsys.readouterr().out
