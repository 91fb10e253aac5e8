"""Corners and sight packed in two arrays, since each array passed from Python takes time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crowdbot.core.crowd.routing.corners import CORNER_COLUMNS
from crowdbot.core.crowd.routing.sight import Sight
from crowdbot.core.support.compiling.compile import inline_kernel
from crowdbot.core.types.arrays import Array, Indices

#: The head: end of the corners in ``reals``; then, for each sight, start and end of its arrays:
#: edges and frame in ``reals``, start, listed and shape in ``wholes``.
_OF_SIGHT = 9
_HEAD = 1 + 2 * _OF_SIGHT


class PackedMesh(NamedTuple):
    """The head and all arrays, one after the other.

    Attributes:
        wholes: head, then the integer arrays.
        reals: the corners' table, then the others, m.
    """

    wholes: Indices
    reals: Array

    @classmethod
    def of(cls, table: Array, sights: tuple[Sight, Sight]) -> PackedMesh:
        """Pack a table of corners (V, `CORNER_COLUMNS`) and two sights."""
        head, wholes, reals = [table.size], list[Indices](), [table.ravel()]
        at_whole, at_real = _HEAD, table.size
        for sight in sights:
            ends = [at_real, at_real + sight.edges.size]
            at_real = ends[1] + len(sight.frame)
            reals += [sight.edges.ravel(), sight.frame]
            ends.append(at_real)
            for one in (sight.start, sight.listed, sight.shape):
                ends += [at_whole, at_whole + len(one)]
                at_whole += len(one)
                wholes.append(one)
            head += ends
        return cls(np.concatenate([np.array(head, np.int64), *wholes]), np.concatenate(reals))


@inline_kernel
def table_in(wholes: Indices, reals: Array) -> Array:
    """Return a view of the table of corners."""
    return reals[: wholes[0]].reshape((wholes[0] // CORNER_COLUMNS, CORNER_COLUMNS))


@inline_kernel
def sight_in(wholes: Indices, reals: Array, number: int) -> Sight:
    """Return views of sight 0 or 1."""
    h = wholes[1 + number * _OF_SIGHT : 1 + (number + 1) * _OF_SIGHT]
    edges = reals[h[0] : h[1]].reshape(((h[1] - h[0]) // 4, 4))
    start, listed, shape = wholes[h[3] : h[4]], wholes[h[5] : h[6]], wholes[h[7] : h[8]]
    return Sight(edges, start, listed, reals[h[1] : h[2]], shape)
