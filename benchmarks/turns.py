"""Runs that take turns, a simulated second each, in a process of their own each.

A machine with other work to do is slower or faster by a third from one second to the next, so
that runs after one another differ by more than what they do. Runs in turns meet the same machine:
of each second the least CPU time of several counts, and their sums compare to about 1 %.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from pydrake.systems.framework import Context

from crowdbot.core.sim.loggers.recorder import Recorder

Job = Callable[[], object]
#: Seconds at the start that do not count: they prepare templates and fill caches.
WARM_UP = 2


def in_turns(jobs: Mapping[str, Job], repeat: int) -> dict[str, float]:
    """CPU time of each job, s: the sum of the least of each simulated second.

    Args:
        jobs: runs of equal length, longer than `WARM_UP`; they can be pickled.
        repeat: how often they are run.
    """
    process, pipes = get_context("spawn").Process, {}
    workers = []
    for name, job in jobs.items():
        pipes[name], theirs = get_context("spawn").Pipe()
        workers.append(process(target=_work, args=(job, repeat, theirs), daemon=True))
        workers[-1].start()
        theirs.close()
    rounds = [_round(pipes) for _ in range(repeat)]
    for worker in workers:
        worker.join()
    return {
        name: sum(map(min, zip(*(spent[name][WARM_UP:] for spent in rounds), strict=True)))
        for name in jobs
    }


def _round(pipes: Mapping[str, Connection]) -> dict[str, list[float]]:
    """CPU times of the seconds of one run of each job."""
    spent: dict[str, list[float]] = {name: [] for name in pipes}
    running = list(pipes)
    while running:
        for name in list(running):
            pipes[name].send(None)  # its turn
            seconds: float | None = pipes[name].recv()
            if seconds is None:
                running.remove(name)
            else:
                spent[name].append(seconds)
    return spent


def _work(job: Job, repeat: int, pipe: Connection) -> None:
    """Run a job when it is its turn, and say what each second took; None at its end."""
    if hasattr(os, "sched_setaffinity"):  # processors may differ in what else they do
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    flush, since = Recorder._publish, 0.0

    def publish(self: Any, context: Context) -> None:
        nonlocal since
        flush(self, context)
        pipe.send(time.process_time() - since)
        pipe.recv()
        since = time.process_time()

    Recorder._publish = publish  # type: ignore[method-assign]
    for _ in range(repeat):
        pipe.recv()
        since = time.process_time()
        job()
        pipe.send(None)
