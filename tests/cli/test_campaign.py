"""`crowdbot campaign` and `crowdbot results`, from the command line to the tables."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.cli.shared.campaign_run import read_seeds
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.index_file import INDEX
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.statistics.groups import by_group
from crowdbot.errors import UsageError
from tests.cli.campaign_cases import TINY, outcome, run, start
from tests.core.results.made_up_record import made_up_record
from tests.examples import THOROUGH
from tests.once import once
from tests.waiting import AT_MOST, wait_until

pytestmark = pytest.mark.slow

BAD = """
import ctypes, os, signal
class Base:
    needs = ()
    def reset(self, task, limits, sensors, seed): pass
class Dies(Base):
    def step(self, obs): os.kill(os.getpid(), signal.SIGKILL)
class Hangs(Base):
    def step(self, obs):
        if obs.t > 0.3: ctypes.PyDLL(None).sleep(1000)  # keeps the interpreter lock
        return (0.1, 0.0)
class Raises(Base):
    def step(self, obs): raise ValueError("lost")
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three scenarios, two seeds, undisturbed; a copy of its own for each worker."""

    def make(out: Path) -> None:
        code, summary, err = run(out, "--planner", "goal_seek", "--seeds", "0,1")
        assert code == 0, err
        assert summary["statuses"] == {"timeout": 6}
        assert summary["made"] == 6

    out = tmp_path_factory.mktemp("whole") / "runs"
    shutil.copytree(once(tmp_path_factory, "campaign", make), out)
    return out


def test_references_are_shared_and_replays_left_out(whole: Path) -> None:
    names = sorted(p.name.partition("-")[0] for p in (whole / "references").iterdir())
    assert names == ["crowd_alone"] * 3 + ["robot_alone"] * 2
    assert not list(whole.rglob("replay.html"))
    assert not list(whole.rglob("*.partial"))


def test_a_second_call_runs_nothing_and_needs_no_drake(whole: Path) -> None:
    code = (
        "import sys; from crowdbot.cli import main; "
        f"print(main({['campaign', *TINY, '--planner', 'goal_seek', '--out', str(whole)]!r})); "
        "print('pydrake' in sys.modules, 'numba' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["0", "False", "False"]
    assert "3 runs, 3 complete, 0 jobs" in done.stderr


def test_the_plan_is_printed_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new"
    argv = ["campaign", *TINY, "--planner", "goal_seek", "--seeds", "0..2", "--out", str(out)]
    assert cli.main([*argv, "--dry-run", "--json"]) == 0
    plan = json.loads(capsys.readouterr().out)
    assert (plan["runs"], plan["complete"], plan["to_run"]) == (9, 0, 9)
    assert plan["references"] == plan["references_to_run"] == 6  # 3 crowds, 3 seeds
    assert plan["seconds"] > 0
    assert not out.exists()


def test_results_know_axes_density_and_conditions(whole: Path) -> None:
    results = Results.open(whole)
    assert [r.axes["range"] for r in results.runs] == ["r02", "r02", "r05", "r05", "r10", "r10"]
    assert [r.seed for r in results.runs] == [0, 1, 0, 1, 0, 1]
    first = results.runs[0]
    assert list(first.axes) == ["flow", "density", "speed", "coeff", "range"]
    assert first.density == pytest.approx(0.125, rel=0.1)
    assert first.conditions["rates.planner"] == "16 Hz"
    assert first.conditions["versions.crowdbot"]
    assert first.conditions["processor"]
    assert first.pinned
    assert {s.run_id for s in results.scores} == {r.run_id for r in results.runs}


def test_the_index_can_be_lost_damaged_or_in_use(whole: Path) -> None:
    before = Results.open(whole)
    (whole / INDEX).write_bytes(b"this is not a database" * 100)
    assert Results.open(whole) == before
    for file in whole.glob(f"{INDEX}*"):
        file.unlink()
    assert Results.open(whole) == before
    from crowdbot.core.results.store import index

    with index(whole):
        assert Results.open(whole) == before
    with sqlite3.connect(whole / INDEX) as database:
        assert database.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_questions(
    whole: Path,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def ask(*argv: str) -> Any:
        altered = () if argv[0] == "failures" else ("--altered",)
        assert cli.main(["results", *argv, *altered]) == 0
        return capsys.readouterr().out

    shown = json.loads(
        ask("--out", str(whole), "--metric", "relative_time_to_goal", "--by", "range", "--json")
    )
    assert [(s["range"], s["n"], s["undefined"]) for s in shown] == [
        ("r02", 0, 2), ("r05", 0, 2), ("r10", 0, 2),
    ]  # fmt: skip
    worst = json.loads(
        ask("--out", str(whole), "--metric", "min_clearance", "--worst", "2", "--json")
    )
    assert len(worst) == 2
    assert worst[0]["value"] <= worst[1]["value"]
    monkeypatch.setenv("COLUMNS", "160")
    assert "goal_seek" in ask("--out", str(whole))
    ask("atlas", "--out", str(whole), "--md", str(tmp_path / "atlas.md"))
    assert (tmp_path / "atlas.md").read_text(encoding="utf-8").startswith("# Atlas of scores")
    entries = json.loads(ask("atlas", "--out", str(whole), "--json"))
    assert [e["metric"] for e in entries[:5]] == [
        "safe_efficiency", "acceptance", "contacts_per_km", "push_work", "intrusion",
    ]  # fmt: skip
    assert cli.main(["results", "power", "--out", str(whole), "--altered"]) == 1
    assert "no two planners were run in the same scenario" in capsys.readouterr().err
    with monkeypatch.context() as patched:
        place = "crowdbot.cli.commands.compare.results.open_results"
        patched.setattr(place, lambda *_: _twice(Results.open(whole)))
        powers = json.loads(ask("power", "--out", str(whole), "--size", "0.1", "--json"))
    assert {"planners", "condition", "deviation", "information", "runs_for_0.1"} <= powers[0].keys()
    assert powers[0]["condition"] == "all conditions"
    file = tmp_path / "runs.parquet"
    ask("export", "--out", str(whole), "--parquet", str(file), "--table", "runs")
    import duckdb

    with duckdb.connect() as database:
        query = "SELECT axis_range, density, seed FROM read_parquet(?)"
        rows = database.execute(query, [str(file)]).fetchall()
    assert len(rows) == 6
    assert all(isinstance(r[1], float) and isinstance(r[2], int) for r in rows)
    assert ask("failures", "--out", str(whole)) == "no failures\n"


def _twice(found: Results) -> Results:
    """The same runs by a second planner, too."""
    runs = {run.run_id: replace(run, entry="other") for run in found.runs}
    scores = (replace(s, run_id=runs[s.run_id].run_id) for s in found.scores)
    return replace(found, runs=(*found.runs, *runs.values()), scores=(*found.scores, *scores))


def test_failures_are_on_record_and_stop_nobody(tmp_path: Path) -> None:
    file = tmp_path / "bad.py"
    file.write_text(BAD)
    planners = [f"{file}:{name}" for name in ("Dies", "Hangs", "Raises")]
    argv = [word for name in planners for word in ("--planner", name)]
    only = ["--only", "in-d0125-slow-c01-r02", "--quiet"]
    code, summary, err = run(tmp_path / "runs", *only, *argv, "--planner", "goal_seek")
    assert code == 3
    assert "· Raises · seed 0: planner_failed" in err  # quiet is not mute
    assert "goal_seek" not in err
    assert summary["statuses"] == {"planner_failed": 3, "timeout": 1}
    reasons = {r.planner: r.reason for r in Results.open(tmp_path / "runs").runs}
    assert "its process was ended by signal 9 (SIGKILL)" in reasons["Dies"]
    assert "did not return from step within 10 s; its process was ended" in reasons["Hangs"]
    assert {
        r.planner_process for r in Results.open(tmp_path / "runs").runs if r.planner != "goal_seek"
    } == {"own"}


def test_failures_of_planners_in_the_workers_are_on_record_and_stop_nobody(tmp_path: Path) -> None:
    file = tmp_path / "bad.py"
    file.write_text(BAD)
    planners = [f"{file}:{name}" for name in ("Dies", "Hangs", "Raises")]
    argv = [word for name in planners for word in ("--planner", name)]
    only = ["--only", "in-d0125-slow-c01-r02", "--in-process"]
    code, summary, _ = run(tmp_path / "runs", *only, *argv, "--planner", "goal_seek")
    assert code == 4
    assert summary["statuses"] == {"failed": 2, "planner_failed": 1, "timeout": 1}
    results = Results.open(tmp_path / "runs")
    errors = {f.planner: f.error for f in results.failures}
    assert "died 3 times (signal 9)" in errors["Dies"]
    assert "PlannerHungError" in errors["Hangs"]
    (failed,) = (r for r in results.runs if r.planner == "Raises")
    assert (failed.status, failed.pinned) == ("planner_failed", False)
    code, summary, _ = run(tmp_path / "runs", *only, "--planner", planners[2])
    assert (code, summary["made"]) == (3, 0)


def _descendants(pid: int) -> list[int]:
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            found.append(int(status.parent.name))
    return found


def _alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def _records(out: Path) -> int:
    # Unlike rglob, walk does not mind folders that are renamed meanwhile.
    return sum("run.json" in files for _, _, files in os.walk(out))


def _kill_after(out: Path, wanted: int) -> None:
    """SIGKILL to a campaign that has so many records; its workers end by themselves."""
    running = start(out, "--planner", "goal_seek", "--seeds", "0,1")
    wait_until(lambda: running.poll() is not None or _records(out) >= wanted)
    workers = _descendants(running.pid)
    assert workers
    os.kill(running.pid, signal.SIGKILL)
    running.communicate(timeout=AT_MOST)
    wait_until(lambda: not any(map(_alive, workers)))


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_killed_and_resumed_it_ends_the_same(whole: Path, tmp_path: Path) -> None:
    """SIGKILL to the parent, with jobs under way; no worker survives it."""
    out = tmp_path / "runs"
    for wanted in (2, 5) if THOROUGH else (3,):
        _kill_after(out, wanted)
    code, summary, err = run(out, "--planner", "goal_seek", "--seeds", "0,1")
    assert code == 0, err
    assert summary["made"] < 6 or len(outcome(out)) == 6
    assert outcome(out) == outcome(whole)
    assert len(Results.open(out).runs) == 6


def test_ctrl_c_ends_workers_and_keeps_what_is_finished(tmp_path: Path) -> None:
    out = tmp_path / "runs"
    running = start(out, "--planner", "goal_seek", "--seeds", "0,1")
    wait_until(lambda: running.poll() is not None or _records(out) >= 1)
    workers = _descendants(running.pid)
    os.killpg(running.pid, signal.SIGINT)
    output, err = running.communicate(timeout=AT_MOST)
    assert running.returncode == 130, output + err
    assert "Traceback" not in output + err
    assert "interrupted; the same command makes the runs that are missing" in err
    assert not any(map(_alive, workers))
    assert _records(out) >= 1


@pytest.mark.parametrize(
    ("argv", "code", "text"),
    [
        ([], 2, "which planner"),
        (["--planner", "dwaa"], 1, "did you mean 'dwa'"),
        (["--planner", "dwa", "--only", "nothing*"], 1, "unknown scenario"),
        (["--planner", "dwa", "--seeds", "3..1"], 2, "--seeds"),
        (["--planner", "dwa", "--set", "crowd.flow.density=9"], 1, "people fit"),
        (["--planner", "dwa", "--cluster", "tcp://127.0.0.1:1"], 1, "no Dask scheduler"),
        (["--planner", "dwa", "--cluster", "tcp://no-such-host.invalid:1"], 1, "no Dask scheduler"),
        (["--planner", "dwa", "--cluster", "localhost"], 1, "write tcp://HOST:PORT"),
    ],
)
def test_wrong_input_runs_nothing(
    argv: list[str],
    code: int,
    text: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("crowdbot.core.campaign.dask_pool._LISTENING", 0.5)
    out = tmp_path / "runs"
    few = [] if "--only" in argv else ["--only", "in-d0125-slow-c01-r02", "--no-floors"]
    assert cli.main(["campaign", "challenge-2020", *few, *argv, "--out", str(out)]) == code
    assert text in capsys.readouterr().err
    assert not list(tmp_path.rglob("run.json"))


def test_seeds() -> None:
    assert read_seeds("0,1,2") == [0, 1, 2]
    assert read_seeds("0..3, 7") == [0, 1, 2, 3, 7]
    for text in ("", "a", "1..", "-1", "2..1"):
        with pytest.raises(UsageError):
            read_seeds(text)


def test_tables_of_results_count_failures() -> None:
    """A planner that fails in half of its runs, and one that leaves none."""
    label: dict[str, Any] = {
        "category": "task", "symbol": "S", "variant": "corrected", "unit": "1",
        "better": "higher", "reason": "", "lower": None, "upper": None,
    }  # fmt: skip
    runs = [made_up("a", 0, "arrived"), made_up("a", 1, "planner_failed")]
    scores = [
        ScoreRow(run_id=r.run_id, metric="success", value=v, status="ok", **label)
        for r, v in zip(runs, (1.0, 0.0), strict=True)
    ]
    failures = [
        Failure(suite="s", scenario="x", planner=p, seed=2, error="", traceback="")
        for p in ("a", "b")
    ]
    found = Results(runs=tuple(runs), scores=tuple(scores), failures=tuple(failures))
    summaries = by_group(found, "success", ["planner"])
    assert [(s.group["planner"], s.counts.ok, s.failed) for s in summaries] == [
        ("a", 3, 2),
        ("b", 1, 1),
    ]
    assert summaries[0].mean.value == pytest.approx(1 / 3)
    by_status = {s.group["status"]: s.counts.ok for s in by_group(found, "success", ["status"])}
    assert by_status == {"arrived": 1, "planner_failed": 1, "failed": 2}


def made_up(planner: str, seed: int, status: str) -> RunRow:
    record = made_up_record(
        run_id=f"{planner}{seed}", suite="s", scenario="x", planner=planner, seed=seed,
        status=status, goal_time=None, density=None,
    )  # fmt: skip
    return RunRow(record=record, directory=f"{planner}{seed}")
