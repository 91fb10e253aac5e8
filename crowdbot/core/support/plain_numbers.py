"""Convert a plugin's result to an array of real numbers, without running more of its code."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Largest number of dimensions of our arrays.
_DEEPEST = 3
_NUMBERS = (bool, int, float)


def plain_numbers(value: object) -> NDArray[np.float64]:
    """Return an array from an array, a number, or plain lists of numbers.

    numpy iterates over list-like objects, which may be endless, and drops the imaginary part of
    complex numbers with a warning.

    Raises:
        TypeError: it is none of these.
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
