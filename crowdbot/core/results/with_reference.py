"""Results beside reference scores, and the place of planners among these."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from statistics import fmean

from crowdbot.core.results.reference_file import open_references
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import ScoreRow
from crowdbot.core.results.score_columns import ScoreColumns, of_runs
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.four_scores import PRIMARY
from crowdbot.core.support.text import plural
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError

_REFERENCE = " (reference)"
#: Most scenarios that a warning names.
_SHOWN = 3
_LOG = logging.getLogger("crowdbot")


def without_mark(label: str) -> str:
    """Return a planner's own name, without the mark of reference runs."""
    return label.removesuffix(_REFERENCE)


def reference_results(text: str) -> Results:
    """Return reference results.

    Args:
        text: ``crowdbot`` for those that come with it, a file of them, or a folder of runs.

    Raises:
        InputError: it is none of these, or cannot be read.
    """
    found = open_references(text)
    return Results.open(Path(text)) if found is None else found.results


def with_reference(results: Results, given: Results | None) -> tuple[Results, tuple[str, ...]]:
    """Return results with reference results, under separate names, in the scenarios of both.

    Scenarios without a reference run are left out, with a warning, since means over different
    scenarios cannot be compared.

    Returns:
        both; names of the reference planners.

    Raises:
        InputError: no scenario of the results has a reference run.
    """
    if given is None:
        return results, ()
    scenarios = {(r.suite, r.scenario) for r in results.runs}
    runs = [
        replace(r, entry=r.planner + _REFERENCE)
        for r in given.runs
        if (r.suite, r.scenario) in scenarios
    ]
    if not runs:
        there = ", ".join(sorted({s for s, _ in scenarios})) or "no suite"
        known = ", ".join(sorted({r.suite for r in given.runs})) or "nothing"
        raise InputError(
            f"--reference: no run of a scenario of {there} that is reported here; "
            f"the references hold {known}"
        )
    results = _in_scenarios(results, {(r.suite, r.scenario) for r in runs})
    ids = {r.record.run_id: r.run_id for r in runs}
    scores = [replace(s, run_id=ids[s.run_id]) for s in given.scores if s.run_id in ids]
    both = replace(results, runs=(*results.runs, *runs), scores=(*results.scores, *scores))
    return both, tuple(sorted({r.planner for r in runs}))


def _in_scenarios(results: Results, scenarios: set[tuple[str, str]]) -> Results:
    """Return results in some scenarios; a warning says how many others there are."""
    others = sorted({r.scenario for r in results.runs if (r.suite, r.scenario) not in scenarios})
    if not others:
        return results
    some = ", ".join(others[:_SHOWN]) + ", …" * (len(others) > _SHOWN)
    _LOG.warning(
        "warning: %s without a reference run left out: %s; without --reference all are shown",
        plural(len(others), "scenario"), some,
    )  # fmt: skip
    runs = tuple(r for r in results.runs if (r.suite, r.scenario) in scenarios)
    failures = tuple(f for f in results.failures if (f.suite, f.scenario) in scenarios)
    scores = of_runs(results.scores, {r.run_id for r in runs})
    return replace(results, runs=runs, scores=scores, failures=failures)


def among_references(results: Results, known: tuple[str, ...]) -> Iterator[str]:
    """Yield a line for each own planner: its rank among the references by the primary score.

    Compared are means over the scenarios that all of them have run; without a test this proves
    nothing.

    Args:
        results: from `with_reference`.
        known: names of the references.
    """
    if not known:
        return
    runs = {r.run_id: r for r in results.runs}
    values: dict[str, dict[tuple[str, str], list[float]]] = {}
    scores = ScoreColumns.of(results.scores)
    for place in scores.by_name.get((PRIMARY.metric, PRIMARY.variant), ()):
        score = scores[int(place)]
        run = runs[score.run_id]
        value = 0.0 if score.value is None else score.value
        own = values.setdefault(run.planner, {})
        own.setdefault((run.suite, run.scenario), []).append(value)
    for planner in sorted(set(values) - set(known)):
        shared = set(values[planner])
        others = [k for k in known if shared & set(values.get(k, {}))]
        for name in others:
            shared &= set(values[name]) or shared
        if not shared or not others:
            continue
        means = {n: fmean(fmean(values[n][s]) for s in shared) for n in (planner, *others)}
        place, listed = _place(planner, means)
        yield f"{planner}: {place} in {plural(len(shared), 'scenario')}: {listed}"


def place_of_run(run: RunRecord, scores: Iterable[Score | ScoreRow], given: Results) -> str:
    """Return the place of one run among reference runs of its scenario, as a sentence.

    Several reference runs of a planner count by their mean. One run proves nothing.

    Args:
        run: its record.
        scores: its scores; without a value it counts as 0.
        given: from `reference_results`.

    Raises:
        InputError: there is no reference run of the scenario.
    """
    label = run.planner.label
    own = [s.value for s in scores if (s.metric, s.variant) == (PRIMARY.metric, PRIMARY.variant)]
    runs = {
        r.run_id: r.planner + _REFERENCE
        for r in given.runs
        if r.record.hashes.spec == run.hashes.spec
    }
    values: dict[str, list[float]] = {}
    for score in of_runs(given.scores, set(runs)):
        if (score.metric, score.variant) == (PRIMARY.metric, PRIMARY.variant):
            values.setdefault(runs[score.run_id], []).append(score.value or 0.0)
    if not values or not own:
        there = f"{run.suite}/{run.scenario}"
        raise InputError(
            f"--reference: no reference run of {there}"
            if own
            else f"--reference: the run of {there} has no score {PRIMARY.metric}"
        )
    means = {planner: fmean(found) for planner, found in values.items()}
    return ": ".join(_place(label, means | {label: own[0] or 0.0}))


def _place(planner: str, means: Mapping[str, float]) -> tuple[str, str]:
    """Return a planner's place, and all means, the best first."""
    order = sorted(means, key=lambda n: -means[n])
    plain = {n: n if without_mark(n) == planner else without_mark(n) for n in order}
    listed = ", ".join(f"{plain[n]} {means[n]:.2f}" for n in order)
    return f"number {order.index(planner) + 1} of {len(order)} by {PRIMARY.role}", listed
