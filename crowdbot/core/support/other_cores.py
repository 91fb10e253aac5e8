"""Keep threads off the core of the thread that waits for them.

Linux may wake a thread on the core of the thread that woke it, above all in virtual machines whose
cores share no cache. It moves one of them away only after milliseconds, too late for shorter work,
which then runs sequentially.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Sequence
from contextlib import suppress

#: No core: that of the asking thread is not known yet.
_UNKNOWN = -1


class OtherCores:
    """Threads that may use all cores of this process but that of the calling thread.

    Args:
        threads: their native identifiers.
    """

    def __init__(self, threads: Sequence[int]) -> None:
        self._threads, self._core = tuple(threads), _UNKNOWN
        self._core_now = _core_now() if threads else None
        self._allowed = os.sched_getaffinity(0) if self._core_now else set()

    def leave_this_one(self) -> None:
        """Move the threads off the caller's present core, if there is another core."""
        if self._core_now is None or (core := self._core_now()) == self._core:
            return
        self._core = core
        if others := self._allowed - {core}:
            for thread in self._threads:
                with suppress(OSError):  # it has ended, or a container forbids it
                    os.sched_setaffinity(thread, others)


def _core_now() -> Callable[[], int] | None:
    """Return a function that returns the current core; None without one, as on macOS."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    found: Callable[[], int] | None = getattr(ctypes.CDLL(None), "sched_getcpu", None)
    return found
