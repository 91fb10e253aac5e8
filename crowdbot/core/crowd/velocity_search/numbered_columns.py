"""Column numbers in place of record fields: deprecated, kept until 1.0.

Cost functions of other packages import them from `crowdbot.core.interfaces`. ``agent[PX]`` still
works: numba converts a constant index to the field at that position.
"""

from __future__ import annotations

from typing import Any

from numba import carray, njit, types  # type: ignore[attr-defined]
from numba.extending import intrinsic

from crowdbot.core.crowd.velocity_search.records import AGENT, NEIGHBOUR, WALL, WORK_COLUMNS
from crowdbot.core.support.records import columns_of

(
    PX, PY, VX, VY, RADIUS, PREFERRED, FASTEST, TIME_STEP,
    GX, GY, PVX, PVY, MAX_SPEED, MAX_ACCELERATION, RELAXATION, WEIGHT, PARITY, RANDOM,
    DESCENDS, BROKEN, ASKED_X, ASKED_Y, ASKED_RADIUS, WALLS_WITHIN, FLOOR,
) = range(25)  # fmt: skip
D2, RX, RY, NVX, NVY, REACH, NPX, NPY, STATIC = range(9)
AX, AY, BX, BY, NX, NY, WALL_D2 = range(7)
RANGE, FROM_SURFACE = range(2)
AGENT_SIZE, NEAR_COLUMNS, WALL_COLUMNS = (columns_of(r) for r in (AGENT, NEIGHBOUR, WALL))
# Numba needs a length; it is not checked.
_ANY = 1


def _numbers(_: Any, rows: Any) -> tuple[Any, Any]:
    pointer = types.CPointer(types.float64)  # type: ignore[no-untyped-call]

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        return builder.bitcast(values[0], context.get_value_type(pointer))

    return pointer(rows), generate


_numbers_of: Any = intrinsic(_numbers)


@njit(cache=True)
def near_table(near: Any) -> Any:
    """Return neighbours as rows of `NEAR_COLUMNS`."""
    return carray(_numbers_of(near), (_ANY, NEAR_COLUMNS))


@njit(cache=True)
def wall_table(walls: Any) -> Any:
    """Return walls as rows of `WALL_COLUMNS`."""
    return carray(_numbers_of(walls), (_ANY, WALL_COLUMNS))


@njit(cache=True)
def work_table(work: Any) -> Any:
    """Return the scratch table as rows of `WORK_COLUMNS`."""
    return carray(work, (_ANY, WORK_COLUMNS))
