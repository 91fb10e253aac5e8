"""How far do scores of honest runs differ between processors?

Simulates some scenarios of the challenge as they are, and again in other ways that leave the world
the same and change rounding at most:

- ``generic``: kernels compiled for a plain processor (NUMBA_CPU_NAME), the C library and numpy
  told to do without AVX and fused multiply-add, as on an old machine;
- ``nudge``: the robot starts 1e-9 m beside its start;
- ``seed``: with another seed of sensors and planner: histories that have come apart for good,
  which is the most that rounding can do.

Prints by how much scores differ: where the tolerances of crowdbot verify come from
(crowdbot/core/bundle/tolerances.py).

    python benchmarks/processor_targets.py --scenarios 12 --planner dwa
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from crowdbot.api import registry
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scoring.scores_csv import read_scores_csv

SUITE = "challenge-2020"


PLAIN = {
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable",
    "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3",
}
NUDGE = ["--set", "robots.robot.task.start=[2.5, 0.000000001, 0]"]
#: Way -> environment and options of `crowdbot simulate`.
WAYS: dict[str, tuple[dict[str, str], list[str]]] = {
    "here": ({}, []),
    "generic": (PLAIN, []),
    "nudge": ({}, NUDGE),
    "seed": ({}, ["--seed", "1"]),
}


def simulate(out: Path, way: str, ids: list[str], planner: str) -> None:
    environment, options = WAYS[way]
    for id_ in ids:
        argv = [sys.executable, "-m", "crowdbot", "-q", "simulate", SUITE, id_, "--record", "none",
                "--planner", planner, "--out", str(out), *options]  # fmt: skip
        known = {k: v for k, v in os.environ.items() if k not in PLAIN}
        subprocess.run(argv, env=known | environment, check=True, stdout=subprocess.DEVNULL)


def hash_of(folder: Path) -> str:
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    return str(record["hashes"]["trajectory"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenarios", type=int, default=12)
    parser.add_argument("--planner", default="dwa")
    parser.add_argument("--ways", default="generic,nudge,seed")
    options = parser.parse_args()
    listed = [s.id for s in open_spec(SUITE, registry()).scenarios]
    ids = listed[:: max(1, len(listed) // options.scenarios)][: options.scenarios]
    with tempfile.TemporaryDirectory() as folder:
        for way in ("here", *options.ways.split(",")):
            simulate(Path(folder) / way, way, ids, options.planner)
            if way != "here":
                print(f"\n== {way} ==")
                compare(Path(folder) / "here", Path(folder) / way, options.planner)


def runs_of(root: Path, planner: str) -> dict[str, Path]:
    """Scenario -> folder of its run; what a change appends to the id is left out."""
    found = (root / SUITE).glob(f"*/{planner}/seed-*")
    return {f.parent.parent.name.partition("+")[0]: f for f in sorted(found)}


def compare(here: Path, there: Path, planner: str) -> None:
    values: dict[tuple[str, str], list[tuple[float | None, float | None]]] = defaultdict(list)
    equal = 0
    ids, others = runs_of(here, planner), runs_of(there, planner)
    for id_, folder in ids.items():
        sides = [folder, others[id_]]
        equal += hash_of(sides[0]) == hash_of(sides[1])
        tables = [read_scores_csv(side / "scores.csv") for side in sides]
        for a, b in zip(*tables, strict=True):
            values[a.score.metric, a.score.variant].append((a.score.value, b.score.value))
    print(f"{len(ids)} scenarios, {equal} with equal trajectories")
    heads = "".join(f"{head:>12}" for head in ("mean |x|", "bias", "rms", "most"))
    print(f"{'metric':34}{'variant':14}{'both':>5}{'one':>5}{heads}")
    for (metric, variant), pairs in values.items():
        both = [(a, b) for a, b in pairs if a is not None and b is not None]
        one = sum((a is None) != (b is None) for a, b in pairs)
        if not both:
            continue
        gaps = [b - a for a, b in both]
        size = sum(abs(a) for a, _ in both) / len(both)
        rms = (sum(g * g for g in gaps) / len(gaps)) ** 0.5
        most = max(map(abs, gaps))
        bias = sum(gaps) / len(gaps)
        print(
            f"{metric:34}{variant:14}{len(both):5}{one:5}{size:12.4g}{bias:12.3g}{rms:12.3g}{most:12.3g}"
        )


if __name__ == "__main__":
    main()
