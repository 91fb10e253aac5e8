"""Output of ``crowdbot evaluate``: tables, JSON, files, and progress."""

from __future__ import annotations

import dataclasses
import json
import logging
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.say import say
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import printable

if TYPE_CHECKING:
    from crowdbot.core.runs.rescore import Rescored
    from crowdbot.core.types.score import Score

_LINE_EVERY = 5.0  # s


def as_document(result: Rescored) -> dict[str, Any]:
    """Return one run as plain data."""
    source = result.source
    return {
        "run": str(source.path),
        "scenario": source.scenario,
        "planner": source.planner,
        "seed": source.seed,
        "error": result.error,
        "complete": result.complete,
        "until": result.until,
        "scores": [_fields(s) for s in result.scores],
    }


def print_table(result: Rescored) -> None:
    """Print one run in readable form."""
    from rich.console import Console
    from rich.text import Text

    from crowdbot.core.scoring.scores_csv import scores_table

    source = result.source
    seed = "" if source.seed is None else f"seed {source.seed}"
    title = " ".join(filter(None, (source.scenario, source.planner, seed)))
    console = Console(highlight=False)
    console.print(Text(printable(title or str(source.path)), style="bold"), soft_wrap=True)
    if not result.complete:
        console.print(f"incomplete: read until {result.until:g} s", soft_wrap=True)
    console.print(scores_table(result.scores))


def write_file(path: Path, results: Sequence[Rescored]) -> None:
    """Write all runs as one table (``.csv``: scores.csv plus ``run``) or as ``.json``.

    Raises:
        InputError: it cannot be written.
    """
    from crowdbot.core.scoring.scores_csv import COLUMNS, cells_of, write_table

    if path.suffix.lower() == ".json":
        _write_json(path, [as_document(r) for r in results])
        return
    rows = [
        (s.scenario, s.label, "" if s.seed is None else str(s.seed), *cells_of(one), str(s.path))
        for s, scores in ((r.source, r.scores) for r in results)
        for one in scores
    ]
    write_table(path, [(*COLUMNS, "run"), *rows])


@contextmanager
def show_progress(total: int) -> Iterator[Callable[[int], None]]:
    """Yield a function to call after each run with the failures so far; progress goes to stderr.

    A bar on a terminal, otherwise occasional lines; nothing for a single run.
    """
    if total < 2 or logging.getLogger("crowdbot").level > logging.INFO:
        yield _silent
    elif sys.stderr.isatty():
        with _bar(total) as advance:
            yield advance
    else:
        yield _Lines(total)


@contextmanager
def _bar(total: int) -> Iterator[Callable[[int], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeRemainingColumn as Remaining

    columns = (
        TextColumn("evaluated"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        Remaining(),
        TextColumn("{task.fields[state]}"),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        task = progress.add_task("evaluated", total=total, state="")
        yield lambda failed: progress.update(
            task, advance=1, state=f"{failed} failed" if failed else ""
        )


def _silent(failed: int) -> None:
    del failed


class _Lines:
    def __init__(self, total: int) -> None:
        self._total, self._done, self._next = total, 0, time.monotonic() + _LINE_EVERY

    def __call__(self, failed: int) -> None:
        self._done += 1
        if time.monotonic() >= self._next and self._done < self._total:
            self._next = time.monotonic() + _LINE_EVERY
            say(f"evaluated {self._done} of {self._total} runs, {failed} failed", err=True)


def _fields(score: Score) -> dict[str, Any]:
    values = {f.name: getattr(score, f.name) for f in dataclasses.fields(score)}
    return {**values, "extras": dict(score.extras), "parameters": dict(score.parameters)}


def _write_json(path: Path, document: Any) -> None:
    atomic_write(path, json.dumps(document, indent=2, allow_nan=False) + "\n")
