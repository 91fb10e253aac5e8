"""A worker pool on many machines: workers of an existing Dask scheduler.

Every Dask worker keeps one process of ours for each of its threads, so that a planner that hangs or
crashes ends that process and not the worker. Other workers take over a lost worker's jobs;
published results are found by their hash, so nothing is repeated.
"""

from __future__ import annotations

import queue
import re
import socket
import threading
import time
import uuid
from dataclasses import replace
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.worker_pool import RunningJob
from crowdbot.core.campaign.worker_process import WorkerProcess
from crowdbot.core.runs import provenance
from crowdbot.errors import InputError, MissingLibraryError, SimulationError

#: Timeout for the scheduler and a first worker, s.
_PATIENCE = 30.0
#: Timeout for a connection to the address, s.
_LISTENING = 5.0
_ADDRESS = re.compile(
    r"(?:(?:tcp|tls)://)?(?P<host>\[[0-9a-fA-F:]+\]|[^:/\s\[\]]+):(?P<port>\d{1,5})"
)
_own = threading.local()


def execute_job(job: Job, versions: dict[str, str]) -> JobOutcome:
    """Execute a job in a Dask worker."""
    if (found := provenance.versions()) != versions:
        return _refused(job, _difference(versions, found))
    if not hasattr(_own, "worker"):
        _own.worker = WorkerProcess()
    worker: WorkerProcess = _own.worker
    worker.submit(job)
    while True:
        wait([worker.connection], 0.25)
        if (done := worker.poll()) is not None:
            return done


def probe(token: str) -> tuple[dict[str, str], bool]:
    """Return a worker's versions, and True if it sees a file; runs in a Dask worker."""
    return provenance.versions(), Path(token).exists()


def _await_listener(address: str) -> None:
    """Check that the address accepts connections, since Dask's client would retry for minutes.

    Raises:
        InputError: it does not, or it is not an address.
    """
    found = _ADDRESS.fullmatch(address)
    if found is None:
        raise InputError(f"--cluster {address}: write tcp://HOST:PORT")
    place = found["host"].strip("[]"), min(int(found["port"]), 65535)
    end = time.monotonic() + _LISTENING
    while True:
        try:
            socket.create_connection(place, timeout=_LISTENING).close()
            return
        except OSError as error:
            if time.monotonic() >= end or isinstance(error, socket.gaierror):
                text = f"--cluster {address}: no Dask scheduler answers: {error.strerror or error}"
                raise InputError(text) from error
            time.sleep(0.2)


class DaskWorkerPool:
    """The worker processes of one Dask scheduler.

    Args:
        address: ``tcp://HOST:PORT`` of the scheduler.
        out: root of the results; every worker must see it under this path.

    Attributes:
        size: number of all workers' threads at the start.

    Raises:
        MissingLibraryError: ``distributed`` is not installed.
        InputError: it is not an address, no scheduler or no worker answers, versions differ, or a
            worker does not see the folder.
    """

    def __init__(self, address: str, out: Path) -> None:
        try:
            import distributed
        except ImportError as error:
            text = "--cluster needs Dask; install it with pip install 'crowdbot[cluster]'"
            raise MissingLibraryError(text) from error
        _await_listener(address)
        try:
            connect: Any = distributed.Client  # untyped
            self._client: Any = connect(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise InputError(f"--cluster {address}: no Dask scheduler answers") from error
        self._address, self._versions = address, provenance.versions()
        self._futures: dict[str, tuple[Job, Any]] = {}
        self._ended: queue.Queue[tuple[str, Any]] = queue.Queue()
        try:
            self._check(out)
        except BaseException:
            self._client.close()
            raise
        self.size = self._threads()

    def free_slots(self) -> int:
        """Return the free slots; one job per thread is queued, so that no worker waits."""
        return max(0, 2 * max(1, self._threads()) - len(self._futures))

    def submit(self, job: Job) -> None:
        """Submit a job as a task with a key of its own, since Dask merges tasks of equal keys."""
        key = f"crowdbot-{job.key}-{uuid.uuid4().hex[:8]}"
        future = self._client.submit(execute_job, job, self._versions, key=key, pure=False)
        self._futures[job.key] = (job, future)
        future.add_done_callback(lambda f, k=job.key: self._ended.put((k, f)))

    def finished(self, timeout: float) -> list[JobOutcome]:
        """Return finished jobs.

        Raises:
            SimulationError: the scheduler is gone.
        """
        if self._client.status not in ("running", "connecting"):
            self._lost()
        ended = []
        try:
            ended.append(self._ended.get(timeout=timeout))
            while True:
                ended.append(self._ended.get_nowait())
        except queue.Empty:
            pass
        return [self._done(key, future) for key, future in ended if key in self._futures]

    def busy(self) -> list[RunningJob]:
        """Return submitted jobs; the scheduler does not report their progress."""
        return [RunningJob(job, None) for job, _ in self._futures.values()]

    def close(self) -> None:
        """Cancel submitted jobs, and leave the scheduler running."""
        self._client.cancel([future for _, future in self._futures.values()], force=True)
        self._client.close()

    def _done(self, key: str, future: Any) -> JobOutcome:
        job, _ = self._futures.pop(key)
        if future.status in ("cancelled", "lost"):
            self._lost()
        if future.status == "error":
            error = future.exception()
            text = f"{type(error).__name__}: {error}"
            return JobOutcome(
                key=key, error=text, exit_code=SimulationError.exit_code, traceback=text
            )
        done: JobOutcome = future.result()
        return replace(done, key=job.key)

    def _lost(self) -> None:
        raise SimulationError(
            f"--cluster {self._address}: the scheduler is gone; what is finished stays, and the "
            "same command goes on"
        )

    def _threads(self) -> int:
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        return sum(int(w["nthreads"]) for w in workers.values())

    def _check(self, out: Path) -> None:
        self._wait()
        out.mkdir(parents=True, exist_ok=True)
        token = out / f".campaign-{uuid.uuid4().hex}"
        token.touch()
        try:
            answers = self._client.run(probe, str(token))
        finally:
            token.unlink(missing_ok=True)
        for worker, (versions, sees) in answers.items():
            if versions != self._versions:
                raise InputError(f"{worker}: {_difference(self._versions, versions)}")
            if not sees:
                raise InputError(f"{worker} does not see {out}: the file system must be shared")

    def _wait(self) -> None:
        end = time.monotonic() + _PATIENCE
        while not self._threads():
            if time.monotonic() > end:
                raise InputError(
                    f"--cluster {self._address}: the scheduler has no workers; start some with "
                    f"'dask worker {self._address} --nthreads 1 --nworkers 2'"
                )
            time.sleep(0.2)


def _difference(ours: dict[str, str], theirs: dict[str, str]) -> str:
    found = [f"{n} {theirs.get(n, 'none')} instead of {v}" for n, v in ours.items()
             if theirs.get(n) != v]  # fmt: skip
    return f"the worker has {', '.join(found)}; runs would not be comparable"


def _refused(job: Job, why: str) -> JobOutcome:
    return JobOutcome(key=job.key, error=f"InputError: {why}", exit_code=1, traceback=why)
