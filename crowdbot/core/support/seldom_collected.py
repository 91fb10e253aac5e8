"""Python's collector of cycles, kept from walking documents again and again as they are read."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: New objects before the collector looks at them, instead of 700: about 10 MB of small ones.
_MANY = 100_000


@contextmanager
def seldom_collected() -> Iterator[None]:
    """Collect cycles seldom: specs and trees of documents are many, are kept, and have few.

    A decorator, too. A threshold that is larger already, or 0 (off), stays.
    """
    before = gc.get_threshold()
    if 0 < before[0] < _MANY:
        gc.set_threshold(_MANY, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)
