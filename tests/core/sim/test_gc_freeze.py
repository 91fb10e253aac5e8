"""Nothing outlives its time because of the collector's rest."""

from __future__ import annotations

import gc
import weakref

import pytest

from crowdbot.core.sim.gc_freeze import gc_frozen
from crowdbot.core.support.seldom_collected import seldom_collected


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


def test_cycles_are_collected_as_ever_also_in_a_process_that_collects_seldom() -> None:
    with seldom_collected():
        seldom = gc.get_threshold()
        with gc_frozen():
            assert 0 < gc.get_threshold()[0] < seldom[0]
        assert gc.get_threshold() == seldom


def test_an_error_ends_it() -> None:
    with pytest.raises(ZeroDivisionError), gc_frozen():
        1 / 0  # noqa: B018
    assert gc.get_freeze_count() == 0
