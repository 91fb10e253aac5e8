"""`crowdbot simulate` when something is wrong: the input, the folder, the planner, the power."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import pytest

from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.recording.recording import Recording
from tests.cli.simulate_cases import FILES, ID, Shell, finished, planner_file, process
from tests.waiting import wait_until

pytestmark = pytest.mark.slow

# ---------------------------------------------------------------------- bad input
WRONG = {
    "unknown id": (["challenge-2020", "in-d0125-slow-c01-r03"], 1, "did you mean"),
    "several ids": (["challenge-2020", "in-d0125"], 1, "27 scenarios"),
    "no id": (["challenge-2020"], 1, "no id was given"),
    "unknown suite": (["chalenge-2020"], 1, "did you mean 'challenge-2020'"),
    "missing file": (["no/such.yaml"], 1, "no/such.yaml"),
    "unknown planner": (["challenge-2020", ID, "--planner", "dwaa"], 1, "did you mean 'dwa'"),
    "missing planner file": (["challenge-2020", ID, "--planner", "no.py:Mine"], 1, "no.py"),
    "misspelt key": (["challenge-2020", ID, "--set", "crowd.flow.denisty=0.2"], 1, "density"),
    "wrong unit": (["challenge-2020", ID, "--set", "crowd.flow.density=2 kg"], 1, "2 kg"),
    "wrong type": (["challenge-2020", ID, "--set", "robots.robot.task.time_limit=long"], 1, "long"),
    "no number": (["challenge-2020", ID, "--set", "robots.robot.task.time_limit=.nan"], 1, "nan"),
    "no key": (["challenge-2020", ID, "--set", "=3"], 2, "=3"),
    "no value": (["challenge-2020", ID, "--set", "crowd"], 2, "crowd"),
    "unknown zone": (["challenge-2020", ID, "--set", "robots.robot.task.goal.zone=x"], 1, "x"),
    "no robot": (["challenge-2020", ID, "--set", "robots={}", "--planner", "dwa"], 2, "no robot"),
    "too many people": (["challenge-2020", ID, "--set", "crowd.flow.density=5"], 1, "people fit"),
    "planner key": (["challenge-2020", ID, "--planner-set", "horizn=2"], 1, "horizn"),
    "negative seed": (["challenge-2020", ID, "--seed", "-1"], 2, "seed"),
    "unknown option": (["challenge-2020", ID, "--sed", "1"], 2, "--sed"),
    "unknown record": (["challenge-2020", ID, "--record", "some"], 2, "some"),
    "nothing": ([], 2, "SPEC"),
}  # fmt: skip


@pytest.mark.parametrize("case", list(WRONG))
def test_bad_input(case: str, shell: Shell) -> None:
    argv, code, text = WRONG[case]
    answer = shell.run([*argv, "--out", str(shell.out)])
    assert answer.code == code
    assert text in answer.err
    assert answer.out == ""
    assert not shell.out.exists()


def test_a_planner_that_needs_what_the_robot_has_not(shell: Shell, tmp_path: Path) -> None:
    answer = shell("--planner", planner_file(tmp_path, needs="('sonar',)"))
    assert answer.code == 1
    assert "sonar" in answer.err
    assert shell.runs() == []
    assert shell.leftovers() == []


def test_a_file_in_the_way_of_the_output(shell: Shell) -> None:
    shell.out.write_text("mine")
    answer = shell("--planner", "goal_seek")
    assert answer.code == 1
    assert str(shell.out) in answer.err
    assert shell.out.read_text() == "mine"


def test_a_folder_that_cannot_be_written(shell: Shell) -> None:
    """Read-only; for root, who may write anywhere, a place where nobody can make folders."""
    if os.geteuid() == 0:
        shell.out = Path("/dev/null/runs")
    else:
        shell.out.mkdir(mode=0o500)
    answer = shell("--planner", "goal_seek")
    assert answer.code == 1
    assert str(shell.out) in answer.err
    assert shell.runs() == []


def test_a_folder_of_an_impossible_name(shell: Shell) -> None:
    shell.out = shell.out / ("x" * 300)
    answer = shell("--planner", "goal_seek")
    assert answer.code == 1
    assert "cannot be written" in answer.err


def test_a_file_in_the_way_of_the_run(shell: Shell) -> None:
    """Somebody's file under the final name of the run is not swept away."""
    answer = shell("--planner", "goal_seek", "--no-references", "--json")
    run = Path(answer.json["directory"])
    for file in run.iterdir():
        file.unlink()
    run.rmdir()
    run.write_text("mine")
    answer = shell("--planner", "goal_seek", "--no-references")
    if answer.code == 0:
        assert {p.name for p in run.iterdir()} == FILES
        assert shell.leftovers() == []
    else:
        assert answer.code == 1
        assert run.read_text() == "mine"


# ---------------------------------------------------------------- failing planners
FAILING = {
    "raises": ({"step": "raise ValueError('lost')"}, "lost"),
    "raises later": ({"step": "return (0.1, 0.0) if obs.t < 0.5 else 1 / 0"}, "ZeroDivisionError"),
    "raises in reset": ({"reset": "raise RuntimeError('no model')"}, "no model"),
    "raises in init": ({"init": "raise RuntimeError('no file')"}, "no file"),
    "returns nan": ({"step": "return (float('nan'), 0.0)"}, "finite"),
    "returns inf": ({"step": "return (0.0, float('inf'))"}, "finite"),
    "returns None": ({"step": "return None"}, "None"),
    "returns one": ({"step": "return (0.1,)"}, "(0.1,)"),
    "returns four": ({"step": "return (0.1, 0.1, 0.1, 0.1)"}, "0.1"),
    "returns text": ({"step": "return 'fast'"}, "fast"),
    "exits": ({"step": "sys.exit(0)"}, "SystemExit"),
    "exits in reset": ({"reset": "sys.exit(7)"}, "SystemExit"),
    "exits in init": ({"init": "sys.exit(0)"}, "SystemExit"),
}


@pytest.mark.parametrize("case", list(FAILING))
def test_a_failing_planner_leaves_a_complete_run(case: str, shell: Shell, tmp_path: Path) -> None:
    code, text = FAILING[case]
    answer = shell("--planner", planner_file(tmp_path, **code), "--no-references", "--json")
    assert answer.code == 3
    record = answer.json
    assert record["status"] == "planner_failed"
    assert "Mine" in record["reason"]
    assert text in record["reason"]
    assert {p.name for p in Path(record["directory"]).iterdir()} == FILES
    by_symbol = {s["metric"]: s for s in record["scores"]}
    assert by_symbol
    assert all(s["value"] is not None or s["status"] != "ok" for s in record["scores"])
    assert shell.leftovers() == []
    run = Recording(Path(record["directory"]) / "run.mcap").trajectories()
    assert run.robot is not None
    assert run.robot.goal_time is None


def test_a_failure_is_told_to_people(shell: Shell, tmp_path: Path) -> None:
    answer = shell("--planner", planner_file(tmp_path, "raise ValueError('lost')"))
    assert answer.code == 3
    assert "error: planner 'Mine'" in answer.err
    assert "mine.py:8" in answer.err
    assert "replay.html" in answer.out.replace("\n", "")


def test_a_planner_file_that_cannot_be_imported(shell: Shell, tmp_path: Path) -> None:
    answer = shell("--planner", planner_file(tmp_path, top="import no_such_module"))
    assert answer.code == 3
    assert "no_such_module" in answer.err
    assert not shell.out.exists()


@pytest.mark.parametrize("place", ["step", "reset", "init", "top"])
def test_prints_of_a_planner_keep_off_stdout(place: str, shell: Shell, tmp_path: Path) -> None:
    noise = "print('thinking')"
    code = {place: f"{noise}; return (0.1, 0.0)" if place == "step" else noise}
    answer = shell("--planner", planner_file(tmp_path, **code), "--no-references", "--json")
    assert answer.code == 0
    assert answer.json["status"] == "timeout"
    assert "thinking" in answer.err


HANGS = {
    "sleeps": "time.sleep(1e6)",
    "loops": "exec('while True: pass')",
    "keeps the interpreter lock": "__import__('ctypes').PyDLL(None).sleep(1000)",
}


def _hanging(case: str) -> str:
    return f"{HANGS[case]} if obs.t > 0.5 else None\n        return (0.2, 0.0)"


@pytest.mark.parametrize("case", list(HANGS))
def test_a_planner_that_never_returns(
    case: str, shell: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.4, 1.0, None))
    answer = shell("--planner", planner_file(tmp_path, _hanging(case)), "--no-references", "--json")
    assert answer.code == 3
    record = answer.json
    assert record["status"] == "planner_failed"
    assert "did not return from step within 0.4 s; its process was ended" in record["reason"]
    assert "mine.py:8)" in record["reason"]
    assert record["planner_process"] == "own"
    assert {p.name for p in Path(record["directory"]).iterdir()} == FILES
    assert shell.leftovers() == []


@pytest.mark.parametrize("case", list(HANGS)[:2])
def test_a_planner_that_never_returns_in_our_process(
    case: str, shell: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.4, 1.0, None))
    planner = planner_file(tmp_path, _hanging(case))
    answer = shell("--planner", planner, "--no-references", "--in-process")
    assert answer.code == 3
    assert "did not return from step" in answer.err
    assert shell.runs() == []
    (partial,) = shell.out.rglob("*.partial")
    run = Recording(partial / "run.mcap").trajectories()
    assert run.t[-1] == pytest.approx(0.5, abs=1.0 / 16.0)


def test_a_planner_that_swallows_every_interruption(tmp_path: Path) -> None:
    step = (
        "while obs.t > 0.3:\n            try:\n                time.sleep(1.0)\n"
        "            except BaseException:\n                pass\n        return (0.2, 0.0)"
    )
    out = tmp_path / "runs"
    options = ("--planner", planner_file(tmp_path, step), "--no-references")
    answer = finished(process(out, *options, "--in-process"))
    assert answer.code == 3
    assert ".partial" in answer.err
    assert not list(out.rglob("run.json"))
    answer = finished(process(out, *options))
    assert answer.code == 3
    assert "its process was ended" in answer.err
    assert len(list(out.rglob("run.json"))) == 1


# --------------------------------------------------------------------- interrupted
def _wait_for(out: Path, size: int, running: subprocess.Popen[str]) -> Path:
    """The recording of a run that is going on, once it has some size."""
    found: list[Path] = []

    def grown() -> bool:
        files = out.glob("challenge-2020/*+*/**/run.mcap")
        found.extend(file for file in files if file.stat().st_size > size)
        return bool(found)

    wait_until(lambda: running.poll() is not None or grown())
    assert found, f"no recording: {running.communicate()}"
    return found[0]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_interrupted_runs_can_be_read(number: signal.Signals, tmp_path: Path) -> None:
    out = tmp_path / "runs"
    options = ("--planner", "goal_seek", "--no-references", "--record", "all")
    running = process(out, *options, seconds=170.0)
    recording = _wait_for(out, 400_000, running)
    os.kill(running.pid, number)
    answer = finished(running)
    assert answer.code == (130 if number == signal.SIGINT else -signal.SIGKILL)
    assert not list(out.rglob("run.json"))
    assert recording.parent.name == "seed-0.partial"
    run = Recording(recording).trajectories()
    assert run.robot is not None
    assert 1.0 <= run.t[-1] < 170.0
    if number == signal.SIGINT:
        assert "interrupted at" in answer.err
        assert str(recording.parent) in answer.err.replace("\n", "")
