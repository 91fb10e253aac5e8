"""Differences from predictions as bytes: compiled parts of the codec."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import kernel

#: Added to the number of a prediction without stored differences, since all four are 0.
EXACT = np.uint8(128)


@kernel
def mark_exact(taken: NDArray[np.uint8], difference: NDArray[np.int64]) -> int:
    """Mark exact predictions in ``taken`` (K, M); return the number of others."""
    others = 0
    for k in range(taken.shape[0]):
        for i in range(taken.shape[1]):
            off = difference[0, k, i] | difference[1, k, i]
            off |= difference[2, k, i] | difference[3, k, i]
            if off == 0:
                taken[k, i] |= EXACT
            else:
                others += 1
    return others


@kernel
def carry(
    packs: bool,
    taken: NDArray[np.uint8],
    difference: NDArray[np.int64],
    data: NDArray[np.uint8],
) -> None:
    """Convert differences to bytes in the layout of `Packed`, or back."""
    count, people = taken.size, taken.shape[1]
    rest, at = (data.shape[0] - count) // 32, count
    for place in range(count):
        k, i = place // people, place % people
        if packs:
            data[place] = taken[k, i]
        else:
            taken[k, i] = data[place] & ~EXACT
        if data[place] & EXACT:
            continue
        for c in range(4):
            for byte in range(8):
                where = at + (8 * c + byte) * rest
                if packs:
                    data[where] = (difference[c, k, i] >> (8 * byte)) & 255
                else:
                    difference[c, k, i] |= np.int64(data[where]) << (8 * byte)
        at += 1
