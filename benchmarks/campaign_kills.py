"""Kills a campaign ten times at random moments and compares its end with an undisturbed one.

    python benchmarks/campaign_kills.py [--kills 10] [--seconds 2] [--seed 1]

Ends with 1 when a trajectory hash or a score differs. Scores of wall time are left out.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    draw = random.Random(chosen.seed)
    with tempfile.TemporaryDirectory() as folder:
        whole, killed = Path(folder) / "whole", Path(folder) / "killed"
        began = time.monotonic()
        if _start(whole, chosen.seconds).wait() != 0:
            print("the undisturbed campaign failed")
            return 1
        length = time.monotonic() - began
        for number in range(chosen.kills):
            running = _start(killed, chosen.seconds)
            time.sleep(draw.uniform(0.0, length))
            os.kill(running.pid, signal.SIGKILL)
            running.wait()
            print(f"kill {number + 1}: {len(outcome(killed))} runs there", flush=True)
        ended = _start(killed, chosen.seconds).wait()
        same = ended == 0 and outcome(killed) == outcome(whole)
        print(f"{len(outcome(whole))} runs, {'all equal' if same else 'DIFFERENT'}")
        return 0 if same else 1


def _start(out: Path, seconds: float) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "crowdbot", "campaign", "challenge-2020", "--planner",
               "goal_seek", "--only", "in-d0125-slow-*", "--jobs", "2", "--quiet", "--out",
               str(out), "--set", f"robots.robot.task.time_limit={seconds:g} s"]  # fmt: skip
    return subprocess.Popen(command)


def outcome(out: Path) -> dict[str, tuple[str, str]]:
    """Run -> trajectory hash and scores."""
    found = {}
    for file in sorted(out.glob("challenge-2020/*/*/*/run.json")):
        if file.parent.name.endswith(".partial"):
            continue
        lines = (file.parent / "scores.csv").read_text().splitlines()
        scores = "\n".join(line for line in lines if "planner_time" not in line)
        name = file.parent.relative_to(out).as_posix()
        found[name] = (json.loads(file.read_text())["hashes"]["trajectory"], scores)
    return found


if __name__ == "__main__":
    sys.exit(main())
