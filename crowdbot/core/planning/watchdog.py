"""A watchdog over planner steps: one thread for all steps, two cheap stores for each.

A step that runs too long is first interrupted: in the main thread by a private signal, whose
handler raises `PlannerHungError` there and also ends a sleep; in another thread by an asynchronous
exception, which acts on Python code only. If the step swallows that and goes on, ``on_hang`` is
called from the watchdog's thread; it is expected to end the process. Compiled code that keeps the
interpreter lock keeps it from the watchdog, too, and cannot be ended from within the process.
A step of the main thread in which somebody looks around with pdb may take as long as it likes.
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

#: Looks at the deadline so often, s.
POLL = 0.1
#: After so many seconds a step has hung.
STEP_LIMIT = 10.0
_SIGNAL: int | None = getattr(signal, "SIGUSR2", None)


class Watchdog:
    """Guards one step at a time: ``with watchdog: planner.step(obs)``.

    Args:
        limit: seconds that a step may take.
        grace: seconds after the interruption until ``on_hang`` is called.
        on_hang: called once, from the watchdog's thread. While a step runs in a planner host,
            ``sys.stdout`` is redirected; ``sys.__stdout__`` is the real one.
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
        """Start the thread; the first step does it otherwise. Again after `close` is fine."""
        if self._thread is not None:
            return
        self._closed.clear()
        if _SIGNAL is not None and threading.current_thread() is threading.main_thread():
            self._previous = signal.signal(_SIGNAL, self._on_signal)
            self._handles_signal = True
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread and give the signal back."""
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
        # Read last: a step that swallowed the interruption and came back late has hung as well.
        if self._fired and not isinstance(error, PlannerHungError):
            raise self._error() from error

    @contextmanager
    def patience(
        self, limit: float, progress: Callable[[], object] | None = None
    ) -> Iterator[None]:
        """Another limit for what runs inside, s.

        Where ``progress()`` has changed when the time is over, there is as much time again: what
        compiles on a busy machine does not hang.
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
        """The thread: interrupt a late step, then report it if it goes on."""
        interrupted: float | None = None  # the deadline of the step that was interrupted
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
        """Whether something was done since the time was counted, which then begins anew."""
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
        """In the main thread. The step may have returned since the signal was sent."""
        if self._late() and _debugging():
            self._deadline = None
        elif self._late():
            self._fired = True
            raise self._error()
        if callable(self._previous):
            self._previous(number, frame)


def _debugging() -> bool:
    """Whether pdb, or what is made from it, traces this thread. Coverage traces, too."""
    return isinstance(getattr(sys.gettrace(), "__self__", None), bdb.Bdb)
