"""Stable sort order of numbers, for compiled functions.

Numba needs a second or more of processor time to compile ``np.argsort`` or ``sort`` for each
function that calls them. This function is compiled only once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.types.arrays import Array

Order = NDArray[np.int64]
#: Size of parts that are sorted by insertion before they are merged.
_SHORT = 16


@array_kernel
def stable_order(values: Array) -> Order:
    """Return ``np.argsort(values, kind="stable")``: equal values keep their order, NaN come last.

    Args:
        values: (N,).

    Returns:
        (N,) indices, from the least to the greatest.
    """
    count = values.shape[0]
    order = np.empty(count, np.int64)
    write_stable_order(values, order, np.empty(count, np.int64))
    return order


@kernel
def write_stable_order(values: Array, order: Order, scratch: Order) -> None:
    """Write the `stable_order` of ``values`` (N,) to ``order`` (N,); ``scratch`` is as large."""
    count, rounds = values.shape[0], 0
    while _SHORT << rounds < count:
        rounds += 1
    source, target = (order, scratch) if rounds % 2 == 0 else (scratch, order)
    for first in range(0, count, _SHORT):
        _sort_short(values, source, first, min(first + _SHORT, count))
    for k in range(rounds):
        width = _SHORT << k
        for first in range(0, count, 2 * width):
            middle = min(first + width, count)
            _merge(values, source, target, first, middle, min(middle + width, count))
        source, target = target, source


@kernel
def _before(a: float, b: float) -> bool:
    return bool(a < b or (b != b and a == a))


@kernel
def _sort_short(values: Array, order: Order, first: int, end: int) -> None:
    """Write the order of values [first, end) in place, by insertion sort."""
    for i in range(first, end):
        place = i
        while place > first and _before(values[i], values[order[place - 1]]):
            order[place] = order[place - 1]
            place -= 1
        order[place] = i


@kernel
def _merge(values: Array, order: Order, merged: Order, first: int, middle: int, end: int) -> None:
    """Merge the sorted parts [first, middle) and [middle, end) of an order."""
    i, j = first, middle
    for k in range(first, end):
        if j >= end or (i < middle and not _before(values[order[j]], values[order[i]])):
            merged[k] = order[i]
            i += 1
        else:
            merged[k] = order[j]
            j += 1
