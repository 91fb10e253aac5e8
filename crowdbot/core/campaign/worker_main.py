"""A worker process: receives jobs through a socket, reports progress, ends with its parent.

A thread sends a heartbeat every second. Code that holds the interpreter lock stops it; the silence
then shows the parent that a planner hangs where no watchdog in this process can act.
"""

from __future__ import annotations

import ctypes
import faulthandler
import os
import signal
import sys
import threading
import time
from multiprocessing.connection import Connection
from typing import Any, NamedTuple

from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.worker_memory import return_freed_memory
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.support.skip_final_gc import end_without_collecting

#: Seconds between heartbeats.
BEAT = 1.0
_SEND_PROGRESS = 0.25
_PR_SET_PDEATHSIG = 1


class Heartbeat(NamedTuple):
    """Message: the process is alive; ``progress`` of the job, None before it starts.

    ``patient``: True while the planner may load a model, or scores are computed.
    """

    progress: Progress | None
    patient: bool


class PlannerHung(NamedTuple):
    """Message: the planner ignores every interruption, so the process ends now."""


def main(handle: int, parent: int) -> None:
    """Execute jobs until the other end of the socket is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # only the parent handles Ctrl-C
    _die_with(parent)
    faulthandler.enable()
    end_without_collecting()
    line = _Line(Connection(handle))
    threading.Thread(target=line.beat, daemon=True).start()
    from crowdbot.core.campaign.execute import execute

    while True:
        try:
            job = line.connection.recv()
        except EOFError:
            return
        line.progress = None
        done = execute(job, line.report, line.hung)
        line.progress = None
        line.send(done)
        return_freed_memory()


class _Line:
    """The socket, shared by several threads."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self.progress: Progress | None = None
        self._lock = threading.Lock()
        self._sent = 0.0

    def send(self, message: Heartbeat | PlannerHung | JobOutcome) -> None:
        """Send a message; if the parent is gone, end the process."""
        with self._lock:
            try:
                self.connection.send(message)
            except OSError:
                os._exit(1)

    def beat(self) -> None:
        """Send heartbeats until the process ends."""
        while True:
            self._beat()
            time.sleep(BEAT)

    def report(self, progress: Progress) -> None:
        """Report progress, called by the simulation."""
        self.progress = progress
        now = time.monotonic()
        if now >= self._sent + _SEND_PROGRESS or progress.t >= progress.limit:
            self._sent = now
            self._beat()

    def hung(self) -> None:
        """Report a hang, called by the watchdog's thread if a planner cannot be interrupted."""
        self.send(PlannerHung())
        os._exit(3)

    def _beat(self) -> None:
        progress = self.progress
        ended = progress is not None and progress.t >= progress.limit
        self.send(Heartbeat(progress, patient=progress is None or ended))


def _die_with(parent: int) -> None:
    """Die with the parent: at once on Linux, elsewhere at the next heartbeat."""
    if sys.platform == "linux":
        libc: Any = ctypes.CDLL(None)
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # the parent died before this line
        os._exit(1)


__all__ = ["BEAT", "Heartbeat", "Job", "JobOutcome", "PlannerHung", "main"]
