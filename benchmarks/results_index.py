"""How long do `crowdbot results` and `crowdbot report` take with many runs?

Makes up run directories of the challenge (records, scenarios, scores of all metrics; no recordings
worth watching), then measures each command twice in processes of their own: without an index, and
with the one that the first call left. Prints seconds of processor time, wall time, the largest
resident memory, and the ratio of both calls.

    python benchmarks/results_index.py --runs 2000
    python benchmarks/results_index.py --runs 50000 --no-report
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.results.index_file import INDEX
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.scenarios.library import open_suite
from crowdbot.core.scoring.score_factory import ScoreFactory
from crowdbot.core.scoring.scores_csv import write_scores_csv
from crowdbot.core.support.json_digest import digest
from crowdbot.core.types.score import Score
from crowdbot.dsl.identity.canonical import dump_scenario_yaml

SUITE = "challenge-2020"
PLANNERS = ("dwa", "stop_and_go", "goal_seek", "mppi")


class Cost(NamedTuple):
    """Seconds of processor time, wall time, and MB of the largest resident memory."""

    cpu: float
    wall: float
    memory: float


def make_up(root: Path, count: int) -> None:
    """Write so many complete run directories."""
    registry = discover(allow=())
    expansion, _ = open_suite(SUITE, registry)
    scenarios = list(expansion.scenarios)
    texts = [dump_scenario_yaml(s, registry.spec_versions(s)) for s in scenarios]
    rng = random.Random(5)
    metrics = registry.components("metric")
    keys = islice(((seed, i, p) for seed in range(10**6) for i in range(len(scenarios))
                   for p in PLANNERS), count)  # fmt: skip
    for seed, i, planner in keys:
        scenario = scenarios[i]
        folder = root / SUITE / scenario.id / planner / f"seed-{seed}"
        folder.mkdir(parents=True)
        (folder / files.SCENARIO).write_text(texts[i], encoding="utf-8")
        (folder / files.RECORDING).write_bytes(b"made up")
        scores = list(_scores(metrics, rng))
        write_scores_csv(folder / files.SCORES, scores, scenario.id, planner, seed)
        record = _record(scenario.id, planner, seed, expansion.axes.get(scenario.id, {}), registry)
        record |= {"files": files.sizes(folder), "digests": files.digests(folder)}
        files.write_json(folder / files.RECORD, record)


def _scores(metrics: Any, rng: random.Random) -> Sequence[Score]:
    pairs = [(ScoreFactory(metric), v) for metric in metrics.values() for v in metric.variants]
    return [
        factory.ok(variant, round(rng.random(), 6))
        if rng.random() < 0.9
        else factory.undefined(variant, "nobody_near")
        for factory, variant in pairs
    ]


def _record(
    scenario: str, planner: str, seed: int, axes: Any, registry: Registry
) -> dict[str, Any]:
    identity: dict[str, Any] = {
        "scenario": scenario, "suite": SUITE,
        "planner": {"kind": planner, "name": planner, "label": planner}, "seed": seed,
        "hashes": {"spec": _hash(scenario), "realisation": _hash(scenario)},
        "versions": provenance.versions(), "plugins": [],
    }  # fmt: skip
    versions = {n: {"spec_version": m.spec_version}
                for n, m in registry.components("metric").items()}  # fmt: skip
    return {
        "run_id": digest(identity), **identity,
        "hashes": {**identity["hashes"], "trajectory": _hash(f"{scenario} {planner} {seed}")},
        "pinned": True, "privileged": False, "status": "arrived", "goal_time": 50.0, "reason": "",
        "sim_time": 60.0, "wall_time": 4.0, "metrics": versions, "density": 0.1,
        "reference_hashes": {}, "machine": provenance.machine(), "references": {},
        "axes": dict(axes), "crowd": "",
    }  # fmt: skip


def _hash(text: str) -> str:
    return f"cb1-sha256:{hashlib.sha256(text.encode()).hexdigest()}"


def measure(words: Sequence[str], folder: Path) -> Cost:
    """Return the cost of a command line in a process of its own."""
    begin = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-m", "crowdbot", *words], cwd=folder, stdout=subprocess.DEVNULL
    ) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - begin
    if process.returncode:
        raise SystemExit(f"{' '.join(words)}: exit code {process.returncode}")
    return Cost(usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024.0)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--folder", type=Path, help="keep the runs here, or use those that are")
    parser.add_argument("--no-report", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="crowdbot-") as temporary:
        folder = options.folder or Path(temporary)
        if not (folder / "runs").is_dir():
            make_up(folder / "runs", options.runs)
        commands = [["results"]]
        if not options.no_report:
            commands.append(["report", "runs", "--out", str(Path(temporary) / "page.html")])
        print(f"{'command':10}{'index':>8}{'cpu s':>8}{'wall s':>8}{'MB':>8}")
        for words in commands:
            costs = []
            for state in ("none", "kept"):
                if state == "none":
                    (folder / "runs" / INDEX).unlink(missing_ok=True)
                costs.append(measure(words, folder))
                cost = costs[-1]
                print(f"{words[0]:10}{state:>8}{cost.cpu:8.2f}{cost.wall:8.2f}{cost.memory:8.0f}",
                      flush=True)  # fmt: skip
            print(f"{words[0]:10} {costs[0].cpu / costs[1].cpu:.1f} times faster with an index")


if __name__ == "__main__":
    main()
