"""Shared code of commands that run in their own process: Drake, Ctrl-C, output."""

from __future__ import annotations

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
    interrupted = running = False

    def handler(number: int, frame: FrameType | None) -> None:
        nonlocal interrupted
        del number, frame
        if interrupted or not running:
            raise UserInterrupt
        interrupted = True

    def stop() -> bool:
        nonlocal running
        running = True
        return interrupted

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


def print_run(run: Run, *, as_json: bool, everything: bool) -> None:
    """Print the result on stdout, and errors last, on stderr."""
    from crowdbot.cli.output.run_summary import print_result

    print_result(run, as_json=as_json, everything=everything)
    if run.failed:
        sys.stdout.flush()
        say(f"error: {run.record.reason}", err=True)
