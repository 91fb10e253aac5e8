r"""Does a suite tell blind robots from careful ones, among people whom nobody has seen?

Draws the people of a suite anew, from another seed, runs planners among them and shows how the
four scores separate those who see nothing from those who are careful:

    python benchmarks/tell_apart.py challenge-2026 --seed 731992 --only 'counter-*-n01' \
        --only 'both-*-n01' --out /tmp/apart
    python benchmarks/tell_apart.py --out /tmp/apart --table

What is complete under ``--out`` is not run again. ``--table`` only reads what is there. A row of
the last table is one pair of planners in one score, careful ones with blind ones, or all pairs
where there are none of either: the difference of means over scenarios that
both have run, the first less the second, better side positive; its interval of 95 % by resampling
scenarios, and the share of resamples in which it is above 0.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import shutil
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import crowdbot
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_document
from crowdbot.dsl.scenario.scenario import Scenario

Array = NDArray[np.float64]
Numbers = dict[str, float]
BLIND, CAREFUL = ("goal_seek", "wall_hug"), ("dwa", "stop_and_go")
#: Score of a run, its variant, the variant that a rate is over, and whether more is better.
SCORES = (
    ("safe_efficiency", "corrected", "", True),
    ("acceptance", "corrected", "", True),
    ("contacts_at_fault", "corrected", "", False),
    ("contacts_per_km", "corrected", "way", False),
    ("push_work", "rate", "way", False),
    ("intrusion", "rate", "way", False),
    ("push_work", "forced", "way", False),
    ("intrusion", "hurried", "way", False),
)
#: Others that are shown, without a comparison.
SHOWN = (("evasive_acceleration", "corrected"), ("regress", "time_share"))
METRICS = [*(s[0] for s in SCORES), *(s[0] for s in SHOWN)]
RESAMPLES = 10_000


def reseeded(spec: str, seed: int, folder: Path) -> Path:
    """A copy of a suite, with all that it extends, in which another seed draws the people."""
    found = open_document(spec, discover())
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copytree(found.path.parent / "parts", folder / "parts", dirs_exist_ok=True)
    text, count = re.subn(r"(?m)^(\s+seed:) \d+", rf"\1 {seed}", found.path.read_text())
    assert count == 1, f"{found.path} has {count} lines with a seed"
    copy = folder / f"{found.path.stem}-{seed}.yaml"
    copy.write_text(text)
    return copy


def chosen(scenarios: Sequence[Scenario], patterns: Sequence[str]) -> Iterator[Scenario]:
    """Those that are asked for, in the order of the patterns."""
    for pattern in patterns:
        for scenario in scenarios:
            if fnmatchcase(scenario.id.rpartition("/")[2].partition("+")[0], pattern):
                yield scenario


def simulate(suite: Path, given: argparse.Namespace) -> None:
    """Run what is missing, and say how each run ended."""
    planners = given.planner or [*BLIND, *CAREFUL]
    for scenario in chosen(crowdbot.expand(suite, set=given.set), given.only or ["*"]):
        for planner in planners:
            run = crowdbot.simulate(
                scenario, planner=planner, planner_settings=given.planner_set, out=given.out,
                suite="apart", record="none", references=False, metrics=METRICS, replay=False,
                in_process=True,
            )  # fmt: skip
            print(f"{scenario.id:40} {planner:12} {run.status}", flush=True)


def rows(out: Path) -> dict[str, dict[str, Numbers]]:
    """Planner -> scenario -> numbers of its run, scored anew from the recording."""
    found: dict[str, dict[str, Numbers]] = {}
    for record in sorted(out.glob("apart/*/*/seed-*/run.json")):
        scenario, planner = record.parts[-4], record.parts[-3]
        scores = crowdbot.evaluate(record.parent, METRICS)
        one: Numbers = {}
        for metric, variant, over, _ in SCORES:
            name = f"{metric}.{variant}"
            one[name] = number(scores, metric, variant)
            one[f"{name}/way"] = number(scores, metric, over) if over else 1.0
        for metric, variant in SHOWN:
            one[f"{metric}.{variant}"] = number(scores, metric, variant)
        one["arrived"] = float(json.loads(record.read_text())["status"] == "arrived")
        one["aside"] = scores.find("safe_efficiency").extras["driven_aside"]
        found.setdefault(planner, {})[scenario] = one
    return found


def number(scores: crowdbot.Scores, metric: str, variant: str) -> float:
    value = scores.find(metric, variant).value
    return math.nan if value is None else float(value)


def mean(runs: Array, ways: Array) -> Array:
    """Of numbers (..., K): rates weigh as their ways do; those without a value are left out."""
    known = np.isfinite(runs)
    weight = np.where(known, ways, 0.0)
    total = np.where(known, runs, 0.0) * weight
    return np.asarray(total.sum(axis=-1) / np.maximum(weight.sum(axis=-1), 1e-12))


def columns(runs: dict[str, Numbers], names: Sequence[str], metric: str) -> tuple[Array, Array]:
    ways = np.array([runs[n].get(f"{metric}/way", 1.0) for n in names])
    return np.array([runs[n][metric] for n in names]), np.where(np.isfinite(ways), ways, 0.0)


def show(found: dict[str, dict[str, Numbers]]) -> None:
    """Means of each planner, then each pair in each score."""
    measures = [f"{m}.{v}" for m, v, *_ in (*SCORES, *SHOWN)] + ["arrived", "aside"]
    print(f"{'mean over the runs':32}" + "".join(f"{p[:20]:>22}" for p in found))
    print(f"{'runs':32}" + "".join(f"{len(runs):22}" for runs in found.values()))
    for measure in measures:
        means = [float(mean(*columns(runs, sorted(runs), measure))) for runs in found.values()]
        print(f"{measure:32}" + "".join(f"{m:22.3f}" for m in means))
    print()
    for metric, variant, _, more in SCORES:
        name = f"{metric}.{variant}"
        for first, second in pairs(list(found)):
            lead = compare(found, name, first, second, more)
            print(f"{name:28} {first:28} {second:28} {lead}")


def pairs(planners: Sequence[str]) -> list[tuple[str, str]]:
    """Careful ones with blind ones; if either kind is missing, all pairs."""
    entries = [(a, b) for a in CAREFUL for b in BLIND if {a, b} <= set(planners)]
    return entries or list(combinations(sorted(planners), 2))


def compare(
    found: dict[str, dict[str, Numbers]], metric: str, careful: str, blind: str, more: bool
) -> str:
    """Lead of the first one, its interval, and the share of resamples in which it leads."""
    names = sorted(set(found[careful]) & set(found[blind]))
    drawn = np.random.default_rng(0).integers(0, len(names), (RESAMPLES, len(names)))
    leads = []
    for index in (np.arange(len(names))[None], drawn):
        a, b = (
            mean(values[index], ways[index])
            for values, ways in (columns(found[p], names, metric) for p in (careful, blind))
        )
        leads.append(a - b if more else b - a)
    low, high = np.percentile(leads[1], [2.5, 97.5])
    ahead = 100 * np.mean(leads[1] > 0)
    lead = f"{leads[0][0]:9.3f} [{low:8.3f}, {high:8.3f}]"
    return f"{lead}  ahead in {ahead:5.1f} % of resamples of {len(names)} draws"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suite", nargs="?", help="file or name")
    parser.add_argument("--seed", type=int, help="draws the people; not that of the suite")
    parser.add_argument("--only", action="append", help="pattern of scenario ids")
    parser.add_argument("--planner", action="append", help="of blind and careful ones")
    parser.add_argument("--planner-set", action="append", default=[], help="as of simulate")
    parser.add_argument("--set", action="append", default=[], help="as of simulate")
    parser.add_argument("--out", type=Path, required=True, help="root of the run directories")
    parser.add_argument("--table", action="store_true", help="only show what is there")
    given = parser.parse_args()
    if not given.table:
        if given.suite is None or given.seed is None:
            parser.error("a suite and --seed, or --table")
        simulate(reseeded(given.suite, given.seed, given.out / "suite"), given)
    show(rows(given.out))


if __name__ == "__main__":
    main()
