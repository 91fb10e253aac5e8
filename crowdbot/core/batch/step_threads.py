"""Threads that share short work with the calling thread."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from queue import SimpleQueue

from crowdbot.core.support.other_cores import OtherCores

#: A part's number, the work, and where its end is told; None ends a thread.
_Order = tuple[int, Callable[[int], None], "SimpleQueue[BaseException | None]"] | None


class StepThreads:
    """Threads for work of less than a millisecond.

    A pool of `concurrent.futures` costs 0.1 ms for each part; here the calling thread does one part
    itself, and each other thread is woken through a queue.

    Args:
        helpers: number of threads besides the calling one.
    """

    def __init__(self, helpers: int) -> None:
        self._orders: list[SimpleQueue[_Order]] = [SimpleQueue() for _ in range(helpers)]
        threads = [_started(orders) for orders in self._orders]
        self._cores = OtherCores([thread.native_id or 0 for thread in threads])
        self._finalizer = weakref.finalize(self, _end, self._orders)

    def share(self, part: Callable[[int], None]) -> None:
        """Call ``part(0)`` here and ``part(1)``, ``part(2)``, ... in the other threads, and wait.

        Raises:
            BaseException: the first one raised by a part, after all parts have ended.
            RuntimeError: the threads have ended.
        """
        if self._orders and not self._finalizer.alive:
            raise RuntimeError("the threads have ended")
        self._cores.leave_this_one()
        done: SimpleQueue[BaseException | None] = SimpleQueue()
        for number, orders in enumerate(self._orders, start=1):
            orders.put((number, part, done))
        raised = _attempt(part, 0)
        for _ in self._orders:
            raised = done.get() or raised
        if raised is not None:
            raise raised

    def end(self) -> None:
        """End the threads; no more work is accepted."""
        self._finalizer()


def _started(orders: SimpleQueue[_Order]) -> threading.Thread:
    thread = threading.Thread(target=_work, args=(orders,), name="step", daemon=True)
    thread.start()
    return thread


def _attempt(part: Callable[[int], None], number: int) -> BaseException | None:
    try:
        part(number)
    except BaseException as error:
        return error
    return None


def _work(orders: SimpleQueue[_Order]) -> None:
    while (order := orders.get()) is not None:
        number, part, done = order
        raised = _attempt(part, number)
        del order, part  # what waits keeps no worlds alive
        done.put(raised)
        del done, raised


def _end(waiting: list[SimpleQueue[_Order]]) -> None:
    for orders in waiting:
        orders.put(None)
