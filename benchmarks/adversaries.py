r"""Thirty-five more adversaries that the edition was not made with: is one ahead of the careful?

Each is a few lines in `benchmarks/rude/`: eight that drive by what they see near (`first_eight`),
nineteen at the edge of what the rule of fault and the scores see (`lawyers`), and eight that cheat
with failures, commands, thoughts and the truth (`cheats`). They are not registered, so that
`crowdbot audit --adversaries` stays as it is:

    python benchmarks/adversaries.py challenge-2026 --only 'counter-d020-*-n01' --out DIR
    python benchmarks/adversaries.py challenge-2026 --group lawyers --out DIR
    python benchmarks/adversaries.py --out DIR --table

``--planner`` takes others beside them, as `crowdbot` does; without it the careful planners run,
too. Cheats run in a process of their own, as a stranger's planner does. What is complete under
``--out`` is not run again. ``--seed`` draws other people, as `benchmarks/tell_apart.py` does. The
table has the mean of each planner, and whether it is ahead of a careful one by the ranking rule.
"""

from __future__ import annotations

import argparse
import ast
import json
from collections.abc import Collection, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from tell_apart import chosen, reseeded

import crowdbot
from crowdbot.cli.output.adversary_lines import adversary_lines, adversary_text
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.results import Results
from crowdbot.core.scoring.score_scale import score_scales

CAREFUL = ("dwa", "stop_and_go", "people_mpc")
METRICS = (
    "safe_efficiency", "contacts_at_fault", "contacts_per_km", "acceptance", "intrusion",
)  # fmt: skip
FOLDER = Path(__file__).parent / "rude"
GROUPS = ("first_eight", "lawyers", "cheats")


def adversaries(groups: Collection[str]) -> Iterator[str]:
    """Yield the planners in the files of some groups, as `crowdbot` takes them."""
    for group in groups:
        file = FOLDER / f"{group}.py"
        parts = ast.parse(file.read_text(encoding="utf-8")).body
        yield from (f"{file}:{part.name}" for part in parts if isinstance(part, ast.ClassDef))


def simulate(given: argparse.Namespace) -> None:
    """Run what is missing, the scenarios one after the other."""
    suite: Any = given.suite
    if given.seed is not None:
        suite = reseeded(given.suite, given.seed, given.out / "suite")
    planners = given.planner or [*CAREFUL, *adversaries(given.group or GROUPS)]
    for scenario in chosen(crowdbot.expand(suite), given.only or ["*"]):
        for planner in planners:
            run = crowdbot.simulate(
                scenario, planner=planner, out=given.out, suite="adversaries", record="none",
                references=False, metrics=METRICS, replay=False,
                in_process=None if "cheats.py:" in planner else True,
            )  # fmt: skip
            print(f"{scenario.id:40} {planner.rpartition(':')[2]:12} {run.status}", flush=True)


def table(out: Path, *, as_json: bool) -> None:
    """Print the mean of each planner, then the pairs of the ranking rule."""
    found = replace(Results.open(out), scales=score_scales(discover()))
    lines = adversary_lines(found, CAREFUL)
    if as_json:
        print(json.dumps(lines, indent=1))
        return
    for planner in sorted({r.planner for r in found.runs}):
        own = {r.run_id: r.status == "arrived" for r in found.runs if r.planner == planner}
        means = [_mean(found, own, metric) for metric in METRICS[:2]]
        text = "  ".join(f"{m:.2f}" for m in means)
        print(f"{planner:20} {sum(own.values()):3} of {len(own):3} arrived  {text}")
    print(adversary_text(lines))


def _mean(found: Results, runs: Collection[str], metric: str) -> float:
    """Return the mean of a score over some runs; without a value it is 0."""
    values = [
        s.value or 0.0
        for s in found.scores
        if s.run_id in runs and (s.metric, s.variant) == (metric, "corrected")
    ]
    return float(np.mean(values))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suite", nargs="?", default="challenge-2026")
    parser.add_argument("--seed", type=int, help="draws other people")
    parser.add_argument("--only", action="append", metavar="GLOB", help="scenarios")
    parser.add_argument("--planner", action="append", help="instead of those and the careful")
    parser.add_argument("--group", action="append", choices=GROUPS, help="only these adversaries")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--table", action="store_true", help="run nothing")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if not given.table:
        simulate(given)
    table(given.out, as_json=given.json)


if __name__ == "__main__":
    main()
