"""What a run costs at one commit, as a ratio to what it costs at another.

Checks out both into folders of their own, and simulates the same run with each by turns, with this
Python and its libraries. Prints processor time of all processes, start included, and the ratio of
the medians and of the best. Kernels are compiled before, which is not counted.

    python benchmarks/two_commits.py BEFORE AFTER --seconds 20 --rounds 5
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

ROOT = Path(__file__).resolve().parent.parent
RUN = ("challenge-2020", "counter-d0250-dispersed-c20-r05", "--planner", "dwa", "--no-references")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("before")
    parser.add_argument("after", nargs="?", default="HEAD")
    parser.add_argument("--seconds", type=float, default=20.0, help="simulated time of a run")
    parser.add_argument("--rounds", type=int, default=5)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        places = [_checked_out(c, Path(folder) / str(n))
                  for n, c in enumerate((chosen.before, chosen.after))]  # fmt: skip
        for place in places:
            _run(place, 1.0)
        times = [[_run(place, chosen.seconds) for place in places] for _ in range(chosen.rounds)]
    before, after = ([row[n] for row in times] for n in (0, 1))
    a, b = median(before), median(after)
    print(
        f"{chosen.before} {a:.2f} s, {chosen.after} {b:.2f} s of processor time: "
        f"ratio {b / a:.3f}, best {min(after) / min(before):.3f}; load {os.getloadavg()[0]:.0f}"
    )


def _checked_out(commit: str, folder: Path) -> Path:
    """The files of a commit in a new folder."""
    folder.mkdir()
    archive = subprocess.run(
        ["git", "archive", commit], cwd=ROOT, stdout=subprocess.PIPE, check=True
    ).stdout
    subprocess.run(["tar", "x"], cwd=folder, input=archive, check=True)
    return folder


def _run(place: Path, seconds: float) -> float:
    """Processor time of one run, s."""
    before = _processor_time()
    subprocess.run(
        [sys.executable, "-m", "crowdbot", "simulate", *RUN, "--force", "--out", "runs",
         "--set", f"robots.robot.task.time_limit={seconds:g} s"],
        cwd=place, env={**os.environ, "PYTHONPATH": str(place), "OMP_NUM_THREADS": "1"},
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True,
    )  # fmt: skip
    return _processor_time() - before


def _processor_time() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
