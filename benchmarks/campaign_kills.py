"""Kills processes of a campaign at random moments and compares its end with an undisturbed one.

    python benchmarks/campaign_kills.py [--kills 10] [--seconds 20] [--seed 1] [--jobs 2]

Four times so many SIGKILLs: of the campaign itself, after it has made at least one run more, which
is then started again and has to keep every run that was complete; of one of its workers; of a
planner, which runs in a process of its own; and of the fork server that started it, or the guard
above. A killed worker is replaced and loses nothing. A killed planner has failed, with the signal
by name, or with its server; such runs are made again in the end, by `--force`.
Ends with 1 when a trajectory hash or a score differs, scores of wall time left out, when a run is
missing or does not say what happened, or when a process is left.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path

PLANNER = """
class Mine:
    needs = ("lidar",)

    def reset(self, task, limits, sensors, seed):
        self.v = limits.v_max

    def step(self, obs):
        return self.v, 0.0
"""
#: Most seconds that what was killed may leave a process behind.
_GOES = 4.0
#: What a run says of a planner that was killed, alone or with its server.
_KILLED = ("SIGKILL", "with it the one that had started it")
Runs = dict[str, tuple[str, str]]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=10)
    # Shorter runs end before their planner is old enough to be killed.
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    chosen = parser.parse_args()
    draw = random.Random(chosen.seed)
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "mine.py").write_text(PLANNER, encoding="utf-8")

        def start(name: str, *more: str) -> subprocess.Popen[bytes]:
            return _start(root / name, root / "mine.py", chosen.seconds, chosen.jobs, *more)

        start("warm").wait()  # compiles, so that the next one takes its usual time
        began = time.monotonic()
        if start("whole").wait() != 0:
            print("the undisturbed campaign failed")
            return 1
        length, whole = time.monotonic() - began, outcome(root / "whole")
        wrong = kill_parents(start, draw, chosen.kills, length, root)
        for what in (_workers, _planners, _servers):
            wrong += kill_parts(what, start, draw, chosen.kills, length, root)
        for name in ("parent", "workers", "planners", "servers"):
            if outcome(root / name) != whole:
                wrong.append(f"{name}: runs differ")
    print(f"{len(whole)} runs; {'; '.join(wrong) or 'nothing lost, all equal, no process left'}")
    return int(bool(wrong))


Start = Callable[..., subprocess.Popen[bytes]]


def kill_parents(
    start: Start, draw: random.Random, kills: int, length: float, root: Path
) -> list[str]:
    """Kill the campaign itself, time after time, and let it end; what is wrong."""
    wrong, out, kept = [], root / "parent", 0
    runs = len(outcome(root / "whole"))
    for number in range(kills):
        if len(_stamps(out)) >= runs - 1:  # nothing would be left to be disturbed
            wrong += [] if start("parent").wait() == 0 else ["the campaign did not end well"]
            wrong += [] if outcome(out) == outcome(root / "whole") else ["parent: runs differ"]
            shutil.rmtree(out)
        before = _stamps(out)
        running = start("parent")
        while running.poll() is None and len(_stamps(out)) <= len(before):
            time.sleep(0.02)
        time.sleep(draw.uniform(0.0, length / runs))
        everything = _below(running.pid)
        running.kill()  # unless it has ended meanwhile
        running.wait()
        if left := _left(everything):
            wrong.append(f"kill {number + 1} of the campaign left {left}")
        after = _stamps(out)
        wrong += [f"{name} was made again" for name in before if after.get(name) != before[name]]
        same = sum(after.get(name) == stamp for name, stamp in before.items())
        kept += same
        print(f"campaign, kill {number + 1}: {same} of {len(before)} complete runs kept, "
              f"{len(after) - len(before)} new", flush=True)  # fmt: skip
    print(f"campaign: {kept} complete runs found and kept after {kills} kills", flush=True)
    if start("parent").wait() != 0:
        wrong.append("the campaign did not end well")
    return wrong + ([] if kept else ["no kill came late enough: nothing was there to be kept"])


def _stamps(out: Path) -> dict[str, tuple[int, int]]:
    """Complete run -> its record's inode and time of writing: who makes it again changes them."""
    found = {}
    for name, file in _complete(out):
        state = file.stat()
        found[name] = state.st_ino, state.st_mtime_ns
    return found


def kill_parts(
    what: Callable[[int], list[int]], start: Start, draw: random.Random, kills: int, length: float,
    root: Path,
) -> list[str]:  # fmt: skip
    """Kill workers, or planners, of campaigns that go on; what is wrong.

    Two kills fall into one campaign, since a job whose worker died three times is given up.
    """
    name, wrong, done = what.__name__.strip("_"), [], 0
    while done < kills:
        running, everything = start(name, "--force"), dict[int, str]()
        for _ in range(2):
            until = time.monotonic() + draw.uniform(0.1, 0.8) * length
            while running.poll() is None and (time.monotonic() < until or not what(running.pid)):
                everything |= _below(running.pid)
                time.sleep(0.02)
            for victim in what(running.pid)[:1]:
                os.kill(victim, signal.SIGKILL)
                done += 1
                print(f"{name}, kill {done}: process {victim}", flush=True)
        code = running.wait()
        wrong += _told(root / name, what is not _workers, code)
        if left := _left(everything):
            wrong.append(f"kills of {name} left {left}")
    again = [] if what is _workers else ["--force"]  # a failed run is a complete one
    if start(name, *again).wait() != 0:
        wrong.append(f"the last campaign of {name} failed")
    return wrong


def _told(out: Path, planners: bool, code: int) -> list[str]:
    """What a campaign with kills does not say as it should."""
    records = [json.loads(f.read_text()) for f in out.glob("challenge-2020/*/*/*/run.json")]
    failed = [r for r in records if r["status"] == "planner_failed"]
    mute = [r["reason"] for r in failed if not any(how in r["reason"] for how in _KILLED)]
    wrong = [f"reason of a killed planner: {reason}" for reason in mute]
    if failed and not planners:
        wrong.append(f"{len(failed)} planners failed where workers were killed")
    if code != (3 if failed else 0):
        wrong.append(f"exit code {code} with {len(failed)} failed planners")
    return wrong


def _workers(campaign: int) -> list[int]:
    """Processes that simulate."""
    return [pid for pid, words in _below(campaign).items() if "worker_main" in words]


def _planners(campaign: int) -> list[int]:
    """Children of fork servers that were not forked just now."""
    below = _below(campaign)
    servers = set(_forked(below, set(_guards(below))))
    return [pid for pid in _forked(below, servers) if _age(pid) > 0.2]


def _servers(campaign: int) -> list[int]:
    """Fork servers with a planner, and the guards above them, in random order."""
    below = _below(campaign)
    guards = set(_guards(below))
    busy = [s for s in _forked(below, guards) if _forked(below, {s})]
    found = [*busy, *(_parent(s) for s in busy)]
    random.shuffle(found)
    return found


def _guards(below: dict[int, str]) -> list[int]:
    """Processes above fork servers: they were not forked, but started."""
    ours = {pid for pid, words in below.items() if "fork_server" in words}
    return [pid for pid in ours if _parent(pid) not in ours]


def _forked(below: dict[int, str], parents: set[int]) -> list[int]:
    return [pid for pid in below if _parent(pid) in parents]


def _below(root: int) -> dict[int, str]:
    """All processes below one, and their words."""
    children: dict[int, list[int]] = defaultdict(list)
    for folder in Path("/proc").glob("[0-9]*"):
        children[_parent(int(folder.name))].append(int(folder.name))
    found, todo = dict[int, str](), list(children[root])
    while todo:
        pid = todo.pop()
        found[pid] = _words(pid)
        todo += children[pid]
    return found


def _left(processes: dict[int, str]) -> list[int]:
    """Those that are still there a while later."""
    until = time.monotonic() + _GOES
    while True:
        left = [pid for pid, words in processes.items() if words and _words(pid) == words]
        if not left or time.monotonic() > until:
            return left
        time.sleep(0.1)


def _fields(pid: int) -> list[str]:
    try:
        return Path(f"/proc/{pid}/stat").read_text(errors="replace").rpartition(")")[2].split()
    except OSError:
        return []


def _parent(pid: int) -> int:
    fields = _fields(pid)
    return int(fields[1]) if fields and fields[0] != "Z" else 0


def _age(pid: int) -> float:
    """Seconds since it began."""
    fields = _fields(pid)
    began = int(fields[19]) / os.sysconf("SC_CLK_TCK") if fields else float("inf")
    return time.clock_gettime(time.CLOCK_BOOTTIME) - began


def _words(pid: int) -> str:
    """What it was started with; empty where it is gone, or only waits to be reaped."""
    if _parent(pid) == 0:
        return ""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace")
    except OSError:
        return ""


def _start(
    out: Path, planner: Path, seconds: float, jobs: int, *more: str
) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "crowdbot", "campaign", "challenge-2020", "--planner",
               f"{planner}:Mine", "--only", "in-d0125-slow-*", "--jobs", str(jobs), "--quiet",
               "--no-floors", "--no-replay", "--out", str(out),
               "--set", f"robots.robot.task.time_limit={seconds:g} s", *more]  # fmt: skip
    return subprocess.Popen(command)


def outcome(out: Path) -> Runs:
    """Run -> trajectory hash and scores."""
    found = {}
    for name, file in _complete(out):
        lines = (file.parent / "scores.csv").read_text().splitlines()
        scores = "\n".join(line for line in lines if "planner_time" not in line)
        found[name] = (json.loads(file.read_text())["hashes"]["trajectory"], scores)
    return found


def _complete(out: Path) -> Iterator[tuple[str, Path]]:
    """Yield name and record of each complete run; a folder may be named otherwise by versions."""
    for file in sorted(out.glob("challenge-2020/*/*/*/run.json")):
        if not file.parent.name.endswith(".partial"):
            scenario = json.loads(file.read_text())["scenario"]
            yield "/".join((scenario, *file.parent.parts[-2:])), file


if __name__ == "__main__":
    sys.exit(main())
