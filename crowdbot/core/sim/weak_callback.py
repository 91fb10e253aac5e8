"""Callbacks that do not keep their system alive, so that finished diagrams can be freed.

Python's collector of cycles frees a diagram of Drake 1.51 with its systems, if it sees all their
references to one another. Two things hide references from it, and either one leaks a whole diagram,
with its sensors and people (2.6 MB for each run):

- an output port keeps its callback hidden from the collector: hence `weak_callback`;
- in Python 3.11 and 3.12 a system's attributes are counted twice if its class has a dictionary
besides that of its base: hence ``__slots__ = NO_ATTRIBUTES`` in each class.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")

#: ``__slots__`` of a system. A name, since mypy, which does not see the C++ base's dictionary,
#: would treat a literal as the list of all attributes.
NO_ATTRIBUTES: tuple[str, ...] = ()


def weak_callback(method: Callable[..., T]) -> Callable[..., T]:
    """Return a method as a function without a reference to its object.

    Its caller must keep that.
    """
    held, function = weakref.ref(method.__self__), method.__func__  # type: ignore[attr-defined]

    def call(*args: Any) -> T:
        found = held()
        assert found is not None, "a system outlives its callbacks"
        result: T = function(found, *args)
        return result

    return call
