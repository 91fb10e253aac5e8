"""Progress of simulations on stderr: a bar on a terminal, otherwise a line per stage."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn

from crowdbot.cli.output.say import say
from crowdbot.core.support.compile_cache import USUAL, compiled, nothing_compiled
from crowdbot.core.support.cores import available_cores

if TYPE_CHECKING:
    from crowdbot.core.runs.outcome import Progress as Report

_COMPILES = "the first run compiles"
#: Longest time without output before a reason is printed, s.
PATIENCE = 1.0
_LINE_EVERY = 10.0


@contextmanager
def show_progress() -> Iterator[Callable[[Report], None]]:
    """Yield a function that a simulation calls with its progress."""
    if logging.getLogger("crowdbot").level > logging.INFO:
        yield _silent
    elif sys.stderr.isatty():
        with _bars() as bars:
            yield bars
    else:
        with _excuse():
            yield _Lines()


@contextmanager
def _excuse() -> Iterator[None]:
    """Print that kernels are being compiled, if the context lasts and nothing is compiled yet."""
    done = threading.Event()
    if nothing_compiled():
        threading.Thread(target=_tell_of_compiling, args=(done,), daemon=True).start()
    try:
        yield
    finally:
        done.set()


def _tell_of_compiling(done: threading.Event) -> None:
    """After a short wait, print that kernels are being compiled, then occasional progress."""
    if done.wait(PATIENCE):
        return
    time = "half a minute" if available_cores() > 1 else "a minute"
    say(f"preparing: {_COMPILES}, about {time}", err=True)
    before = 0
    while not done.wait(_LINE_EVERY):
        now = compiled()
        if now == before:
            return
        say(f"preparing: {_how_far(now)}", err=True)
        before = now


def _how_far(count: int) -> str:
    of = f" of about {USUAL}" if count < USUAL else ""
    return f"{count}{of} functions compiled"


@contextmanager
def _bars() -> Iterator[Callable[[Report], None]]:
    columns = (
        TextColumn("{task.description:<12}"),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[state]}"),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        first, done = nothing_compiled(), threading.Event()
        preparing = progress.add_task(
            "preparing", total=USUAL if first else None, state=_COMPILES if first else ""
        )

        def follow() -> None:
            while not done.wait(0.5):
                count = compiled()
                state = f"{_COMPILES}: {_how_far(count)}"
                progress.update(preparing, completed=min(count, USUAL), state=state)

        if first:
            threading.Thread(target=follow, daemon=True).start()
        tasks: dict[str, TaskID] = {}

        def show(report: Report) -> None:
            done.set()
            progress.update(preparing, visible=False)
            if report.stage not in tasks:
                tasks[report.stage] = progress.add_task(report.stage, total=report.limit, state="")
            progress.update(tasks[report.stage], completed=report.t, state=_state(report))

        try:
            yield show
        finally:
            done.set()


def _state(report: Report) -> str:
    distance = "" if report.distance is None else f"  {report.distance:5.1f} m to go"
    factor = f"{report.real_time_factor:5.1f} × real time"
    left = f"  at most {clock(_left(report))} left" if report.real_time_factor > 0.0 else ""
    return f"{report.t:6.1f} / {report.limit:.0f} s  {factor}{distance}{left}"


def _left(report: Report) -> float:
    """Return the wall time until the run's limit, s."""
    return max(0.0, report.limit - report.t) / report.real_time_factor


def clock(seconds: float) -> str:
    """Return a time in minutes and seconds, such as 2:05."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


def _silent(report: Report) -> None:
    del report


class _Lines:
    """Prints a line when a stage begins, and every 30 simulated seconds."""

    def __init__(self) -> None:
        self._stage = ""
        self._next = 0.0

    def __call__(self, report: Report) -> None:
        if report.stage != self._stage:
            self._stage, self._next = report.stage, 0.0
        if report.t >= self._next:
            self._next = report.t + 30.0
            distance = "" if report.distance is None else f", {report.distance:.1f} m to go"
            print(
                f"{report.stage}: {report.t:.0f} of {report.limit:.0f} s, "
                f"{report.real_time_factor:.1f} × real time{distance}",
                file=sys.stderr,
            )
