"""Opens the results below a folder for commands, without runs of altered scenarios."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option, switch
from crowdbot.core.support.text import plural
from crowdbot.errors import CrowdbotError, InputError, UnknownNameError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.results.results import Results

T = TypeVar("T")
_FILES = (".yaml", ".yml")
Altered = Annotated[
    bool, switch("--altered", "Include runs of scenarios that --set changed, as own suites.")
]
Reference = Annotated[
    str | None,
    option(
        "crowdbot|FILE|ROOT",
        "Reference scores beside them: those that come with crowdbot, a file, or runs.",
    ),
]
#: Number of changes that are named.
_SHOWN = 3


def open_results(root: Path, altered: bool, metrics: Sequence[str] = ()) -> Results:
    """Return all results; altered scenarios are left out, with a note, unless ``altered``.

    Args:
        metrics: patterns of metrics that the command needs.

    Raises:
        InputError: there is no such folder, or no run, altered ones included, has such a metric.
    """
    from crowdbot.core.results.results import Results
    from crowdbot.core.results.score_columns import metrics_of
    from crowdbot.core.statistics.groups import check_scored

    results = Results.open(root)
    kept = results.without_altered()
    if altered or len(kept.runs) == len(results.runs):
        return results if altered else kept
    changes = dict.fromkeys(run.changes for run in results.runs if run.changes)
    named = "; ".join(list(changes)[:_SHOWN]) + ("; …" if len(changes) > _SHOWN else "")
    lost = plural(len(results.runs) - len(kept.runs), "run")
    message = f"{lost} of altered scenarios left out ({named}): --altered includes them"
    say(message, err=True)
    for metric in metrics:
        check_scored(metrics_of(results.scores), metric)
    return kept


def by_suite(results: Results) -> dict[str, Results]:
    """Return suite -> its results, in order; scenarios with ``--set`` count as other suites."""
    from crowdbot.core.results.score_columns import of_runs

    parts = {}
    for suite in results.suites:
        runs = tuple(run for run in results.runs if run.suite == suite)
        parts[suite] = replace(
            results,
            runs=runs,
            scores=of_runs(results.scores, {run.run_id for run in runs}),
            failures=tuple(f for f in results.failures if f.suite == suite),
        )
    return parts


def of_each_suite(results: Results, look: Callable[[Results], T]) -> dict[str, T]:
    """Return suite -> result of a function for its results; stderr names suites left out.

    Raises:
        CrowdbotError: the function failed for all suites; the error of the first.
    """
    parts = by_suite(results)
    if len(parts) < 2:
        return {next(iter(parts), ""): look(results)}
    seen: dict[str, T] = {}
    errors: dict[str, CrowdbotError] = {}
    for suite, part in parts.items():
        try:
            seen[suite] = look(part)
        except (InputError, UnknownNameError) as error:
            errors[suite] = error
    if not seen:
        raise next(iter(errors.values()))
    for suite, why in errors.items():
        say(f"{suite} left out: {why}", err=True)
    return seen


def named_by_suite(found: Mapping[str, Iterable[dict[str, Any]]]) -> list[dict[str, Any]]:
    """Return the lines of all suites; if there are several, each line names its suite."""
    several = len(found) > 1
    return [
        ({"suite": suite} if several else {}) | line
        for suite, some in found.items()
        for line in some
    ]


def with_scales(results: Results) -> Results:
    """Return results with the installed metrics' scales."""
    from crowdbot.cli.shared.options import installed
    from crowdbot.core.scoring.score_scale import score_scales

    return replace(results, scales=score_scales(installed(None, False)))


def suite_id(suite: str, registry: Registry) -> str:
    """Return the id of a suite in records; the suite is given by its id or as a file.

    Raises:
        SpecError: the file is wrong.
    """
    from crowdbot.core.scenarios.library import open_spec

    return open_spec(suite, registry).suite if Path(suite).suffix in _FILES else suite
