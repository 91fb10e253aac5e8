"""The interface of worker pools, and the pool of local processes."""

from __future__ import annotations

from collections.abc import Sequence
from multiprocessing.connection import wait
from typing import NamedTuple, Protocol

from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.worker_process import WorkerProcess
from crowdbot.core.runs.outcome import Progress


class RunningJob(NamedTuple):
    """A job that a worker is executing; ``progress`` if known."""

    job: Job
    progress: Progress | None


class WorkerPool(Protocol):
    """Executes jobs, several at a time."""

    def free_slots(self) -> int:
        """Return the number of jobs that can be submitted now."""

    def submit(self, job: Job) -> None:
        """Start a job; there must be a free slot."""

    def finished(self, timeout: float) -> list[JobOutcome]:
        """Return finished jobs; wait up to ``timeout`` seconds for one."""

    def busy(self) -> Sequence[RunningJob]:
        """Return running jobs, for display."""

    def close(self) -> None:
        """End all workers at once."""


class LocalWorkerPool:
    """A pool of processes on this machine."""

    def __init__(self, size: int) -> None:
        self._workers = [WorkerProcess() for _ in range(size)]

    def free_slots(self) -> int:
        """Return the number of idle processes."""
        return sum(w.job is None for w in self._workers)

    def submit(self, job: Job) -> None:
        """Start a job."""
        next(w for w in self._workers if w.job is None).submit(job)

    def finished(self, timeout: float) -> list[JobOutcome]:
        """Return finished jobs."""
        at_work = [w for w in self._workers if w.job is not None]
        wait([w.connection for w in at_work], timeout)
        return [done for w in at_work if (done := w.poll()) is not None]

    def busy(self) -> list[RunningJob]:
        """Return running jobs."""
        return [RunningJob(w.job, w.progress) for w in self._workers if w.job is not None]

    def close(self) -> None:
        """End all processes."""
        for worker in self._workers:
            worker.stop()
