"""How small loops are compiled.

Code that numba compiles counts the references to each array at each call, with locked
instructions: among functions as small as these, a third of the time. Who makes no array needs no
count, because the caller in Python holds all of theirs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import njit

F = TypeVar("F", bound=Callable[..., Any])
# The last is not in numba's documentation, but how numba compiles its own such functions.
_OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy", "_nrt": False}


def kernel(function: F) -> F:
    """Compile a function that makes no array and calls none that returns one.

    Numba refuses one that makes an array when it compiles it.
    """
    return cast(F, njit(**_OPTIONS)(function))


def inline_kernel(function: F) -> F:
    """As `kernel`, for a function that is copied into those that call it.

    For a part of a loop that takes named tuples of arrays: handing over a hundred numbers would
    cost as much as the part itself.
    """
    return cast(F, njit(inline="always", **_OPTIONS)(function))


__all__ = ["inline_kernel", "kernel"]
