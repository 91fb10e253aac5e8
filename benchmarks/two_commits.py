"""What a run costs at one commit, as a ratio to what it costs at another.

Checks out both into folders of their own, and simulates the same run with each by turns, with this
Python and its libraries. Prints processor time of all processes, start included, the ratio of the
medians and of the best, and whether both drove the same way: where they did not, the ratio is not
one of cost alone. A run of the whole length comes before and is not counted, since kernels are
compiled when they are first called.

    python benchmarks/two_commits.py BEFORE AFTER --seconds 20 --rounds 5
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
RUN = ("challenge-2020", "counter-d0250-dispersed-c20-r05", "--no-references", "--force")
#: A planner may take two minutes to compile; a busy machine needs several times as long, and goes
#: on where it was.
WARM = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("before")
    parser.add_argument("after", nargs="?", default="HEAD")
    parser.add_argument("--seconds", type=float, default=20.0, help="simulated time of a run")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--planner", default="dwa")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        places = [_checked_out(c, Path(folder) / str(n))
                  for n, c in enumerate((chosen.before, chosen.after))]  # fmt: skip
        for place in places:
            _warm(place, chosen.planner, chosen.seconds)
        times = [[0.0, 0.0] for _ in range(chosen.rounds)]
        for number, row in enumerate(times):
            for n in (0, 1) if number % 2 == 0 else (1, 0):
                row[n] = _run(places[n], chosen.planner, chosen.seconds)
            print(f"round {number + 1}: {row[0]:.2f} s, {row[1]:.2f} s", flush=True)
        hashes = [_trajectory(place) for place in places]
    before, after = ([row[n] for row in times] for n in (0, 1))
    a, b = median(before), median(after)
    print(
        f"{chosen.before} {a:.2f} s, {chosen.after} {b:.2f} s of processor time: "
        f"ratio {b / a:.3f}, best {min(after) / min(before):.3f}; "
        f"{'equal' if hashes[0] == hashes[1] else 'other'} trajectories; "
        f"load {os.getloadavg()[0]:.0f}"
    )


def _checked_out(commit: str, folder: Path) -> Path:
    """The files of a commit in a new folder."""
    folder.mkdir()
    archive = subprocess.run(
        ["git", "archive", commit], cwd=ROOT, stdout=subprocess.PIPE, check=True
    ).stdout
    subprocess.run(["tar", "x"], cwd=folder, input=archive, check=True)
    return folder


def _warm(place: Path, planner: str, seconds: float) -> None:
    """Compile everything that such a run calls."""
    for left in reversed(range(WARM)):
        try:
            _run(place, planner, seconds)
            return
        except subprocess.CalledProcessError as failed:
            if left == 0:
                sys.exit(f"the run failed with {failed.returncode}:\n{failed.stderr[-2000:]}")


def _run(place: Path, planner: str, seconds: float) -> float:
    """Processor time of one run, s."""
    before = _processor_time()
    subprocess.run(
        [sys.executable, "-m", "crowdbot", "simulate", *RUN, "--planner", planner, "--out", "runs",
         "--set", f"robots.robot.task.time_limit={seconds:g} s"],
        cwd=place, env={**os.environ, "PYTHONPATH": str(place), "OMP_NUM_THREADS": "1"},
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=True,
    )  # fmt: skip
    return _processor_time() - before


def _trajectory(place: Path) -> str:
    """Hash of the last run's trajectory."""
    (file,) = (place / "runs").glob("**/run.json")
    return str(json.loads(file.read_text())["hashes"]["trajectory"])


def _processor_time() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
