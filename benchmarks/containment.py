"""Measure what containment by the kernel costs: start and end of a planner, and a run.

Each is measured by turns with containment and without (CROWDBOT_LANDLOCK=0), in processor time of
all processes, since wall time depends on what else the machine does. A planner should start at most
5 ms later.

    python benchmarks/containment.py --starts 100 --seconds 60 --rounds 3
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

SPEC = ("challenge-2020", "counter-d0250-dispersed-c20-r05")
PLANNER = """
class Mine:
    needs = ("lidar",)

    def reset(self, task, limits, sensors, seed):
        pass

    def step(self, obs):
        return 0.3, 0.0
"""
#: Starts and ends a planner some times, in one process, after a first time.
_STARTS = """
import resource, sys, time
from crowdbot.core.planning.process.server_handle import POOL
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover

def used():
    own = resource.getrusage(resource.RUSAGE_SELF)
    others = resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime

choice = resolve_planner(sys.argv[1], discover(allow=()))
begin = used(), time.perf_counter()
for _ in range(int(sys.argv[2])):
    choice.build().close()
wall = time.perf_counter() - begin[1]
POOL.close()  # the server's time counts when it has ended
print(1e3 * (used() - begin[0]) / int(sys.argv[2]), 1e3 * wall / int(sys.argv[2]))
"""
_WAYS = {"contained": {}, "not contained": {"CROWDBOT_LANDLOCK": "0"}}


def start(planner: str, way: str, starts: int) -> tuple[float, float]:
    """Return processor time and wall time of a start and an end, ms."""
    done = subprocess.run(
        [sys.executable, "-c", _STARTS, planner, str(starts)],
        env=os.environ | _WAYS[way], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True,
    )  # fmt: skip
    cpu, wall = map(float, done.stdout.split())
    return cpu, wall


def run(planner: str, way: str, seconds: float, out: Path) -> float:
    """Return the processor time of a command with one run, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [
            sys.executable, "-m", "crowdbot", "-q", "simulate", *SPEC, "--planner", planner,
            "--set", f"robots.robot.task.time_limit={seconds:g} s", "--no-references", "--force",
            "--out", str(out),
        ],
        env=os.environ | _WAYS[way], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        check=True,
    )  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print both ways of each measurement."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--starts", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated time of a run")
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mine.py"
        file.write_text(PLANNER, encoding="utf-8")
        planner, out = f"{file}:Mine", Path(folder) / "runs"
        starts = {
            way: [start(planner, way, args.starts) for _ in range(args.rounds)] for way in _WAYS
        }
        for what, part in (("processor", 0), ("wall", 1)):
            _print(
                f"start and end, {what} time, ms",
                {w: [x[part] for x in v] for w, v in starts.items()},
            )
        if args.seconds:
            run(planner, "contained", 1.0, out)  # compiles kernels
            runs: dict[str, list[float]] = {way: [] for way in _WAYS}
            for _ in range(args.rounds):
                for way, found in runs.items():
                    found.append(run(planner, way, args.seconds, out))
            _print(f"run of {args.seconds:g} s, processor time, s", runs)


def _print(what: str, found: dict[str, list[float]]) -> None:
    """Print medians of both ways."""
    a, b = (median(found[way]) for way in _WAYS)
    least = min(found["contained"]) / min(found["not contained"])
    print(
        f"{what}: contained {a:.2f}, not contained {b:.2f}; {a - b:+.2f}, "
        f"ratio {a / b:.3f}, of the best {least:.3f}"
    )


if __name__ == "__main__":
    main()
