"""How far do scores of honest runs differ between processors?

Simulates some scenarios of the challenge once for the processor of this machine and once for a
plain one, which rounds differently, and prints by how much the scores differ: where the
tolerances of crowdbot verify come from (crowdbot/core/bundle/tolerances.py).

    python benchmarks/processor_targets.py --scenarios 9 --planner dwa
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
from crowdbot.core.library import open_spec
from crowdbot.core.scores_table import read_scores_csv

SUITE = "challenge-2020"


def simulate(out: Path, target: str | None, ids: list[str], planner: str) -> None:
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CPU_NAME"}
    if target:
        environment |= {"NUMBA_CPU_NAME": target, "NUMBA_CPU_FEATURES": ""}
    for id_ in ids:
        argv = [sys.executable, "-m", "crowdbot", "-q", "simulate", SUITE, id_, "--record", "none",
                "--planner", planner, "--out", str(out)]  # fmt: skip
        subprocess.run(argv, env=environment, check=True, stdout=subprocess.DEVNULL)


def hash_of(folder: Path) -> str:
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    return str(record["hashes"]["trajectory"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenarios", type=int, default=9)
    parser.add_argument("--planner", default="dwa")
    parser.add_argument("--target", default="generic")
    options = parser.parse_args()
    listed = [s.id for s in open_spec(SUITE, registry()).scenarios]
    ids = listed[:: max(1, len(listed) // options.scenarios)][: options.scenarios]
    with tempfile.TemporaryDirectory() as folder:
        here, there = Path(folder) / "here", Path(folder) / "there"
        simulate(here, None, ids, options.planner)
        simulate(there, options.target, ids, options.planner)
        compare(here, there, ids, options.planner)


def compare(here: Path, there: Path, ids: list[str], planner: str) -> None:
    values: dict[tuple[str, str], list[tuple[float | None, float | None]]] = defaultdict(list)
    equal = 0
    for id_ in ids:
        sides = [root / SUITE / id_ / planner / "seed-0" for root in (here, there)]
        equal += hash_of(sides[0]) == hash_of(sides[1])
        tables = [read_scores_csv(side / "scores.csv") for side in sides]
        for a, b in zip(*tables, strict=True):
            values[a.score.metric, a.score.variant].append((a.score.value, b.score.value))
    print(f"{len(ids)} scenarios, {equal} with equal trajectories")
    print(f"{'metric':34}{'variant':14}{'both':>5}{'one':>5}{'mean |x|':>12}{'bias':>12}{'rms':>12}{'most':>12}")
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
        print(f"{metric:34}{variant:14}{len(both):5}{one:5}{size:12.4g}{bias:12.3g}{rms:12.3g}{most:12.3g}")


if __name__ == "__main__":
    main()
