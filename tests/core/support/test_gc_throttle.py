"""Collecting cycles seldom, for a while."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from crowdbot.core.support import gc_throttle as module
from crowdbot.core.support.gc_throttle import (
    throttle_gc,
    throttled_gc,
    usual_gc,
)


@pytest.fixture(autouse=True)
def _as_before(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(module, "_usual", [])
    before = gc.get_threshold()
    yield
    gc.set_threshold(*before)


def _collections() -> int:
    gc.collect()
    before = _so_far()
    kept = [[k] for k in range(50_000)]
    after = _so_far()
    assert len(kept) == 50_000
    return after - before


def _so_far() -> int:
    return sum(int(one["collections"]) for one in gc.get_stats())


def test_many_new_objects_are_made_without_a_collection() -> None:
    gc.set_threshold(700, 10, 10)
    assert _collections() > 10
    with throttled_gc():
        assert _collections() == 0
    assert gc.get_threshold() == (700, 10, 10)


@pytest.mark.parametrize("first", [0, 1_000_000])
def test_what_somebody_set_higher_or_off_stays(first: int) -> None:
    gc.set_threshold(first, 5, 7)
    with throttled_gc():
        assert gc.get_threshold() == (first, 5, 7)
    assert gc.get_threshold() == (first, 5, 7)


def test_the_rest_of_a_process() -> None:
    gc.set_threshold(700, 10, 10)
    throttle_gc()
    assert _collections() == 0
    assert gc.get_threshold()[1:] == (10, 10)


def test_errors_leave_it_as_it_was() -> None:
    gc.set_threshold(700, 10, 10)
    with pytest.raises(KeyError), throttled_gc():
        raise KeyError
    assert gc.get_threshold() == (700, 10, 10)


def test_for_a_while_as_usual() -> None:
    gc.set_threshold(700, 10, 10)
    throttle_gc()
    with usual_gc():
        assert _collections() > 0
    assert _collections() == 0


def test_what_was_never_made_seldom_stays() -> None:
    gc.set_threshold(3000, 5, 7)
    with usual_gc():
        assert gc.get_threshold() == (3000, 5, 7)
    assert gc.get_threshold() == (3000, 5, 7)


def test_a_user_s_threshold_survives_one_who_reads_meanwhile() -> None:
    """As with two threads: a run begins while a document is read, and ends later."""
    gc.set_threshold(700, 10, 10)
    reading, run = throttled_gc(), usual_gc()
    with ExitStack() as reads:
        reads.enter_context(reading)
        runs = ExitStack()
        runs.enter_context(run)
    runs.close()
    assert gc.get_threshold() == (700, 10, 10)
