r"""Does the order of planners depend on numbers that an edition has chosen?

Runs planners among the same draws with a low and a high value of each number of the people, and
scores the runs as they are again with a low and a high value of each number of the rule of fault,
for which nothing is simulated:

    python benchmarks/sensitivity.py challenge-2026 --only 'counter-d040-never-n0[12]' \
        --only 'both-d040-never-n0[12]' --out /tmp/sensitive
    python benchmarks/sensitivity.py --out /tmp/sensitive --table

A row is one value: mean safe efficiency of each planner, in brackets how many of its runs had no
contact at fault, and the pairs of planners whose order of means is another than with the edition's
own values. A pair that is nearer than `--close` in both is no turn.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import combinations
from pathlib import Path

import numpy as np

import crowdbot

EFFICIENCY, FAULTS = "safe_efficiency", "contacts_at_fault"
PLANNERS = ("people_mpc", "dwa", "stop_and_go", "goal_seek", "bully")
OWN = "as it is"
_PEOPLE = "crowd.robot_response."
#: As `never` says already; other conditions could not be expanded with a share.
_DISTRACTED = (f"{_PEOPLE}reaction=distracted",)
#: Row of the table -> fields of the scenario.
PEOPLE: Mapping[str, tuple[str, ...]] = {
    OWN: (),
    "late_time 0.4 s": (f"{_PEOPLE}late_time=0.4 s",),
    "late_time 1.2 s": (f"{_PEOPLE}late_time=1.2 s",),
    "reaction_time 0.15 s": (f"{_PEOPLE}reaction_time=0.15 s",),
    "reaction_time 0.6 s": (f"{_PEOPLE}reaction_time=0.6 s",),
    "2 % never look": (*_DISTRACTED, f"{_PEOPLE}ignoring_fraction=0.02"),
    "25 % never look": (*_DISTRACTED, f"{_PEOPLE}ignoring_fraction=0.25"),
    "clearance 0.05 m": (f"{_PEOPLE}clearance=0.05 m",),
    "clearance 0.35 m": (f"{_PEOPLE}clearance=0.35 m",),
}
#: Row of the table -> field of the metrics and its value.
RULE: Mapping[str, tuple[str, float]] = {
    "fault_reaction 0.15 s": ("fault_reaction", 0.15),
    "fault_reaction 0.6 s": ("fault_reaction", 0.6),
    "fault_braking 0.5 m/s²": ("fault_braking", 0.5),
    "fault_margin 0.05 m": ("fault_margin", 0.05),
    "fault_margin 0.2 m": ("fault_margin", 0.2),
}
#: Planner -> safe efficiency and contacts at fault of its runs.
Scored = dict[str, list[tuple[float, float]]]


def simulate(given: argparse.Namespace) -> None:
    """Run what is missing, the edition's own values first."""
    for row, fields in PEOPLE.items():
        scenarios = crowdbot.expand(given.suite, set=[*given.set, *fields])
        for pattern in given.only or ["*"]:
            for scenario in scenarios:
                name = scenario.id.rpartition("/")[2].partition("+")[0]
                for planner in given.planner or PLANNERS if fnmatchcase(name, pattern) else ():
                    run = crowdbot.simulate(
                        scenario, planner=planner, out=given.out / _folder(row), suite="sensitive",
                        record="none", references=False, metrics=[EFFICIENCY, FAULTS],
                        replay=False, in_process=True,
                    )  # fmt: skip
                    print(f"{row:22} {name:28} {planner:12} {run.status}", flush=True)


def _folder(row: str) -> str:
    return "".join(c if c.isalnum() else "_" for c in row)


def rows(out: Path) -> Iterator[tuple[str, Scored]]:
    """Yield each row that has runs, the edition's own values first."""
    for row in PEOPLE:
        if found := scored(out / _folder(row), {}):
            yield row, found
    for row, (field, value) in RULE.items():
        if found := scored(out / _folder(OWN), {field: value}):
            yield row, found


def scored(folder: Path, changed: Mapping[str, float]) -> Scored:
    """Return the scores of runs below a folder, with parameters changed.

    Only scenarios that all of its planners have run count.
    """
    found: dict[str, dict[str, tuple[float, float]]] = {}
    for record in sorted(folder.glob("sensitive/*/*/seed-*/run.json")):
        run = crowdbot.Run.open(record.parent)
        scores = crowdbot.score(
            run.trajectories, metrics=[EFFICIENCY, FAULTS],
            parameters={EFFICIENCY: changed, FAULTS: changed},
        )  # fmt: skip
        numbers = (scores.find(name, "corrected").value for name in (EFFICIENCY, FAULTS))
        safe, faults = (float("nan") if x is None else x for x in numbers)
        scenario = record.parts[-4].partition("+")[0]
        found.setdefault(record.parts[-3], {})[scenario] = safe, faults
    shared = sorted(set[str].intersection(*map(set, found.values()))) if found else []
    return {p: [runs[k] for k in shared] for p, runs in found.items()} if shared else {}


def turned(own: Mapping[str, float], other: Mapping[str, float], close: float) -> list[str]:
    """Return pairs of planners whose order is another, better one of the second first."""
    pairs = []
    for a, b in combinations(sorted(set(own) & set(other)), 2):
        before, after = own[a] - own[b], other[a] - other[b]
        if before * after < 0.0 and max(abs(before), abs(after)) > close:
            pairs.append(f"{a} > {b}" if after > 0.0 else f"{b} > {a}")
    return pairs


def table(found: Sequence[tuple[str, Scored]], close: float) -> Iterator[str]:
    """Yield the lines of the table, as Markdown."""
    planners = sorted(found[0][1], key=lambda p: -_mean(found[0][1][p])) if found else []
    own = {p: _mean(found[0][1][p]) for p in planners}
    yield "| value | " + " | ".join(f"`{p}`" for p in planners) + " | turned |"
    yield "|---" * (len(planners) + 2) + "|"
    for row, scores in found:
        cells = [_cell(scores.get(p, [])) for p in planners]
        means = {p: _mean(scores[p]) for p in planners if p in scores}
        yield f"| {row} | {' | '.join(cells)} | {', '.join(turned(own, means, close)) or '–'} |"


def _mean(runs: Sequence[tuple[float, float]]) -> float:
    return float(np.mean([safe for safe, _ in runs]))


def _cell(runs: Sequence[tuple[float, float]]) -> str:
    if not runs:
        return "–"
    return f"{_mean(runs):.2f} ({sum(f == 0.0 for _, f in runs)} of {len(runs)})"


def main() -> int:
    """Simulate, or print the table of what is there."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suite", nargs="?", help="file or name")
    parser.add_argument("--only", action="append", help="pattern of scenario ids")
    parser.add_argument("--planner", action="append", help=f"default: {', '.join(PLANNERS)}")
    parser.add_argument("--set", action="append", default=[], help="in all runs, as of simulate")
    parser.add_argument("--out", type=Path, required=True, help="root of the run directories")
    parser.add_argument("--close", type=float, default=0.02, help="differences that are no turn")
    parser.add_argument("--table", action="store_true", help="only show what is there")
    given = parser.parse_args()
    if not given.table:
        if given.suite is None:
            parser.error("a suite, or --table")
        simulate(given)
    print("\n".join(table(list(rows(given.out)), given.close)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
