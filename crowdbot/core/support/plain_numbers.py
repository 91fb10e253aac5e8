"""What a plugin returned as an array of real numbers, without running more of its code."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: An array of ours has so many dimensions at most.
_DEEPEST = 3
_NUMBERS = (bool, int, float)


def plain_numbers(value: object) -> NDArray[np.float64]:
    """An array of a plugin's answer: an array, a number, or plain lists of them.

    numpy asks a list that only looks like one for its items, which may never end, and drops the
    imaginary part of complex numbers with a warning.

    Raises:
        TypeError: it is something else.
    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    if not (isinstance(value, np.ndarray | np.generic) or hasattr(value, "__array__")):
        _check_list(value, 0)
    found: NDArray[Any] = np.asarray(value)
    if found.dtype.kind not in "fiub":
        raise TypeError(f"an array of {found.dtype} is not one of real numbers")
    return found.astype(np.float64)


def _check_list(value: object, depth: int) -> None:
    if type(value) in (list, tuple) and depth < _DEEPEST:
        for item in value:  # type: ignore[attr-defined]
            _check_list(item, depth + 1)
    elif type(value) not in _NUMBERS and not isinstance(value, np.generic | np.ndarray):
        raise TypeError(f"a {type(value).__name__} where an array of numbers is wanted")
