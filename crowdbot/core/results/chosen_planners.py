"""Filter results by patterns of planner names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fnmatch import fnmatchcase

from crowdbot.core.results.results import Results
from crowdbot.core.results.score_columns import of_runs
from crowdbot.core.results.with_reference import without_mark
from crowdbot.errors import UnknownNameError


def of_planners(results: Results, patterns: Sequence[str]) -> Results:
    """Return the runs, scores and failures of planners that match patterns.

    Patterns apply to reference planners, too; if none matches one of those, all are kept.

    Args:
        results: any results.
        patterns: of labels, such as ``dwa*``; none: all planners.

    Raises:
        UnknownNameError: a pattern fits no planner.
    """
    if not patterns:
        return results
    labels = {r.planner for r in results.runs} | {f.planner for f in results.failures}
    fits = {p: {label for label in labels if _fits(label, p)} for p in patterns}
    for pattern, fitting in fits.items():
        if not fitting:
            raise UnknownNameError("planner", pattern, sorted(set(map(without_mark, labels))))
    chosen = set[str]().union(*fits.values())
    references = {label for label in labels if without_mark(label) != label}
    chosen |= set() if chosen & references else references
    runs = tuple(r for r in results.runs if r.planner in chosen)
    return replace(
        results,
        runs=runs,
        scores=of_runs(results.scores, {r.run_id for r in runs}),
        failures=tuple(f for f in results.failures if f.planner in chosen),
    )


def _fits(label: str, pattern: str) -> bool:
    """Return True if a pattern fits; ``+privileged`` need not be in it."""
    name = without_mark(label)
    return any(fnmatchcase(n, pattern) for n in (label, name, name.removesuffix("+privileged")))
