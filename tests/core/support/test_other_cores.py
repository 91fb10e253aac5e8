"""Threads that keep off the core of the thread that waits for them."""

from __future__ import annotations

import os
import threading

import pytest

from crowdbot.core.support.other_cores import OtherCores

pytestmark = pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="only on Linux")


def test_a_thread_leaves_the_core_that_asks_and_nothing_else_changes() -> None:
    allowed, end = os.sched_getaffinity(0), threading.Event()
    thread = threading.Thread(target=end.wait, daemon=True)
    thread.start()
    assert thread.native_id
    cores = OtherCores([thread.native_id])
    core = min(allowed)
    try:
        os.sched_setaffinity(0, {core})  # so that the present core is known
        cores.leave_this_one()
        assert os.sched_getaffinity(0) == {core}
        assert os.sched_getaffinity(thread.native_id) == (allowed - {core} or allowed)
    finally:
        os.sched_setaffinity(0, allowed)
        end.set()
        thread.join()


def test_a_thread_that_has_ended_is_no_error() -> None:
    thread = threading.Thread(target=lambda: None)
    thread.start()
    thread.join()
    OtherCores([thread.native_id or 0]).leave_this_one()
    OtherCores([]).leave_this_one()
