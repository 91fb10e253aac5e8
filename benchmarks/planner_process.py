"""What it costs that a planner runs in a process of its own.

Runs a planner that reads two lidars at 16 Hz in a scenario of the challenge, by turns inside the
simulator and in a process of its own, and prints processor time of all processes and wall time,
start of the planner's process included, and their ratio.

    python benchmarks/planner_process.py --seconds 60 --rounds 3
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

SPEC = ("challenge-2020", "counter-d0250-dispersed-c20-r05")
PLANNER = '''
import numpy as np
from crowdbot.plugin import Command, LidarPoints

class Mine:
    """Drives, and stands where something is near."""

    needs = ("lidar",)

    def reset(self, task, limits, sensors, seed):
        self.points = LidarPoints(sensors)

    def step(self, obs):
        seen = self.points(obs.readings, obs.t, obs.twist)
        near = len(seen) and np.min(np.hypot(seen[:, 0], seen[:, 1])) < 0.6
        return Command(0.0 if near else 0.3, 0.0)
'''
_READY = "from crowdbot.cli import main; import sys; sys.exit(main())"


def run(planner: str, place: str, seconds: float, out: Path) -> tuple[float, float, str]:
    """Processor time and wall time of one run, s, and its trajectory's hash."""
    before, begin = _processor_time(), time.perf_counter()
    done = subprocess.run(
        [
            sys.executable, "-c", _READY, "simulate", *SPEC, "--planner", planner, place,
            "--set", f"robots.robot.task.time_limit={seconds:g} s", "--no-references",
            "--force", "--json", "--out", str(out),
        ],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True,
    )  # fmt: skip
    wall, cpu = time.perf_counter() - begin, _processor_time() - before
    return cpu, wall, str(json.loads(done.stdout)["hashes"]["trajectory"])


def _processor_time() -> float:
    """Of all children that ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated time of a run")
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mine.py"
        file.write_text(PLANNER, encoding="utf-8")
        planner, out = f"{file}:Mine", Path(folder) / "runs"
        run(planner, "--in-process", 1.0, out)  # compiles kernels
        inside, apart = [], []
        for _ in range(args.rounds):
            inside.append(run(planner, "--in-process", args.seconds, out))
            apart.append(run(planner, "--own-process", args.seconds, out))
    assert len({trajectory for _, _, trajectory in (*inside, *apart)}) == 1
    _print("processor time", [r[0] for r in inside], [r[0] for r in apart])
    _print("wall time", [r[1] for r in inside], [r[1] for r in apart])


def _print(name: str, inside: list[float], apart: list[float]) -> None:
    a, b = median(inside), median(apart)
    least = min(apart) / min(inside)
    print(f"{name}: inside {a:.2f} s, own process {b:.2f} s, ratio {b / a:.3f}, best {least:.3f}")


if __name__ == "__main__":
    main()
