"""Permanently read-only arrays: their memory is a Python bytes object."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", bound=np.generic)
D = TypeVar("D")


def immutable(array: NDArray[T]) -> NDArray[T]:
    """Return a copy of an array that permanently refuses ``setflags(write=True)``.

    An array that is already immutable is returned itself.
    """
    if _lies_in_bytes(array):
        return array
    column = array.flags.f_contiguous and not array.flags.c_contiguous
    order: Literal["F", "C"] = "F" if column else "C"
    return np.ndarray(array.shape, array.dtype, buffer=array.tobytes(order), order=order)


def _lies_in_bytes(array: NDArray[Any]) -> bool:
    memory: Any = array
    while isinstance(memory, np.ndarray) and not memory.flags.writeable:
        memory = memory.base
    return isinstance(memory, bytes)


def immutable_fields(value: D) -> D:
    """Return a copy of a dataclass whose arrays, including nested ones, are immutable."""
    holder: Any = value
    changed: dict[str, Any] = {}
    for field in fields(holder):
        old: Any = getattr(holder, field.name)
        if field.init and isinstance(old, np.ndarray):
            changed[field.name] = immutable(old)
        elif field.init and is_dataclass(old) and not isinstance(old, type):
            changed[field.name] = immutable_fields(old)
    if all(new is getattr(holder, name) for name, new in changed.items()):
        return value
    copy: D = replace(holder, **changed)
    return copy
