"""Runs one campaign of many short runs and watches memory, files and processes.

Each run has people, and a planner that crowdbot does not know, in a process of its own. For every
process that lives long enough it prints its memory after a tenth of the runs and its largest
afterwards, and at the end what is left: processes, shared memory, temporary files. Ends with 1 if
a process grew by 5 % or more, if something is left, or if a run is missing.

    python benchmarks/soak.py --runs 1000 --jobs 1
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

SUITE, SCENARIO = "challenge-2020", "counter-d0125-dispersed-c20-r05"
PLANNER = '''
class Mine:
    """Drives ahead."""

    needs = ("lidar",)

    def reset(self, task, limits, sensors, seed):
        self.v = limits.v_max

    def step(self, obs):
        return self.v, 0.0
'''
#: What may grow by, and how often is looked, s.
_BOUND, _LOOK = 0.05, 0.5
_PAGE = os.sysconf("SC_PAGE_SIZE")


class Look(NamedTuple):
    """One process at one time: runs that were complete, memory (B), open files, its words."""

    runs: int
    memory: int
    files: int
    words: str


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=0.5, help="simulated time of a run")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "tmp").mkdir()
        (Path(folder) / "mine.py").write_text(PLANNER, encoding="utf-8")
        campaign = subprocess.Popen(
            _command(Path(folder), chosen.runs, chosen.jobs, chosen.seconds),
            env={**os.environ, "TMPDIR": str(Path(folder) / "tmp")},
            stdout=subprocess.DEVNULL,
        )
        seen = _watch(campaign, Path(folder) / "runs", chosen.runs)
        left = _left(seen, Path(folder) / "tmp")
        there = _complete(Path(folder) / "runs")
    grew = _print(seen, chosen.runs // 10)
    print(
        f"{there} of {chosen.runs} runs, exit code {campaign.returncode}; left: {left or 'nothing'}"
    )
    return int(bool(grew or left != "nothing" or there != chosen.runs or campaign.returncode))


def _command(folder: Path, runs: int, jobs: int, seconds: float) -> list[str]:
    return [
        sys.executable, "-m", "crowdbot", "campaign", SUITE, "--only", SCENARIO + "*",
        "--planner", f"{folder}/mine.py:Mine", "--seeds", f"0..{runs - 1}", "--jobs", str(jobs),
        "--no-floors", "--no-replay", "--quiet", "--out", str(folder / "runs"),
        "--set", f"robots.robot.task.time_limit={seconds:g} s",
    ]  # fmt: skip


def _watch(campaign: subprocess.Popen[bytes], out: Path, runs: int) -> dict[int, list[Look]]:
    """What each process of the campaign looked like, until it ended."""
    seen: dict[int, list[Look]] = defaultdict(list)
    values = 0
    while campaign.poll() is None:
        done = _complete(out)
        for pid in _tree(campaign.pid):
            look = _look(pid, done)
            if look is not None:
                seen[pid].append(look)
        if done >= values + max(1, runs // 10):
            values = done
            print(f"{done} runs", file=sys.stderr, flush=True)
        time.sleep(_LOOK)
    return seen


def _complete(out: Path) -> int:
    """Runs that are complete, without those for comparison."""
    try:
        records = list(out.glob(f"{SUITE}/*/*/*/run.json"))
    except FileNotFoundError:  # a folder got its final name meanwhile
        return _complete(out)
    return sum(1 for file in records if not file.parent.name.endswith(".partial"))


def _tree(root: int) -> list[int]:
    """A process and all below it."""
    children: dict[int, list[int]] = defaultdict(list)
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text(errors="replace").rpartition(")")[2].split()
        except OSError:
            continue
        children[int(fields[1])].append(int(folder.name))
    found, todo = [], [root]
    while todo:
        found.append(todo.pop())
        todo += children[found[-1]]
    return found


def _look(pid: int, runs: int) -> Look | None:
    try:
        folder = Path(f"/proc/{pid}")
        memory = int((folder / "statm").read_text().split()[1]) * _PAGE
        words = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        return Look(runs, memory, len(list((folder / "fd").iterdir())), words)
    except (OSError, IndexError):  # it ended meanwhile
        return None


def _left(seen: dict[int, list[Look]], temporary: Path) -> str:
    """What the campaign should have taken away with it."""
    time.sleep(1.0)
    alive = [str(p) for p in seen if (look := _look(p, 0)) and look.words == seen[p][-1].words]
    files = [p.name for p in temporary.iterdir()]
    return ", ".join([*(f"process {p}" for p in alive), *files]) or "nothing"


def _print(seen: dict[int, list[Look]], first: int) -> bool:
    """The table of processes that lived long; whether one of them grew too much."""
    print(
        f"{'process':>8} {'what':<12} {'runs':>11} {'MB then':>8} {'MB most':>8} {'grew':>6} files"
    )
    grew = False
    for pid, looks in seen.items():
        begin, end = looks[0].runs, looks[-1].runs
        base = [x for x in looks if begin + first // 2 <= x.runs <= begin + first]
        later = [x for x in looks if x.runs > begin + first]
        if not base or not later:
            continue
        then, most = max(x.memory for x in base), max(x.memory for x in later)
        growth = most / then - 1.0
        grew |= growth >= _BOUND or max(x.files for x in later) > max(x.files for x in base) + 2
        print(
            f"{pid:>8} {_kind(looks[-1].words):<12} {begin:>5}-{end:<5} {then / 1e6:>8.1f} "
            f"{most / 1e6:>8.1f} {growth:>6.1%} {base[-1].files}-{max(x.files for x in later)}"
        )
    return grew


def _kind(words: str) -> str:
    for part, name in (("worker_main", "worker"), ("fork_server", "fork server")):
        if part in words:
            return name
    return "campaign" if " campaign " in words else "other"


if __name__ == "__main__":
    sys.exit(main())
