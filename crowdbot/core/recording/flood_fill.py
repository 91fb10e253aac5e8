"""Find the cells of a map that are connected to a given cell; compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import array_kernel


@array_kernel
def connected(free: NDArray[np.bool_], row: int, column: int) -> NDArray[np.bool_]:
    """Return the cells that are reached from one cell over free ones that share a side.

    Args:
        free: (H, W) cells.
        row, column: the cell to start from; from one that is not free none is reached.
    """
    height, width = free.shape
    reached = np.zeros((height, width), np.bool_)
    if not free[row, column]:
        return reached
    waiting = np.empty(height * width, np.int64)
    waiting[0], count = row * width + column, 1
    reached[row, column] = True
    while count > 0:
        count -= 1
        r, c = waiting[count] // width, waiting[count] % width
        for dy, dx in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            y, x = r + dy, c + dx
            if 0 <= y < height and 0 <= x < width and free[y, x] and not reached[y, x]:
                reached[y, x] = True
                waiting[count] = y * width + x
                count += 1
    return reached
