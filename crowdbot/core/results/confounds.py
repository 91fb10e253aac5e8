"""Confounds: differences between compared runs other than the planner."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError, UnknownNameError

#: Name of a confound -> its severity and description.
KINDS: Mapping[str, tuple[Literal["error", "warning"], str]] = {
    "scenario": ("error", "scenarios of one name with different content"),
    "crowd": ("error", "different people in one scenario"),
    "rates": ("error", "different rates of simulation, planner or log"),
    "perceived_radius": ("error", "people see the robot in different sizes"),
    "visibility": ("error", "people see and heed the robot differently"),
    "condition": ("error", "another condition of the scenario differs"),
    "metrics": ("error", "metrics of different versions or parameters"),
    "versions": ("error", "different versions of software"),
    "privileged": ("error", "planners that know ground truth among planners that sense"),
    "libraries": ("warning", "versions of libraries that only read and write files"),
    "agents": ("warning", "people read from a lock in some runs, sampled in others"),
    "unpinned": ("warning", "code of no installed version, which others cannot get by name"),
    "processor": ("warning", "different processors, which round differently"),
    "excused": (
        "warning",
        "draws replaced in which the robot was struck from behind without fault and toppled",
    ),
    "excused_often": ("error", "more than a tenth of a planner's draws were replaced"),
    "unpaired": ("warning", "scenarios and seeds that not all planners have run"),
}

_SHOWN = 3
#: Largest share of a planner's runs whose draws may be replaced; one always may.
MOST_EXCUSED = 0.1
#: Findings about one value, which no other one differs from.
_ALONE = ("unpinned", "excused", "excused_often")
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
#: Prefix of a condition's name -> its confound.
_CONDITIONS = {
    "rates": "rates",
    "rate": "rates",
    "perceived_radius": "perceived_radius",
    "people_and_robot": "visibility",
    "visibility": "visibility",
    "metrics": "metrics",
    "metric": "metrics",
    "versions": "versions",
    "version": "versions",
    "processor": "processor",
}
#: Conditions that decide no number of a run.
_FILES = ("versions.mcap", "versions.pydantic", "versions.rosbags")
#: Conditions that must be equal in all runs; the others in all runs of one scenario.
_EVERYWHERE = ("metrics", "versions", "libraries", "processor")


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One difference.

    Attributes:
        kind: key of `KINDS`.
        severity: ``error``: the runs cannot be compared; ``warning``: they can.
        subject: the scenario, condition or package that differs.
        values: value -> directories of the runs with it, most frequent first.
        accepted: True if the user accepted it; reports show it.
    """

    kind: str
    severity: Literal["error", "warning"]
    subject: str
    values: Mapping[str, tuple[str, ...]]
    accepted: bool = False

    def __str__(self) -> str:
        parts = [f"{v or 'nothing'} in {_counted(runs)}" for v, runs in self.values.items()]
        apart = _apart([*self.values])
        return f"{self.kind}: {self.subject}: {'; '.join(parts)}{f' ({apart})' * bool(apart)}"

    @property
    def brief(self) -> str:
        """Return the difference for a terminal: its meaning, and counts without directories."""
        parts = [
            f"{v or 'nothing'} in {plural(len(runs), 'run')}" for v, runs in self.values.items()
        ]
        subject = "" if self.subject == self.kind else f"{self.subject}: "
        return f"{self.kind}: {subject}{'; '.join(parts)} ({KINDS[self.kind][1]})"


def confounds(results: Results, accept: Iterable[str] = ()) -> tuple[Finding, ...]:
    """Return all differences other than the planner, errors first.

    Args:
        results: the compared runs.
        accept: names of accepted confounds, separated by commas.

    Raises:
        UnknownNameError: there is no confound with this name.
    """
    accepted = {name.strip() for text in accept for name in text.split(",")}
    for name in sorted(accepted - set(KINDS)):
        raise UnknownNameError("confound", name, KINDS)
    found = [f for f in _merged(_all(results.runs)) if len(f.values) > 1 or f.kind in _ALONE]
    found = [replace(f, accepted=f.kind in accepted) for f in found]
    order = list(KINDS)
    return tuple(sorted(found, key=lambda f: (order.index(f.kind), f.subject)))


def check_comparable(findings: Sequence[Finding]) -> None:
    """Refuse a comparison with errors.

    Raises:
        InputError: there is an error that was not accepted.
    """
    errors = [f for f in findings if f.severity == "error" and not f.accepted]
    if errors:
        kinds = ", ".join(dict.fromkeys(f.kind for f in errors))
        lines = "\n".join(_lines(errors))
        raise InputError(
            f"these runs differ in more than the planner:\n{lines}\n"
            f"compare them apart, or accept what differs: --accept {kinds.replace(' ', '')}"
        )


def _lines(findings: Sequence[Finding]) -> Iterator[str]:
    """Yield lines of text with the first findings of each kind, and the number of others."""
    for kind in dict.fromkeys(f.kind for f in findings):
        same = [f for f in findings if f.kind == kind]
        yield from (f"  {f}" for f in same[:_SHOWN])
        if len(same) > _SHOWN:
            yield f"  {kind}: {len(same) - _SHOWN} more like these"


# ------------------------------------------------------------------------- looking
def _all(runs: Sequence[RunRow]) -> Iterator[Finding]:
    for scenario, group in _grouped(runs, lambda r: f"{r.suite}/{r.scenario}"):
        yield _finding("scenario", scenario, group, lambda r: _short(r.spec_hash))
        yield _finding("crowd", scenario, group, lambda r: _short(r.realisation_hash))
        yield _finding("agents", scenario, group, lambda r: r.agents)
    yield from _conditions(runs)
    # A ceiling is meant for comparison and is marked as one.
    yield _finding("privileged", "planners", [r for r in runs if r.role != "ceiling"], _class)
    loose = [r for r in runs if not r.pinned]
    for planner, group in _grouped(loose, lambda r: r.planner):
        yield _finding("unpinned", planner, group, lambda r: r.source)
    for planner, group in _grouped(runs, lambda r: r.planner):
        yield from _excused(planner, group)
    # Floors and ceilings run in a sample; results about them give the number of pairs.
    yield from _unpaired([r for r in runs if r.role not in ("floor", "ceiling")])


def _excused(planner: str, runs: Sequence[RunRow]) -> Iterator[Finding]:
    """Yield a finding if draws were replaced, and another if too many were."""
    replaced = [r for r in runs if r.replaced_draws]
    if not replaced:
        return
    yield _finding("excused", planner, runs, _draws)
    if len(replaced) > max(1.0, MOST_EXCUSED * len(runs)):
        yield _finding("excused_often", planner, runs, _draws)


def _draws(run: RunRow) -> str:
    count = run.replaced_draws
    return f"{count} replaced" if count else "its own draw"


def _conditions(runs: Sequence[RunRow]) -> Iterator[Finding]:
    all_conditions = {r.run_id: r.conditions for r in runs}
    different = {id(found): found for found in all_conditions.values()}
    names = dict.fromkeys(n for found in different.values() for n in found)
    scored = {key: {_head(n) for n in found} for key, found in different.items()}
    for name in sorted(names):
        if len({found.get(name, "") for found in different.values()}) == 1:
            continue
        part = name.partition(".")[0]
        kind = "libraries" if name in _FILES else _CONDITIONS.get(part, "condition")
        groups = [("", runs)] if kind in _EVERYWHERE else _grouped(runs, _scenario)
        for scenario, group in groups:
            subject = f"{name}, {scenario}" if scenario else name

            if kind == "metrics":  # unscored runs are not compared
                group = [r for r in group if _head(name) in scored[id(all_conditions[r.run_id])]]

            def value(r: RunRow, name: str = name) -> str:
                return all_conditions[r.run_id].get(name, "")

            yield _finding(kind, subject, group, value)


def _head(name: str) -> str:
    """Return the metric of a condition such as ``metrics.risk.risk_horizon``."""
    return ".".join(name.split(".", 2)[:2])


def _unpaired(runs: Sequence[RunRow]) -> Iterator[Finding]:
    """Yield one finding if not all planners ran the same scenarios and seeds."""
    planners = tuple(sorted({r.planner for r in runs}))
    by_place: dict[tuple[str, int], list[RunRow]] = {}
    for run in runs:
        by_place.setdefault((_scenario(run), run.seed), []).append(run)
    alone: dict[str, list[str]] = {}
    for group in by_place.values():
        group_planners = tuple(sorted({r.planner for r in group}))
        if group_planners != planners:
            alone.setdefault(", ".join(group_planners), []).extend(
                r.directory or r.run_id for r in group
            )
    if alone:
        paired = [r.directory or r.run_id for g in by_place.values() for r in g
                  if len({x.planner for x in g}) == len(planners)]  # fmt: skip
        values = {"all planners": tuple(paired)} if paired else {}
        values |= {f"only {k}": tuple(v) for k, v in alone.items()}
        yield Finding(
            kind="unpaired", severity=KINDS["unpaired"][0], subject="scenarios and seeds",
            values=values,
        )  # fmt: skip


def _finding(
    kind: str, subject: str, runs: Iterable[RunRow], value: Callable[[RunRow], str]
) -> Finding:
    values: dict[str, list[str]] = {}
    for run in runs:
        values.setdefault(value(run), []).append(run.directory or run.run_id)
    common = sorted(values.items(), key=lambda item: (-len(item[1]), item[0]))
    return Finding(
        kind=kind, severity=KINDS[kind][0], subject=subject,
        values={v: tuple(found) for v, found in common},
    )  # fmt: skip


def _merged(findings: Iterable[Finding]) -> Iterator[Finding]:
    """Merge findings of one kind and value pair in many scenarios."""
    found: dict[tuple[str, str, tuple[str, ...]], list[Finding]] = {}
    for finding in findings:
        name = finding.subject.partition(",")[0] if "," in finding.subject else ""
        together = finding.kind in ("agents", "rates", "perceived_radius", "visibility",
                                    "condition")  # fmt: skip
        key = (finding.kind, name if together else finding.subject, tuple(sorted(finding.values)))
        found.setdefault(key, []).append(finding)
    for (_, name, _), group in found.items():
        first = group[0]
        if len(group) == 1:
            yield first
            continue
        values = {v: tuple(r for f in group for r in f.values[v]) for v in first.values}
        yield replace(first, subject=f"{name or 'people'}, {len(group)} scenarios", values=values)


def _grouped(
    runs: Sequence[RunRow], key: Callable[[RunRow], str]
) -> list[tuple[str, list[RunRow]]]:
    found: dict[str, list[RunRow]] = {}
    for run in runs:
        found.setdefault(key(run), []).append(run)
    return sorted(found.items())


# -------------------------------------------------------------------------- values
def _scenario(run: RunRow) -> str:
    return f"{run.suite}/{run.scenario}"


def _class(run: RunRow) -> str:
    return "privileged" if run.privileged else "sensors only"


def _short(text: str) -> str:
    return text.removeprefix("cb1-sha256:")[:12]


def _counted(runs: Sequence[str]) -> str:
    shown = ", ".join(runs[:_SHOWN]) + (", …" if len(runs) > _SHOWN else "")
    return f"{len(runs)} run{'s' * (len(runs) != 1)} ({shown})"


def _apart(values: Sequence[str]) -> str:
    """Return the difference of two values if both are numbers in equal text."""
    if len(values) != 2 or len({_NUMBER.sub("#", v) for v in values}) != 1:
        return ""
    found = [_NUMBER.findall(v) for v in values]
    pairs = [(float(a), float(b)) for a, b in zip(*found, strict=True) if float(a) != float(b)]
    if len(pairs) != 1 or "." in "".join(_NUMBER.split(values[0])):
        return ""
    a, b = pairs[0]
    return f"{b - a:+g}" + (f", {(b / a - 1):+.1%}" if a else "")
