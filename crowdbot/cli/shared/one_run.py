"""Shared code of commands that run in their own process: Drake, Ctrl-C, output."""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from crowdbot.cli.output.say import say
from crowdbot.core.registry.plugin_errors import UserInterrupt

if TYPE_CHECKING:
    from crowdbot.core.runs.run import Run


def import_simulate() -> Callable[..., Run]:
    """Import Drake, which needs a system library that a minimal machine may lack.

    Raises:
        MissingLibraryError: it is missing.
    """
    from crowdbot.errors import MissingLibraryError

    try:
        from crowdbot.core.sim.simulate import simulate as simulate_it
    except ImportError as error:
        if "libglib" not in str(error):
            raise
        raise MissingLibraryError(
            "Drake needs the system library libglib2.0; install it with "
            "'sudo apt-get install libglib2.0-0' (libglib2.0-0t64 on newer systems)"
        ) from error
    return simulate_it


@contextmanager
def interruptible() -> Iterator[Callable[[], bool]]:
    """On the first Ctrl-C, end the run and keep its recording; on the second, abort.

    Before the run starts, for example during compilation, the first one aborts.
    """
    asked = running = False

    def handler(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        del number, frame
        if asked or not running:
            raise UserInterrupt
        asked = True

    def stop() -> bool:
        nonlocal running
        running = True
        return asked

    previous = signal.signal(signal.SIGINT, handler)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, previous)


def end_hung_process() -> None:
    """Kill this process: a planner that catches interruptions cannot be ended otherwise."""
    print(
        "error: the planner did not return and could not be interrupted; "
        "the recording up to here is in the .partial directory",
        file=sys.stderr,
        flush=True,
    )
    os._exit(3)


def print_run(run: Run, *, as_json: bool) -> None:
    """Print scores on stdout, as a table or JSON, and errors last, on stderr."""
    _print_result(run, as_json=as_json)
    if run.failed:
        sys.stdout.flush()
        say(f"error: {run.record.reason}", err=True)


def _print_result(run: Run, *, as_json: bool) -> None:
    from crowdbot.core.runs.run_directory import REPLAY, SCORES
    from crowdbot.core.scoring.scores_csv import headlines, read_scores_csv, scores_table

    rows = read_scores_csv(run.directory / SCORES)
    if run.replaced:
        logging.getLogger("crowdbot").info(
            "note: it replaces a run that was recorded differently: %s", ", ".join(run.replaced)
        )
    if as_json:
        scores = [
            {
                "metric": r.score.metric,
                "variant": r.score.variant,
                "value": r.score.value,
                "unit": r.score.unit,
                "status": r.score.status,
                "reason": r.score.reason,
                "lower": r.score.lower,
                "upper": r.score.upper,
            }
            for r in rows
        ]
        say(
            json.dumps(
                {**run.record.document(), "directory": str(run.directory), "reused": run.reused,
                 "replaced": list(run.replaced), "scores": scores},
                indent=2,
            )
        )  # fmt: skip
        return
    from rich.console import Console

    console = Console()
    shown = headlines([r.score for r in rows])
    if run.record.people_alone:  # nothing about a robot has a value
        shown = [score for score in shown if score.status == "ok"]
    if shown:
        console.print(scores_table(shown))
    console.print(_summary(run), highlight=False)
    console.print(f"all variants: {run.directory / SCORES}", soft_wrap=True, highlight=False)
    console.print(f"replay: {run.directory / REPLAY}", soft_wrap=True, highlight=False)


def _summary(run: Run) -> str:
    from crowdbot.core.runs.provenance import remarks

    record = run.record
    when = record.goal_time or record.sim_time
    ending = record.status.sentence.format(t=when)
    if record.people_alone:
        ending = f"people walked alone for {record.sim_time:.1f} s"
    speed = f"{record.real_time_factor:.1f} times real time"
    note = "; was complete already, --force runs it again" if run.reused else f" ({speed})"
    who = f"{record.scenario} · {record.planner.name} · seed {record.seed}"
    flags = "".join(f"; {flag.lower()}" for flag in remarks(record))
    return f"{who}: {ending}{note}{flags}"
