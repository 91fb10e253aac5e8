"""Decorators that compile small loops with numba.

Code that numba compiles counts the references to each array at each call, with locked
instructions: among functions as small as these, a third of the time. A function that makes no array
needs no count, because the caller in Python holds all of its arrays.

With ``CROWDBOT_PLAIN_NUMBA=1`` numba's own ``njit`` compiles them, without `compile_parts`: the
same results from what numba documents, in more time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

from crowdbot.core.support.compile_cache import is_plain_numba

F = TypeVar("F", bound=Callable[..., Any])
# `_nrt`, used below, is undocumented; numba compiles its own such functions with it.
_OPTIONS: dict[str, Any] = {"error_model": "numpy"}


def kernel(function: F) -> F:
    """Compile a function that allocates no array and calls none that returns one.

    Numba refuses to compile a function that allocates an array.
    """
    return cast(F, _compiled(function, {**_OPTIONS, "_nrt": False}))


def array_kernel(function: F) -> F:
    """Compile a function that allocates arrays, or calls one that does."""
    return cast(F, _compiled(function, _OPTIONS))


def free_kernel(function: F) -> F:
    """Compile like `kernel`, without Python's lock, so that threads can run it in parallel.

    For long work on the caller's own arrays.
    """
    return cast(F, _compiled(function, {"nogil": True, **_OPTIONS, "_nrt": False}))


def inline_kernel(function: F) -> F:
    """Compile like `kernel` a function that is inlined into its callers.

    For a part of a loop that takes named tuples of arrays: passing a hundred numbers would cost as
    much as the part itself.
    """
    return cast(F, _compiled(function, {"inline": "always", **_OPTIONS, "_nrt": False}))


def declared_kernel(signature: Any) -> Callable[[F], F]:
    """Compile a function immediately for one signature, for calls by address.

    Numba's ``@njit(signature, cache=True, error_model="numpy")`` does the same, but the first such
    function that a process loads from the cache takes 0.1 s.
    """

    def decorate(function: F) -> F:
        made = _compiled(function, _OPTIONS)
        if made is not function:
            made.compile(signature)
            made.disable_compile()
        return cast(F, made)

    return decorate


def _compiled(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return function
    if is_plain_numba():
        return numba.njit(cache=True, **options)(function)
    from crowdbot.core.support.compiling.compile_parts import KernelDispatcher

    whole = {**options, "nopython": True, "boundscheck": None}
    return KernelDispatcher(function, targetoptions=whole)
