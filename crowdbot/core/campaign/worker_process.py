"""One worker process, as used by its parent: sent jobs, monitored, replaced if it dies."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any

from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.worker_main import Heartbeat, PlannerHung
from crowdbot.core.planning.host import RESET_LIMIT
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.runs.outcome import Progress
from crowdbot.errors import PlannerHungError, SimulationError

#: Number of jobs after which a process is replaced: libraries and plugins may leak.
RECYCLE = 200
#: Number of attempts at a job whose process dies.
TRIES = 3
#: Additional time beyond the watchdog's limits, for a busy machine, s.
_SLACK = 5.0
_TAIL = 20_000
_ONE_THREAD = (
    "NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
)  # fmt: skip
#: A step of Drake's contact solver allocates and frees hundreds of small objects, and glibc caches
#: seven freed ones per size; with more the plant's step is a quarter faster. In large pages, where
#: the system offers them on request, a run takes 5 % less. Freed memory, of which scores need
#: 100 MB, is kept for the next run; given back, it would be filled with zeros again, which takes
#: 0.1 s per run. The C library reads this at process start; only glibc does, and before 2.35 it has
#: no large pages.
_ALLOCATOR = {
    "GLIBC_TUNABLES": "glibc.malloc.tcache_count=400:glibc.malloc.hugetlb=1:"
    "glibc.malloc.trim_threshold=536870912:glibc.malloc.mmap_threshold=33554432"
}
_START = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]); "
    "from crowdbot.core.support.gc_throttle import throttle_gc; throttle_gc(); "
    "from crowdbot.core.campaign.worker_main import main; "
    "main(int(sys.argv[2]), int(sys.argv[3]))"
)


def worker_environment() -> dict[str, str]:
    """Return the environment of a worker: one thread, a larger allocator cache and large pages."""
    return {**_ALLOCATOR, **os.environ, **dict.fromkeys(_ONE_THREAD, "1")}


class WorkerProcess:
    """A warm process that executes one job at a time, started on demand.

    Attributes:
        job: its job.
        progress: progress of the job.
    """

    def __init__(self) -> None:
        self.job: Job | None = None
        self.progress: Progress | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: Connection | None = None
        self._output: Any = None
        self._jobs = self._deaths = 0
        self._began = self._heard = 0.0
        self._patient = True

    @property
    def connection(self) -> Connection:
        """Return the connection of a busy process, readable when there is a message."""
        assert self._connection is not None
        return self._connection

    @property
    def pid(self) -> int | None:
        """Return the process's id, if it runs."""
        return self._process.pid if self._process else None

    def submit(self, job: Job) -> None:
        """Start a job; the process must be idle."""
        assert self.job is None
        self.job, self.progress, self._deaths = job, None, 0
        self._began = time.monotonic()
        self._send()

    def poll(self) -> JobOutcome | None:
        """Read messages; return the outcome of the job once it has ended, otherwise None.

        A dead process is replaced and repeats the job, with at most `TRIES` attempts.
        """
        try:
            while self.connection.poll():
                message = self.connection.recv()
                if isinstance(message, JobOutcome):
                    return self._finish(message)
                if isinstance(message, PlannerHung):
                    return self._give_up(PlannerHungError("the planner swallowed interruptions"))
                assert isinstance(message, Heartbeat)
                self._heard, self._patient = time.monotonic(), message.patient
                self.progress = message.progress
        except (EOFError, OSError):
            return self._died()
        return self._give_up(self._silence()) if self._is_silent() else None

    def stop(self) -> None:
        """End the process, regardless of its state."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        if self._connection is not None:
            self._connection.close()
        if self._output is not None:
            self._output.close()
        self._process = self._connection = self._output = None
        self._jobs = 0

    def _send(self) -> None:
        if self._process is None or self._process.poll() is not None or self._jobs >= RECYCLE:
            self.stop()
            self._start()
        self._jobs += 1
        self._heard, self._patient = time.monotonic(), True
        self._output.truncate(0)
        try:
            self.connection.send(self.job)
        except OSError:
            return  # it died, which the next poll detects

    def _start(self) -> None:
        """Start a fresh interpreter: threads do not survive a fork, and no script is run again."""
        ours, theirs = Pipe()
        # Its output must not get into tables; the end of it shows why it died.
        self._output = tempfile.TemporaryFile(mode="ab+")  # noqa: SIM115
        command = [sys.executable, "-c", _START, json.dumps(sys.path)]
        with theirs:
            self._process = subprocess.Popen(
                [*command, str(theirs.fileno()), str(os.getpid())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=self._output,
                stderr=self._output,
                env=worker_environment(),
            )
        self._connection = ours

    def _finish(self, done: JobOutcome) -> JobOutcome:
        self.job = self.progress = None
        return done

    def _died(self) -> JobOutcome | None:
        """Repeat the job in a new process; return its failure after `TRIES` dead processes."""
        assert self._process is not None
        self._deaths += 1
        code = self._process.wait()
        if self._deaths < TRIES:
            self.stop()
            self._send()
            return None
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        error = SimulationError(f"the process died {TRIES} times ({how})")
        return self._give_up(error)

    def _is_silent(self) -> bool:
        limit = RESET_LIMIT if self._patient else Watchdog().limit
        return time.monotonic() > self._heard + limit + Watchdog().grace + _SLACK

    def _silence(self) -> PlannerHungError:
        silent = time.monotonic() - self._heard
        return PlannerHungError(
            f"the planner did not return for {silent:.0f} s and could not be interrupted; "
            "the process was ended"
        )

    def _give_up(self, error: PlannerHungError | SimulationError) -> JobOutcome:
        assert self.job is not None
        key, output = self.job.key, self._tail()
        self.stop()
        return self._finish(
            JobOutcome(
                key=key,
                error=f"{type(error).__name__}: {error}",
                exit_code=error.exit_code,
                traceback=output,
                wall_time=time.monotonic() - self._began,
            )
        )

    def _tail(self) -> str:
        size = self._output.seek(0, os.SEEK_END)
        self._output.seek(max(0, size - _TAIL))
        return str(self._output.read().decode(errors="replace"))
