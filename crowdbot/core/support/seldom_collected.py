"""Python's collector of cycles, kept from walking documents again and again as they are read."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: New objects before the collector looks at them, instead of 700: about 50 MB of small ones.
_MANY = 500_000
#: As this process began.
_BEFORE = gc.get_threshold()


def collect_seldom() -> None:
    """Collect cycles seldom from now on, in a process of ours: what it loads it keeps.

    A threshold that is larger already, or 0 (off), stays.
    """
    first, *others = gc.get_threshold()
    if 0 < first < _MANY:
        gc.set_threshold(_MANY, *others)


@contextmanager
def seldom_collected() -> Iterator[None]:
    """As `collect_seldom`, for a while: documents are many objects with few cycles.

    A decorator, too.
    """
    before = gc.get_threshold()
    collect_seldom()
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def collected_as_ever() -> Iterator[None]:
    """Undoes `collect_seldom` for a while: what planners leave may be large."""
    before = gc.get_threshold()
    if before[0] == _MANY:
        gc.set_threshold(*_BEFORE)
    try:
        yield
    finally:
        gc.set_threshold(*before)
