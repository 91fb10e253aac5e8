"""Planners in their own process, from the command line: equal trajectories, kills, programs."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

import pytest

from crowdbot.core.recording.recording import Recording
from tests.cli.campaign_cases import start
from tests.cli.simulate_cases import FILES, Shell, finished, planner_file, process
from tests.core.planning.process.process_cases import below, is_alive
from tests.core.planning.process.test_foreign import EXAMPLES, FILE, bare_python
from tests.waiting import AT_MOST, wait_until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="reads /proc"),
]
QUIET = ("--no-references", "--record", "none", "--json")
WEAVES = """nearest = min(r.values.min() for r in obs.readings.values() if r.values.size > 9)
        obs.log('mine/nearest', min(float(nearest), 99.0))
        return (0.1 + 0.01 * min(nearest, 9.0), 0.3 - obs.pose.yaw)"""


def test_the_same_logic_has_the_same_trajectory_inside_and_apart(
    shell: Shell, tmp_path: Path
) -> None:
    planner = planner_file(tmp_path, WEAVES, needs="('lidar',)")
    apart = shell("--planner", planner, *QUIET).json
    inside = shell("--planner", planner, "--in-process", *QUIET).json
    assert (apart["planner_process"], inside["planner_process"]) == ("own", "in_process")
    assert apart["run_id"] == inside["run_id"]
    assert apart["hashes"] == inside["hashes"]
    assert inside["reused"] is False
    bare_python(tmp_path)
    (tmp_path / "full.yaml").write_text(f"python: {sys.executable}\nplanner: mine.py:Mine\n")
    foreign = shell("--planner", str(tmp_path / "full.yaml"), *QUIET).json
    assert foreign["hashes"]["trajectory"] == inside["hashes"]["trajectory"]


def test_ours_have_the_same_trajectory_inside_and_apart(shell: Shell) -> None:
    inside = shell("--planner", "stop_and_go", *QUIET).json
    apart = shell("--planner", "stop_and_go", "--own-process", *QUIET).json
    assert (inside["planner_process"], apart["planner_process"]) == ("in_process", "own")
    assert inside["hashes"] == apart["hashes"]


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_a_planner_in_c_drives_like_ours(shell: Shell, tmp_path: Path) -> None:
    for file in EXAMPLES.iterdir():
        shutil.copy(file, tmp_path)
    subprocess.run(["cc", "-O2", "-o", "goal_seek", "goal_seek.c", "-lm"], cwd=tmp_path, check=True)
    program = shell("--planner", str(tmp_path / "goal_seek.yaml"), *QUIET).json
    ours = shell("--planner", "goal_seek", *QUIET).json
    assert program["hashes"]["trajectory"] == ours["hashes"]["trajectory"]
    assert program["planner"]["kind"] == "goal_seek.yaml:goal_seek_c"


def test_memory_is_part_of_what_a_run_is(shell: Shell, tmp_path: Path) -> None:
    planner = planner_file(tmp_path)
    usual = shell("--planner", planner, *QUIET).json
    more = shell("--planner", planner, "--planner-memory", "6", *QUIET).json
    assert "planner_memory" not in usual
    assert more["planner_memory"] == 6 << 30
    assert more["run_id"] != usual["run_id"]
    assert shell("--planner", planner, "--planner-memory", "0.1").code == 2


def test_inside_is_told_where_others_see_it(shell: Shell, tmp_path: Path) -> None:
    answer = shell("--planner", planner_file(tmp_path), "--in-process", "--no-references")
    assert "in process" in answer.out.replace("\n", " ")
    (page,) = shell.out.rglob("replay.html")
    assert "inside the simulator, where nothing contains it" in page.read_text()


ENDLESS = """open(os.path.expanduser('~/{name}'), 'a').write(f'{{os.getpid()}}\\n')
        return (0.2, 0.0)"""


def _endless(folder: Path) -> str:
    """A planner that writes the number of its process into its home at each step."""
    return planner_file(folder, ENDLESS.format(name=_name(folder)))


def _name(folder: Path) -> str:
    return str(folder).replace("/", "-")


def _driving(
    running: subprocess.Popen[str], folder: Path, steps: int = 1, other_than: int = 0
) -> int:
    """The process of that planner, once it has made some steps."""
    written: list[int] = []

    def grown() -> bool:
        written.clear()
        for file in Path(tempfile.gettempdir()).glob(f"crowdbot-planner-*/*/{_name(folder)}"):
            with suppress(OSError):  # its home is deleted when it ends
                written.extend(map(int, file.read_text().split()))
        written[:] = [pid for pid in written if pid != other_than]
        return len(written) >= steps

    wait_until(lambda: grown() or running.poll() is not None)
    assert written, f"no step: {running.communicate()}"
    return written[-1]


def test_the_planner_is_killed(tmp_path: Path) -> None:
    running = process(tmp_path / "runs", "--planner", _endless(tmp_path), *QUIET, seconds=170.0)
    victim = _driving(running, tmp_path)
    os.kill(victim, signal.SIGKILL)
    answer = finished(running)
    assert answer.code == 3
    assert "signal 9 (SIGKILL)" in answer.json["reason"]
    assert {p.name for p in Path(answer.json["directory"]).iterdir()} == FILES
    assert not is_alive(victim)


def test_the_simulator_is_killed(tmp_path: Path) -> None:
    out = tmp_path / "runs"
    running = process(out, "--planner", _endless(tmp_path), *QUIET, seconds=170.0)
    driving = _driving(running, tmp_path, steps=17)
    everything = below(running.pid)
    assert driving in everything
    os.kill(running.pid, signal.SIGKILL)
    running.communicate(timeout=AT_MOST)
    wait_until(lambda: not any(map(is_alive, everything)))
    assert not list(out.rglob("run.json"))
    (recording,) = out.rglob("run.mcap")
    assert Recording(recording).trajectories().robot is not None


def test_a_worker_is_killed(tmp_path: Path) -> None:
    """Its planner ends with it, another one makes the run, and nothing is lost."""
    only = ["--only", "in-d0125-slow-c01-r02", "--set", "robots.robot.task.time_limit=6 s"]
    running = start(tmp_path / "runs", *only, "--planner", _endless(tmp_path), "--json")
    victim = _driving(running, tmp_path)
    (worker,) = (w for w in below(running.pid) if _parent(w) == running.pid and victim in below(w))
    os.kill(worker, signal.SIGKILL)
    wait_until(lambda: not is_alive(victim))
    other = _driving(running, tmp_path, other_than=victim)
    output, err = running.communicate(timeout=AT_MOST)
    assert running.returncode == 0, err
    assert json.loads(output)["statuses"] == {"timeout": 1}
    assert not is_alive(other)


def _parent(pid: int) -> int:
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def test_a_hostile_planner_stops_no_campaign(tmp_path: Path) -> None:
    """One that dies while it is imported, beside one of another Python that drives."""
    (tmp_path / "dies.py").write_text(f"import os; os._exit(3)\n{FILE}")
    planner_file(tmp_path)
    bare_python(tmp_path)
    (tmp_path / "good.yaml").write_text("python: ./bare_python\nplanner: mine.py:Mine\n")
    argv = ["--planner", f"{tmp_path}/dies.py:Mine", "--planner-memory", "3"]
    argv += ["--planner", str(tmp_path / "good.yaml")]
    (tmp_path / "good.yaml").write_text(
        "python: ./bare_python\nplanner: mine.py:Mine\nname: good\n"
    )
    running = start(tmp_path / "runs", "--only", "in-d0125-slow-c01-r02", *argv, "--json")
    output, err = running.communicate(timeout=AT_MOST)
    assert running.returncode == 3, err
    assert json.loads(output)["statuses"] == {"planner_failed": 1, "timeout": 1}
    (record,) = (tmp_path / "runs").rglob("Mine/seed-0/run.json")
    assert "its process ended with exit code 3" in json.loads(record.read_text())["reason"]
