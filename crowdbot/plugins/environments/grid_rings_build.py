"""The borders of the free cells of a grid, as rings of lattice points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

#: East, north, west, south: a left turn is the next one.
STEPS = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])


@dataclass(frozen=True, slots=True, kw_only=True)
class GridRing:
    """A border of free cells, which are on its left; cells are squares of side 1.

    Attributes:
        corners: (K, 2) lattice points at which it turns.
        pinched: (K,) bool, corners at which two solid cells touch each other.
        region: number of the connected free cells inside.
    """

    corners: NDArray[np.int64]
    pinched: NDArray[np.bool_]
    region: int


def grid_rings(free: NDArray[np.bool_]) -> list[GridRing]:
    """Return all borders of free cells (H, W), whose first row is the lowest.

    Solid cells that touch at a corner are connected, free cells are not: a slanted wall of single
    cells has no gaps. Everything outside the grid is solid.
    """
    inside = np.pad(free, 1)
    regions, _ = ndimage.label(inside)
    exits = _exits(inside)
    width = exits.shape[1]
    moves = (STEPS[:, 1] * width + STEPS[:, 0]).tolist()
    pinched = (exits == 5) | (exits == 10)
    leaving = exits.tobytes()
    unseen = bytearray(leaving)
    rings = []
    for start in np.flatnonzero(exits & 1).tolist():
        if not unseen[start] & 1:
            continue
        turns = np.array(_followed(leaving, unseen, start, moves))
        rings.append(
            GridRing(
                corners=np.column_stack([turns % width, turns // width]) - 1,
                pinched=pinched.ravel()[turns],
                region=int(regions[start // width, start % width]),
            )
        )
    return rings


def _exits(inside: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return for each lattice point the directions in which borders leave it, one bit each."""
    rows, columns = inside.shape
    exits = np.zeros((rows + 1, columns + 1), np.uint8)
    above, below = inside[1:], inside[:-1]
    exits[1:rows, :columns] |= (above & ~below).astype(np.uint8)
    exits[1:rows, 1:] |= (below & ~above).astype(np.uint8) << 2
    west, east = inside[:, :-1], inside[:, 1:]
    exits[:rows, 1:columns] |= (west & ~east).astype(np.uint8) << 1
    exits[1:, 1:columns] |= (east & ~west).astype(np.uint8) << 3
    return exits


def _followed(leaving: bytes, unseen: bytearray, start: int, moves: list[int]) -> list[int]:
    """Return the turns of the ring that leaves a point eastwards, and mark it as seen."""
    at, heading, turns = start, 0, list[int]()
    while True:
        if heading == 0:
            unseen[at] &= ~1
        at += moves[heading]
        # A left turn first: at a pinched corner the ring stays with its free cell.
        turn = next(t for t in (1, 0, 3) if leaving[at] & (1 << ((heading + t) % 4)))
        heading = (heading + turn) % 4
        if turn:
            turns.append(at)
        if at == start and heading == 0:
            return turns
