"""Nothing outlives its time because of the collector's rest."""

from __future__ import annotations

import gc
import weakref

import pytest

from crowdbot.core.sim.gc_freeze import gc_frozen
from crowdbot.core.support import gc_throttle as module
from crowdbot.core.support.gc_throttle import throttle_gc


class _Knot:
    def __init__(self) -> None:
        self.me = self


def test_objects_from_before_are_settled_within_only() -> None:
    with gc_frozen():
        assert gc.get_freeze_count() > 0
        with gc_frozen():
            pass
        assert gc.get_freeze_count() > 0, "the outer one ends it"
    assert gc.get_freeze_count() == 0


def test_cycles_made_within_are_collected() -> None:
    with gc_frozen():
        knot = weakref.ref(_Knot())
        gc.collect()
        assert knot() is None


def test_cycles_are_collected_as_usual_in_a_process_that_collects_seldom(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_usual", [])
    before = gc.get_threshold()
    throttle_gc()
    seldom = gc.get_threshold()
    try:
        with gc_frozen():
            assert gc.get_threshold() == before
            with gc_frozen():
                assert gc.get_threshold() == before
        assert gc.get_threshold() == seldom != before
    finally:
        gc.set_threshold(*before)


def test_an_error_ends_it() -> None:
    with pytest.raises(ZeroDivisionError), gc_frozen():
        1 / 0  # noqa: B018
    assert gc.get_freeze_count() == 0
