"""Those who do the jobs of a campaign on this machine; the contract for any other crew."""

from __future__ import annotations

from collections.abc import Sequence
from multiprocessing.connection import wait
from typing import NamedTuple, Protocol

from crowdbot.core.sim.campaign.job import Done, Job
from crowdbot.core.sim.campaign.process import WorkerProcess
from crowdbot.core.sim.outcome import Progress


class Busy(NamedTuple):
    """Somebody at work; ``progress`` where it is known."""

    job: Job
    progress: Progress | None


class Crew(Protocol):
    """Takes jobs and gives back how they ended."""

    def places(self) -> int:
        """How many more jobs may be given now."""

    def give(self, job: Job) -> None:
        """Start a job; there must be a place."""

    def finished(self, timeout: float) -> list[Done]:
        """Jobs that ended; waits up to ``timeout`` seconds for news."""

    def busy(self) -> Sequence[Busy]:
        """Who does what, for people to look at."""

    def close(self) -> None:
        """End everybody at once."""


class LocalCrew:
    """Processes on this machine."""

    def __init__(self, size: int) -> None:
        self._workers = [WorkerProcess() for _ in range(size)]

    def places(self) -> int:
        """How many have nothing to do."""
        return sum(w.job is None for w in self._workers)

    def give(self, job: Job) -> None:
        """Start a job."""
        next(w for w in self._workers if w.job is None).give(job)

    def finished(self, timeout: float) -> list[Done]:
        """Jobs that ended."""
        at_work = [w for w in self._workers if w.job is not None]
        wait([w.connection for w in at_work], timeout)
        return [done for w in at_work if (done := w.news()) is not None]

    def busy(self) -> list[Busy]:
        """Who does what."""
        return [Busy(w.job, w.progress) for w in self._workers if w.job is not None]

    def close(self) -> None:
        """End all processes."""
        for worker in self._workers:
            worker.stop()
