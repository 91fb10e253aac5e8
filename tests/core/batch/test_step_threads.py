"""Threads that share short work."""

from __future__ import annotations

import gc
import threading
import weakref

import pytest

from crowdbot.core.batch.step_threads import StepThreads


def _fail_at_the_last(number: int) -> None:
    if number == 2:
        raise ValueError("part 2")


def test_each_part_is_done_once_in_a_thread_of_its_own() -> None:
    threads, found = StepThreads(2), list[tuple[int, int]]()
    for _ in range(50):
        threads.share(lambda number: found.append((number, threading.get_ident())))
    assert sorted(n for n, _ in found) == sorted([0, 1, 2] * 50)
    assert len(set(found)) == 3
    assert {t for n, t in found if n == 0} == {threading.get_ident()}
    threads.end()


def test_an_error_of_a_part_is_raised_and_the_threads_work_on() -> None:
    threads, found = StepThreads(2), list[int]()
    with pytest.raises(ValueError, match="part 2"):
        threads.share(_fail_at_the_last)
    threads.share(found.append)
    assert sorted(found) == [0, 1, 2]
    threads.end()
    with pytest.raises(RuntimeError, match="ended"):
        threads.share(found.append)


def test_threads_end_with_their_owner_and_keep_nothing_alive() -> None:
    class Worlds:
        def step(self, number: int) -> None:
            pass

    worlds, threads = Worlds(), StepThreads(2)
    threads.share(worlds.step)
    gone = weakref.ref(worlds)
    others = [t for t in threading.enumerate() if t.name == "step"][-2:]
    del worlds
    gc.collect()
    assert gone() is None
    del threads
    gc.collect()
    for thread in others:
        thread.join(5.0)
    assert not any(thread.is_alive() for thread in others)
