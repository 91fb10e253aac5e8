"""Callbacks that do not keep their system alive, so that a finished diagram can be thrown away.

Python's collector of cycles frees a diagram of Drake 1.51 with its systems, if it sees all their
references to one another. Two things hide some from it, and either one keeps a whole diagram, with
its sensors and people, for as long as the process lives (2.6 MB for each run):

- an output port holds its callback where the collector does not look: hence `weak_callback`;
- in Python 3.11 and 3.12 a system's attributes are counted twice when its class has a dictionary of
  its own beside that of its base: hence ``__slots__ = NO_ATTRIBUTES`` in each class.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")

#: ``__slots__`` of a system. By its name, since mypy, which does not see the dictionary of the
#: base in C++, would take a literal for all attributes that there may be.
NO_ATTRIBUTES: tuple[str, ...] = ()


def weak_callback(method: Callable[..., T]) -> Callable[..., T]:
    """A method as a function that does not hold its object; who calls it must hold that."""
    held, function = weakref.ref(method.__self__), method.__func__  # type: ignore[attr-defined]

    def call(*args: Any) -> T:
        found = held()
        assert found is not None, "a system outlives its callbacks"
        result: T = function(found, *args)
        return result

    return call
