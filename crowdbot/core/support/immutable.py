"""Arrays that nobody can make writable again: their memory is a Python bytes object."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", bound=np.generic)
D = TypeVar("D")


def immutable(array: NDArray[T]) -> NDArray[T]:
    """A copy of an array, laid out like it, that refuses ``setflags(write=True)`` for good."""
    column = array.flags.f_contiguous and not array.flags.c_contiguous
    order: Literal["F", "C"] = "F" if column else "C"
    return np.ndarray(array.shape, array.dtype, buffer=array.tobytes(order), order=order)


def immutable_fields(value: D) -> D:
    """A copy of a dataclass whose arrays nobody can make writable."""
    holder: Any = value
    arrays = {f.name: getattr(holder, f.name) for f in fields(holder) if f.init}
    frozen = {n: immutable(a) for n, a in arrays.items() if isinstance(a, np.ndarray)}
    copy: D = replace(holder, **frozen)
    return copy
