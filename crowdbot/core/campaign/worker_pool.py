"""The contract of worker pools, and the one whose workers are processes on this machine."""

from __future__ import annotations

from collections.abc import Sequence
from multiprocessing.connection import wait
from typing import NamedTuple, Protocol

from crowdbot.core.campaign.job import Done, Job
from crowdbot.core.campaign.worker_process import WorkerProcess
from crowdbot.core.runs.outcome import Progress


class Busy(NamedTuple):
    """A job that a worker executes now; ``progress`` where it is known."""

    job: Job
    progress: Progress | None


class WorkerPool(Protocol):
    """Executes jobs, several at a time."""

    def free_slots(self) -> int:
        """How many more jobs may be submitted now."""

    def submit(self, job: Job) -> None:
        """Start a job; there must be a free slot."""

    def finished(self, timeout: float) -> list[Done]:
        """Jobs that ended; waits up to ``timeout`` seconds for one."""

    def busy(self) -> Sequence[Busy]:
        """Jobs that are executed now, for people to look at."""

    def close(self) -> None:
        """End all workers at once."""


class LocalWorkerPool:
    """Processes on this machine."""

    def __init__(self, size: int) -> None:
        self._workers = [WorkerProcess() for _ in range(size)]

    def free_slots(self) -> int:
        """How many processes have nothing to do."""
        return sum(w.job is None for w in self._workers)

    def submit(self, job: Job) -> None:
        """Start a job."""
        next(w for w in self._workers if w.job is None).submit(job)

    def finished(self, timeout: float) -> list[Done]:
        """Jobs that ended."""
        at_work = [w for w in self._workers if w.job is not None]
        wait([w.connection for w in at_work], timeout)
        return [done for w in at_work if (done := w.poll()) is not None]

    def busy(self) -> list[Busy]:
        """Jobs that are executed now."""
        return [Busy(w.job, w.progress) for w in self._workers if w.job is not None]

    def close(self) -> None:
        """End all processes."""
        for worker in self._workers:
            worker.stop()
