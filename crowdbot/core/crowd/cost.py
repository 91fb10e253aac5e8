"""The contract of cost functions: compiled, of one fixed signature each.

A cost is split into a *base*, which depends on the candidate alone as seen in the frame of the
preferred velocity, and an *excess* >= 0 caused by neighbours and walls:
``C(u) = base(u) + excess(u)``. The base is tabulated once per agent, so that candidates are
tried in order of their lower bound and most of them never are. Either part may be zero.

Signatures (float64 everywhere, SI units, world frame unless said otherwise):

- ``base(ux, uy, preferred, max_speed, params) -> cost``: candidate in the preferred frame, in
  which the preferred velocity is ``(preferred, 0)``; ``inf`` forbids the candidate.
- ``prepare(agent, near, near_count, walls, wall_count, params, work) -> items``: once per agent
  and decision, writes what ``excess`` needs into ``work``; row 0 is for counts. Where it returns
  0 the excess is zero and is not called.
- ``excess(ux, uy, budget, agent, work, params) -> cost``: may stop and return anything above
  ``budget`` as soon as the cost exceeds it. Called for many candidates, in any order.

Everything but numbers is a pointer to float64: ten thousands of calls per decision would
otherwise spend most of their time on handing arrays over. Vectors are indexed as they are;
``near_table``, ``wall_table`` and ``work_table`` give the others rows and columns, free of charge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import carray, njit, types  # type: ignore[attr-defined]
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: What compiled code is handed instead of an array; indexed like one.
Pointer = Any

_F, _I = types.float64, types.int64
_P = types.CPointer(_F)  # type: ignore[no-untyped-call]
BASE = types.float64(_F, _F, _F, _F, _P)
PREPARE = types.int64(_P, _P, _I, _P, _I, _P, _P)
EXCESS = types.float64(_F, _F, _F, _P, _P, _P)

# Entries of the ``agent`` vector.
PX, PY, VX, VY, RADIUS, PREFERRED, FASTEST, TIME_STEP = range(8)
AGENT_SIZE = 8
# Columns of ``near``: squared centre distance, relative position, velocity, sum of radii.
D2, RX, RY, NVX, NVY, REACH = range(6)
NEAR_COLUMNS = 6
#: Columns of ``walls``: both ends of a segment.
WALL_COLUMNS = 4
# First two entries of every ``params`` vector.
RANGE, FROM_SURFACE = range(2)
#: Columns of ``work``; it has one row for each neighbour and wall, and the header.
WORK_COLUMNS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class CompiledCost:
    """One cost function of a mix.

    Attributes:
        base, prepare, excess: numba functions of the signatures above.
        params: (P,), begins with the range (m) and 1.0 if it is measured between surfaces.
        weight: factor of the cost.
    """

    base: Callable[..., Any]
    prepare: Callable[..., Any]
    excess: Callable[..., Any]
    params: Array
    weight: float

    def reach(self, radius: float, largest_radius: float) -> float:
        """Centre distance beyond which no neighbour counts, m."""
        from_surface = bool(self.params[FROM_SURFACE])
        return float(self.params[RANGE]) + (radius + largest_radius if from_surface else 0.0)


# Numba wants a length; it is not checked.
_ANY = 1


@njit(cache=True)
def near_table(near: Pointer) -> Any:
    """Neighbours as rows of `NEAR_COLUMNS`."""
    return carray(near, (_ANY, NEAR_COLUMNS))


@njit(cache=True)
def wall_table(walls: Pointer) -> Any:
    """Walls as rows of `WALL_COLUMNS`."""
    return carray(walls, (_ANY, WALL_COLUMNS))


@njit(cache=True)
def work_table(work: Pointer) -> Any:
    """The scratch table as rows of `WORK_COLUMNS`."""
    return carray(work, (_ANY, WORK_COLUMNS))
