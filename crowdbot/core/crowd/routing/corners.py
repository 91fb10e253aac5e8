"""Corners at which shortest paths bend, and visibility between them.

A shortest path among polygons bends only at their corners, and passes each of them tangentially:
Lozano-Pérez, Wesley, "An algorithm for planning collision-free paths among polyhedral obstacles",
Communications of the ACM 22(10), 1979.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.core.crowd.routing.sight import Sight, crosses, is_clear
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array, Indices

#: Columns of a corner: position; positions of its neighbours on the outline; a unit vector from the
#: corner into the free floor; free room in that direction.
X, Y, BEFORE_X, BEFORE_Y, AFTER_X, AFTER_Y, OUT_X, OUT_Y, ROOM = range(9)
CORNER_COLUMNS = 9
#: Largest room that is measured at a corner, m.
MOST_ROOM = 10.0


class Corners(NamedTuple):
    """Corners and links between mutually visible ones.

    Attributes:
        table: (V, `CORNER_COLUMNS`).
        first, linked, length: links of corner v are rows first[v] to first[v + 1] of ``linked``
            (the other corner) and of ``length`` (m).
    """

    table: Array
    first: Indices
    linked: Indices
    length: Array

    @classmethod
    def of(cls, rings: list[Array], sight: Sight) -> Corners:
        """Return the corners of outlines (K, 2) with obstacles on their left.

        Args:
            sight: edges slightly inside the outlines, so that rounding blocks nothing.
        """
        table = np.concatenate([np.zeros((0, CORNER_COLUMNS)), *map(_rows, rings)])
        _look_out(table, sight)
        count = np.zeros(len(table), np.int64)
        _links(table, sight, count, np.zeros(1, np.int64), np.zeros(0, np.int64), np.zeros(0))
        first = np.concatenate([[0], np.cumsum(count)]).astype(np.int64)
        linked, length = np.zeros(int(first[-1]), np.int64), np.zeros(int(first[-1]))
        _links(table, sight, count, first, linked, length)
        return cls(table, first, linked, length)


def _rows(ring: Array) -> Array:
    """Return the convex corners of one outline."""
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    come, go = ring - before, after - ring
    bends = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0] > 1e-12
    out = come / np.hypot(*come.T)[:, None] - go / np.hypot(*go.T)[:, None]
    length = np.hypot(*out.T)
    out = np.divide(out, length[:, None], out=np.zeros_like(out), where=length[:, None] > 0.0)
    room = np.full((len(ring), 1), MOST_ROOM)
    return np.concatenate([ring, before, after, out, room], axis=1)[bends]


@kernel
def _look_out(table: Array, sight: Sight) -> None:
    """Set column `ROOM`: the free distance outwards from each corner, m."""
    for v in range(table.shape[0]):
        x, y = table[v, X], table[v, Y]
        fx, fy = x + MOST_ROOM * table[v, OUT_X], y + MOST_ROOM * table[v, OUT_Y]
        if is_clear(x, y, fx, fy, sight):
            continue
        for e in range(sight.edges.shape[0]):
            edge = sight.edges[e]
            if crosses(x, y, fx, fy, edge):
                ex, ey = edge[2] - edge[0], edge[3] - edge[1]
                cross = table[v, OUT_X] * ey - table[v, OUT_Y] * ex
                away = ((edge[0] - x) * ey - (edge[1] - y) * ex) / cross if cross != 0.0 else 0.0
                table[v, ROOM] = min(table[v, ROOM], max(0.0, away))


@kernel
def bends_past(table: Array, v: int, x: float, y: float) -> bool:
    """Return True if a shortest path from or to a point may bend at corner v.

    It may if both edges at the corner are on one side of the line from the corner to the point.
    """
    dx, dy = x - table[v, X], y - table[v, Y]
    before = dx * (table[v, BEFORE_Y] - table[v, Y]) - dy * (table[v, BEFORE_X] - table[v, X])
    after = dx * (table[v, AFTER_Y] - table[v, Y]) - dy * (table[v, AFTER_X] - table[v, X])
    slack = 1e-9 * (abs(dx) + abs(dy))
    return bool((before >= -slack and after >= -slack) or (before <= slack and after <= slack))


@kernel
def _links(
    table: Array, sight: Sight, count: Indices, first: Indices, linked: Indices, length: Array
) -> None:
    """Count links, or list them if ``linked`` has room for them."""
    count[:] = 0
    for v in range(table.shape[0]):
        for w in range(v + 1, table.shape[0]):
            x, y, ox, oy = table[v, X], table[v, Y], table[w, X], table[w, Y]
            if not (bends_past(table, v, ox, oy) and bends_past(table, w, x, y)):
                continue
            if not is_clear(x, y, ox, oy, sight):
                continue
            if linked.shape[0]:
                away = math.hypot(ox - x, oy - y)
                for one, other in ((v, w), (w, v)):
                    linked[first[one] + count[one]] = other
                    length[first[one] + count[one]] = away
            count[v] += 1
            count[w] += 1
