"""Provenance of the numbers: versions, hashes, plugins and machines of the runs."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.record_parts import PluginPart


def facts(runs: Sequence[RunRow]) -> dict[str, dict[str, str]]:
    """Return groups of facts: name -> text, with counts if the runs differ."""
    records = [run.record for run in runs]
    groups = {
        "software": _merged(r.versions for r in records),
        "machine": _merged(r.machine for r in records),
        "plugins": _merged(_plugins(r.plugins) for r in records),
        "conditions": _merged(_conditions(run, metrics=False) for run in runs),
        "metrics": _merged(_conditions(run, metrics=True) for run in runs),
    }
    return {name: found for name, found in groups.items() if found}


def hashes(runs: Sequence[RunRow]) -> dict[str, str]:
    """Return hashes of the data: the number of each, and one hash over all."""
    everything = sorted(f"{run.record.run_id} {run.trajectory_hash}" for run in runs)
    digest = hashlib.sha256("\n".join(everything).encode()).hexdigest()
    return {
        "scenarios": str(len({run.spec_hash for run in runs})),
        "crowd draws": str(len({run.realisation_hash for run in runs})),
        "trajectories": str(len({run.trajectory_hash for run in runs})),
        "sha256 of all run ids and trajectory hashes": digest,
    }


def scenarios(runs: Sequence[RunRow]) -> list[tuple[str, str, str]]:
    """Return scenario, start of its hash and of its crowd's hash; several if they differ."""
    found: dict[str, tuple[dict[str, None], dict[str, None]]] = {}
    for run in runs:
        specs, draws = found.setdefault(run.scenario, ({}, {}))
        specs[short(run.spec_hash)] = None
        draws[short(run.realisation_hash)] = None
    return [(name, ", ".join(specs), ", ".join(draws)) for name, (specs, draws) in found.items()]


def short(hash_: str) -> str:
    """Return the start of a hash, enough to identify it."""
    return hash_.removeprefix("cb1-sha256:")[:16]


def planner_facts(runs: Sequence[RunRow]) -> dict[str, str]:
    """Kind and parameters of one planner, from its runs."""
    return _merged(_texts(run.record.planner.document()) for run in runs)


def _conditions(run: RunRow, *, metrics: bool) -> dict[str, str]:
    """Return the parameters of metrics, or the other conditions without software and machine."""
    if metrics:
        names = {n: n.removeprefix("metrics.") for n in run.conditions if n.startswith("metrics.")}
    else:
        told = ("metrics.", "versions.", "processor")
        names = {n: n for n in run.conditions if not n.startswith(told)}
    return {name: run.conditions[n] for n, name in names.items()}


def _texts(value: Any) -> dict[str, str]:
    if not isinstance(value, Mapping):
        return {}
    found: dict[str, str] = {}
    for name, inner in value.items():
        if isinstance(inner, Mapping):
            found |= {f"{name}.{k}": text for k, text in _texts(inner).items()}
        else:
            found[str(name)] = str(inner)
    return found


def _plugins(plugins: Sequence[PluginPart]) -> dict[str, str]:
    """Plugin -> distribution."""
    return {p.name: p.distribution + ("" if p.pinned else ", not pinned") for p in plugins}


def _merged(documents: Iterable[Mapping[str, str]]) -> dict[str, str]:
    """Return one text per name; different texts are given with their number of runs."""
    counts: dict[str, Counter[str]] = {}
    for document in documents:
        for name, text in document.items():
            counts.setdefault(name, Counter())[text] += 1
    return {
        name: next(iter(found)) if len(found) == 1 else _different(found)
        for name, found in counts.items()
    }


def _different(found: Counter[str]) -> str:
    return ", ".join(f"{text} ({count} runs)" for text, count in found.most_common())
