"""A watchdog over planner steps: one thread for all steps, two cheap stores per step.

A step that runs too long is first interrupted: in the main thread by a private signal, whose
handler raises `PlannerHungError` there and also ends a sleep; in another thread by an asynchronous
exception, which acts on Python code only. If the step catches that and continues, ``on_hang`` is
called from the watchdog's thread; it is expected to end the process. Compiled code that holds the
interpreter lock also blocks the watchdog and cannot be ended from within the process. A step of the
main thread under pdb has no limit.
"""

from __future__ import annotations

import bdb
import ctypes
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any

from crowdbot.errors import PlannerHungError

#: Interval of deadline checks, s.
POLL = 0.1
#: Seconds after which a step counts as hung.
STEP_LIMIT = 10.0
_SIGNAL: int | None = getattr(signal, "SIGUSR2", None)


class Watchdog:
    """Guards one step at a time: ``with watchdog: planner.step(obs)``.

    Args:
        limit: seconds that a step may take.
        grace: seconds after the interruption until ``on_hang`` is called.
        on_hang: callback, called once from the watchdog's thread. While a step runs in a planner
            host, ``sys.stdout`` is redirected; ``sys.__stdout__`` is the real one.
    """

    def __init__(
        self,
        limit: float = STEP_LIMIT,
        grace: float = 2.0,
        on_hang: Callable[[], object] | None = None,
    ) -> None:
        self.limit, self.grace, self.on_hang = limit, grace, on_hang
        self._progress: Callable[[], object] | None = None
        self._seen: object = None
        self._deadline: float | None = None
        self._extra = 0.0
        self._fired = False
        self._worker = 0
        self._thread: threading.Thread | None = None
        self._closed = threading.Event()
        self._previous: Any = None
        self._handles_signal = False
        self._lock = threading.Lock()

    def start(self) -> None:
        """Start the thread, else the first step starts it. Restarting after `close` is allowed."""
        if self._thread is not None:
            return
        self._closed.clear()
        if _SIGNAL is not None and threading.current_thread() is threading.main_thread():
            self._previous = signal.signal(_SIGNAL, self._on_signal)
            self._handles_signal = True
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread and restore the signal."""
        if self._thread is None:
            return
        self._closed.set()
        self._thread.join()
        self._thread = None
        if self._handles_signal and _SIGNAL is not None:
            signal.signal(_SIGNAL, self._previous or signal.SIG_DFL)
            self._handles_signal = False

    def __enter__(self) -> Watchdog:
        if self._thread is None:
            self.start()
        self._worker = threading.get_ident()
        self._fired = False
        if self._progress is not None:
            self._seen = self._progress()
        self._extra = 0.0
        self._deadline = time.monotonic() + self.limit
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._deadline = None
        # Read last: a step that caught the interruption and returned late also counts as hung.
        if self._fired and not isinstance(error, PlannerHungError):
            raise self._error() from error

    @contextmanager
    def patience(
        self, limit: float, progress: Callable[[], object] | None = None
    ) -> Iterator[None]:
        """Use another limit in the context, s.

        If ``progress()`` has changed when the time is over, the time starts again: slow compilation
        is not a hang.
        """
        usual, self.limit, self._progress = self.limit, limit, progress
        try:
            yield
        finally:
            self.limit, self._progress = usual, None

    def _error(self) -> PlannerHungError:
        return PlannerHungError(f"did not return within {self.limit:g} s")

    def _late(self, by: float = 0.0) -> bool:
        deadline = self._deadline
        return deadline is not None and time.monotonic() >= deadline + self._extra + by

    def _watch(self) -> None:
        """Run the thread: interrupt a late step, then report it if it continues."""
        interrupted: float | None = None  # deadline of the interrupted step
        while not self._closed.wait(min(POLL, self.limit / 2.0)):
            if not self._late() or self._goes_on():
                interrupted = None
            elif interrupted != self._deadline:
                interrupted = self._deadline
                self._interrupt()
            elif self._late(self.grace) and self.on_hang is not None:
                self.on_hang()
                return

    def _goes_on(self) -> bool:
        """Return True if there was progress since the time started, and restart it."""
        if self._progress is None or (now := self._progress()) == self._seen:
            return False
        self._seen, self._extra = now, self._extra + self.limit
        return True

    def _interrupt(self) -> None:
        if self._handles_signal and self._worker == threading.main_thread().ident:
            assert _SIGNAL is not None
            signal.pthread_kill(self._worker, _SIGNAL)
        elif self._late():
            self._fired = True
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(self._worker), ctypes.py_object(PlannerHungError)
            )

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        """Handle the signal in the main thread. The step may have returned since it was sent."""
        if self._late() and _debugging():
            self._deadline = None
        elif self._late():
            self._fired = True
            raise self._error()
        if callable(self._previous):
            self._previous(number, frame)


def _debugging() -> bool:
    """Return True if pdb, or a tool based on it, traces this thread. Coverage traces, too."""
    return isinstance(getattr(sys.gettrace(), "__self__", None), bdb.Bdb)
