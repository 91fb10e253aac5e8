"""Opens the results below a folder for commands, without runs of altered scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.results.results import Results

_FILES = (".yaml", ".yml")
Altered = Annotated[
    bool,
    typer.Option("--altered", help="Include runs of scenarios that --set changed, as own suites."),
]
Reference = Annotated[
    str | None,
    typer.Option(
        metavar="crowdbot|FILE|ROOT",
        help="Reference scores beside them: those that come with crowdbot, a file, or runs.",
    ),
]
#: Number of changes that are named.
_SHOWN = 3


def open_results(root: Path, altered: bool, metrics: Sequence[str] = ()) -> Results:
    """Return all results; those of altered scenarios only if asked for, else stderr tells them.

    Args:
        metrics: patterns of names that are going to be asked for.

    Raises:
        InputError: there is no such folder, or no run, altered ones included, has such a metric.
    """
    from crowdbot.core.results.results import Results
    from crowdbot.core.results.score_columns import metrics_of
    from crowdbot.core.statistics.groups import check_scored

    found = Results.open(root)
    kept = found.without_altered()
    if altered or len(kept.runs) == len(found.runs):
        return found if altered else kept
    changes = dict.fromkeys(run.changes for run in found.runs if run.changes)
    named = "; ".join(list(changes)[:_SHOWN]) + ("; …" if len(changes) > _SHOWN else "")
    lost = plural(len(found.runs) - len(kept.runs), "run")
    message = f"{lost} of altered scenarios left out ({named}): --altered includes them"
    say(message, err=True)
    for metric in metrics:
        check_scored(metrics_of(found.scores), metric)
    return kept


def with_scales(found: Results) -> Results:
    """Return results with the installed metrics' scales."""
    from crowdbot.cli.shared.options import installed
    from crowdbot.core.scoring.score_scale import score_scales

    return replace(found, scales=score_scales(installed(None, False)))


def suite_id(suite: str, registry: Registry) -> str:
    """Return the id of a suite in records; the suite is given by its id or as a file.

    Raises:
        SpecError: the file is wrong.
    """
    from crowdbot.core.scenarios.library import open_spec

    return open_spec(suite, registry).suite if Path(suite).suffix in _FILES else suite
