"""A small static map: cells in which lidars see something for seconds; compiled.

The map is a window of cells that wraps around, so it follows the robot without being shifted. A
cell belongs to the position at which it was last seen. Evidence decays at a quarter of the rate at
which it grows, when a cell is next read.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

#: Width of a cell, m, and cells along each side of the window.
CELL, CELLS = 0.1, 192
#: Layers: seconds of evidence, time of the last look (s), and the cell's place in whole cells.
EVIDENCE, SEEN, PLACE_X, PLACE_Y = range(4)
LAYERS = 4
#: Evidence from which something stands, and at most, s; share of it lost per second unseen.
_STANDS, _MOST, _FADES = 2.0, 6.0, 0.25


def new_map() -> Array:
    """Return an empty map, (`CELLS`, `CELLS`, `LAYERS`)."""
    return np.zeros((CELLS, CELLS, LAYERS))


@kernel
def evidence_at(still: Array, x: float, y: float, t: float) -> float:
    """Return the evidence at a position (m) and time, in s of observation; 0 if never seen."""
    i, j = math.floor(x / CELL), math.floor(y / CELL)
    cell = still[i % CELLS, j % CELLS]
    if cell[PLACE_X] != i or cell[PLACE_Y] != j:
        return 0.0
    return float(max(0.0, cell[EVIDENCE] - _FADES * (t - cell[SEEN])))


@kernel
def stands_at(still: Array, x: float, y: float, t: float) -> bool:
    """Return True if there is a static object at a position (m), or in a cell beside it."""
    for di in range(-1, 2):
        for dj in range(-1, 2):
            if evidence_at(still, x + di * CELL, y + dj * CELL, t) > _STANDS:
                return True
    return False


@kernel
def notice(still: Array, x: float, y: float, t: float, since: float) -> None:
    """Add evidence for a position (m) seen at a time (s), ``since`` seconds after the last scan."""
    i, j = math.floor(x / CELL), math.floor(y / CELL)
    cell = still[i % CELLS, j % CELLS]
    if cell[PLACE_X] != i or cell[PLACE_Y] != j:
        cell[EVIDENCE], cell[SEEN], cell[PLACE_X], cell[PLACE_Y] = 0.0, t, i, j
    if cell[SEEN] == t and cell[EVIDENCE] > 0.0:
        return  # by another point of this scan
    rest = max(0.0, cell[EVIDENCE] - _FADES * max(0.0, t - cell[SEEN] - since))
    cell[EVIDENCE], cell[SEEN] = min(_MOST, rest + since), t
