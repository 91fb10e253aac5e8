"""Run the cyclic GC less often while long-lived objects are loaded."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: New objects before a collection, instead of 700: about 50 MB of small ones.
_MANY = 500_000
#: Thresholds before `throttle_gc`; empty in host processes of the API.
_usual: list[tuple[int, int, int]] = []


def throttle_gc() -> None:
    """Collect garbage less often from now on, in our own process, whose objects are permanent.

    A larger threshold, or 0 (off), is kept.
    """
    before = gc.get_threshold()
    if _raise_threshold():
        _usual[:] = [before]


@contextmanager
def throttled_gc() -> Iterator[None]:
    """Collect garbage less often in a context: documents are many objects with few cycles.

    Also usable as a decorator.
    """
    before = gc.get_threshold()
    _raise_threshold()
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def usual_gc() -> Iterator[None]:
    """Collect garbage as usual in a context, since planners' garbage may be large.

    Undoes `throttle_gc`. Without it, thresholds are the user's and are kept.
    """
    if not _usual:
        yield
        return
    before = gc.get_threshold()
    gc.set_threshold(*_usual[0])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _raise_threshold() -> bool:
    """Raise the threshold; return True if it was lower and not off."""
    first, *others = gc.get_threshold()
    if not 0 < first < _MANY:
        return False
    gc.set_threshold(_MANY, *others)
    return True
