"""The contract of cost functions: compiled, of one fixed signature each.

A cost is split into a *base*, which depends on the candidate alone as seen in the frame of the
preferred velocity, and an *excess* >= 0 caused by neighbours and walls:
``C(u) = base(u) + excess(u)``. The base is tabulated once per agent, so that candidates are
tried in order of their lower bound and most of them never are. Either part may be zero.

Signatures (float64 everywhere, SI units, world frame unless said otherwise):

- ``base(ux, uy, preferred, max_speed, params) -> cost``: candidate in the preferred frame, in
  which the preferred velocity is ``(preferred, 0)``; ``inf`` forbids the candidate.
- ``prepare(agent, near, near_count, walls, params, work) -> items``: once per agent and
  decision, writes what ``excess`` needs into ``work``; row 0 is for counts. Where it returns 0
  the excess is zero and is not called.
- ``excess(ux, uy, budget, agent, work, params) -> cost``: may stop and return anything above
  ``budget`` as soon as the cost exceeds it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import carray, njit, types  # type: ignore[attr-defined]
from numba.core.errors import NumbaExperimentalFeatureWarning
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Passing compiled functions to a kernel works and is cached; numba says at each call that it is
# experimental. The lock pins the version that was tested.
warnings.filterwarnings("ignore", category=NumbaExperimentalFeatureWarning)

_F, _V, _M = types.float64, types.float64[::1], types.float64[:, ::1]
_POINTER = types.CPointer(_F)  # type: ignore[no-untyped-call]
BASE = types.float64(_F, _F, _F, _F, _V)
PREPARE = types.int64(_V, _M, types.int64, _M, _V, _M)
EXCESS = types.float64(_F, _F, _F, _V, _M, _V)

# Entries of the ``agent`` vector.
PX, PY, VX, VY, RADIUS, PREFERRED, FASTEST, TIME_STEP = range(8)
AGENT_SIZE = 8
# Columns of ``near``: squared centre distance, relative position, velocity, sum of radii.
D2, RX, RY, NVX, NVY, REACH = range(6)
NEAR_COLUMNS = 6
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


class FunctionPointer(types.WrapperAddressProtocol):
    """A compiled function as a plain address, which costs far less to pass than a dispatcher."""

    def __init__(self, function: Any, signature: Any) -> None:
        result = function.get_compile_result(signature)
        self._function = function  # keeps the machine code alive
        self._signature = signature
        self._address = result.library.get_pointer_to_function(
            result.fndesc.llvm_cfunc_wrapper_name
        )

    def __wrapper_address__(self) -> int:
        """Address of the C wrapper."""
        return int(self._address)

    def signature(self) -> Any:
        """Numba signature."""
        return self._signature


# Slices of an array that numba owns cost two atomic operations each; slices of a borrowed one
# cost nothing. The owner must outlive the borrowed view.
@njit(types.float64[:, ::1](_POINTER, types.int64, types.int64), cache=True)
def borrow2(pointer: Any, rows: int, columns: int) -> Any:
    """View of a matrix that somebody else owns."""
    return carray(pointer, (rows, columns))


@njit(types.float64[:, :, ::1](_POINTER, types.int64, types.int64, types.int64), cache=True)
def borrow3(pointer: Any, layers: int, rows: int, columns: int) -> Any:
    """View of a three-dimensional array that somebody else owns."""
    return carray(pointer, (layers, rows, columns))
