"""Provenance of the numbers: versions, hashes, plugins and machines of the runs."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

from crowdbot.core.results.rows import RunRow


def facts(runs: Sequence[RunRow]) -> dict[str, dict[str, str]]:
    """Return groups of facts: name -> text, with counts if the runs differ."""
    groups = {
        "software": _merged(run.provenance["versions"] for run in runs),
        "machine": _merged(run.provenance["machine"] for run in runs),
        "plugins": _merged(run.provenance["plugins"] for run in runs),
        "conditions": _merged((run.conditions for run in runs), _plain_conditions),
        "metrics": _merged((run.conditions for run in runs), _metrics),
    }
    return {name: found for name, found in groups.items() if found}


def hashes(runs: Sequence[RunRow]) -> dict[str, str]:
    """Return hashes of the data: the number of each, and one hash over all."""
    everything = sorted(f"{run.run_id.rpartition(chr(0))[2]} {run.trajectory_hash}" for run in runs)
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
    """Return kind and parameters of one planner, from its runs."""
    return _merged(run.provenance["planner"] for run in runs)


def _metrics(conditions: Mapping[str, str]) -> dict[str, str]:
    """Return the parameters of metrics."""
    mine = "metrics."
    return {n.removeprefix(mine): text for n, text in conditions.items() if n.startswith(mine)}


def _plain_conditions(conditions: Mapping[str, str]) -> dict[str, str]:
    """Return the conditions without metrics, software and machine."""
    prefixes = ("metrics.", "versions.", "processor")
    return {n: text for n, text in conditions.items() if not n.startswith(prefixes)}


def _merged(
    documents: Iterable[Mapping[str, str]],
    part: Callable[[Mapping[str, str]], Mapping[str, str]] = lambda document: document,
) -> dict[str, str]:
    """Return one text per name; different texts are given with their number of runs.

    Args:
        documents: many of which are the same object.
        part: the part of each that is wanted.
    """
    given = list(documents)  # keeps them alive, so that numbers of objects stay their own
    by_number = dict(zip(map(id, given), given, strict=True))
    counts: dict[str, Counter[str]] = {}
    for number, times in Counter(map(id, given)).items():
        for name, text in part(by_number[number]).items():
            counts.setdefault(name, Counter())[text] += times
    return {
        name: next(iter(found)) if len(found) == 1 else _different(found)
        for name, found in counts.items()
    }


def _different(found: Counter[str]) -> str:
    return ", ".join(f"{text} ({count} runs)" for text, count in found.most_common())
