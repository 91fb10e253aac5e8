"""The neighbours of TtcaDca that change the cost of some candidate, heaviest first.

They are found in passes over columns: square roots and divisions are computed for several
neighbours at once, and no pass waits for one of them.
"""

from __future__ import annotations

import math

from crowdbot.plugin import (
    PREPARE,
    WORK_COLUMNS,
    AgentRecord,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    as_record,
    as_rows,
    declared_kernel,
)
from crowdbot.plugin.for_crowds import opposite_taken_for_parallel
from crowdbot.plugins.crowd.cost_functions.ttca_dca.records_build import (
    CLOSEST,
    HEADER,
    NEGLIGIBLE,
    NEIGHBOUR,
    PARAMS,
)

# Columns after the table: distance, later the factor from d to q; gap; largest closing speed, later
# if it changes a sum; row in ``near`` or, after these, in ``walls``; weight.
_DISTANCE, _GAP, _CLOSING, _ROW, _WEIGHT = range(5)
#: Columns are computed in blocks of this many entries: no processor has wider registers.
_STEP = 8


@array_kernel
def _whole_steps(count: int) -> int:
    return (count + _STEP - 1) // _STEP * _STEP


@array_kernel
def _columns(room: int) -> tuple[int, int, int, int, int]:
    """Return where the columns begin in ``work``."""
    first, length = WORK_COLUMNS * (1 + room), _whole_steps(room)
    return (
        first + _DISTANCE * length, first + _GAP * length, first + _CLOSING * length,
        first + _ROW * length, first + _WEIGHT * length,
    )  # fmt: skip


@array_kernel
def _is_ahead(rx: float, ry: float, vx: float, vy: float, parity: bool) -> bool:
    if parity and opposite_taken_for_parallel(rx, ry, vx, vy):
        return True
    return rx * vx + ry * vy >= 0.0


@array_kernel
def _list(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    """Write the neighbours within range and not behind; return their number.

    Every neighbour is written and, if not one of these, overwritten by the next: a branch would
    often be mispredicted.
    """
    own = as_record(params, PARAMS)
    distance, gap, closing, row, _ = _columns(near_count + wall_count)
    vx, vy, parity = agent.vx, agent.vy, agent.parity != 0.0
    reach, surface, count = own.range, own.from_surface, 0
    for j in range(near_count):
        rx, ry, d2, radii = near[j].rx, near[j].ry, near[j].d2, near[j].reach
        work[distance + count], work[gap + count] = d2, radii
        work[closing + count] = near[j].nvx * rx + near[j].nvy * ry
        work[row + count] = j
        limit = reach + surface * radii
        count += int(_is_ahead(rx, ry, vx, vy, parity) & (d2 < limit * limit))
    if own.walls != 0.0:
        limit, radius = reach + surface * agent.radius, agent.radius
        for s in range(wall_count):
            d2 = walls[s].d2
            if d2 < limit * limit and _is_ahead(walls[s].nx, walls[s].ny, vx, vy, parity):
                work[distance + count], work[gap + count] = d2, radius
                work[closing + count], work[row + count] = 0.0, near_count + s
                count += 1
    return count


@array_kernel
def _weigh(
    count: int, room: int, fastest: float, everybody: bool, params: Pointer, work: Pointer
) -> None:
    """Compute all columns of the listed neighbours."""
    distance, gap, closing, _, weight = _columns(room)
    own, whole = as_record(params, PARAMS), _whole_steps(count)
    a, b = own.inv_ttca2, own.inv_dca2
    for i in range(whole):
        work[distance + i] = max(math.sqrt(work[distance + i]), CLOSEST)
    for i in range(whole):
        work[gap + i] = work[distance + i] - work[gap + i]
    for i in range(whole):
        work[weight + i] = 1.0 / max(work[gap + i] * work[gap + i], CLOSEST * CLOSEST)
    for i in range(whole):
        work[closing + i] = fastest + max(0.0, -work[closing + i] / work[distance + i])
    for i in range(whole):
        g, v = work[gap + i], work[closing + i]
        # The exponent is at least this for every candidate.
        nothing = (g > 0.0) & (g * g * a * b >= NEGLIGIBLE * (a + b * v * v))
        work[closing + i] = 1.0 if everybody | (not nothing) else 0.0
    for i in range(whole):
        work[distance + i] = work[gap + i] / work[distance + i]


@array_kernel
def _select(count: int, room: int, work: Pointer) -> int:
    """Write the total weight in row 0, drop those without effect on a sum; return how many stay."""
    shrink, _, counts, row, weight = _columns(room)
    total, kept = 0.0, 0
    for i in range(count):
        total += work[weight + i]
        work[weight + kept] = work[weight + i]
        work[shrink + kept], work[row + kept] = work[shrink + i], work[row + i]
        kept += int(work[counts + i])
    header = as_record(work, HEADER)
    header.count, header.total = kept, total
    return kept


@array_kernel
def _place(i: int, kept: int, weight: int, work: Pointer) -> int:
    """Return how many of those kept are heavier than number i, or equally heavy and before it."""
    own, place = work[weight + i], 0
    for j in range(_whole_steps(kept)):
        place += int((work[weight + j] > own) | ((work[weight + j] == own) & (j < i)))
    return place


@array_kernel
def _write(
    kept: int,
    sort: bool,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    room: int,
    work: Pointer,
) -> None:
    """Write the table of neighbours."""
    shrink, _, _, number, weight = _columns(room)
    rows = as_rows(work, NEIGHBOUR)
    for i in range(_STEP):
        work[weight + kept + i] = -1.0  # heavier than none
    for i in range(kept):
        j = int(work[number + i])
        if j < near_count:
            rx, ry, vx, vy = near[j].rx, near[j].ry, near[j].nvx, near[j].nvy
        else:
            rx, ry, vx, vy = walls[j - near_count].nx, walls[j - near_count].ny, 0.0, 0.0
        k = 1 + (_place(i, kept, weight, work) if sort else i)
        row = rows[k]
        row.dx, row.dy, row.vx, row.vy = rx, ry, vx, vy
        row.qx, row.qy = rx * work[shrink + i], ry * work[shrink + i]
        row.weight = work[weight + i]


@declared_kernel(PREPARE)
def prepare(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    """Write the neighbours that matter to ``work``, those with the largest weight first.

    Row 0: their number, and the sum of k. Then d, q, v_j and k of each.
    """
    room, descends = near_count + wall_count, agent.descends != 0.0
    count = _list(agent, near, near_count, walls, wall_count, params, work)
    _weigh(count, room, agent.fastest, descends, params, work)
    kept = _select(count, room, work)
    _write(kept, not descends, near, near_count, walls, room, work)
    return kept
