"""Python's collector of cycles, kept from walking again and again what is loaded for good."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: New objects before the collector looks at them, instead of 700: about 50 MB of small ones.
_MANY = 500_000
#: Thresholds before `collect_seldom`; empty in processes that are not ours.
_usual: list[tuple[int, int, int]] = []


def collect_seldom() -> None:
    """Collect cycles seldom from now on, in a process of ours: what it loads it keeps.

    A threshold that is larger already, or 0 (off), stays.
    """
    before = gc.get_threshold()
    if _raise_threshold():
        _usual[:] = [before]


@contextmanager
def seldom_collected() -> Iterator[None]:
    """As `collect_seldom`, for a while: documents are many objects with few cycles.

    A decorator, too.
    """
    before = gc.get_threshold()
    _raise_threshold()
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def collected_as_usual() -> Iterator[None]:
    """Undoes `collect_seldom` for a while: what planners leave may be large.

    Where that was not called, thresholds are a user's, and nothing is done.
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
    """Whether the threshold was lower, and not off."""
    first, *others = gc.get_threshold()
    if not 0 < first < _MANY:
        return False
    gc.set_threshold(_MANY, *others)
    return True
