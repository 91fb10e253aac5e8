"""First collision of an agent that keeps a velocity; shared by all costs that ask for it."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import crossing_time, time_to_disc, time_to_segment
from crowdbot.core.crowd.velocity_search.cost import (
    AX,
    AY,
    BX,
    BY,
    D2,
    FROM_SURFACE,
    NVX,
    NVY,
    PARITY,
    RADIUS,
    RANGE,
    REACH,
    RX,
    RY,
    WALL_D2,
    Pointer,
    near_table,
    wall_table,
    work_table,
)
from crowdbot.core.support.compile import array_kernel

# Entries of row 0 of ``work``: discs, wall segments after them, and how many of both touch the
# agent already (they are not listed).
DISCS, SEGMENTS, TOUCHED = range(3)
# Columns of a disc: relative position, velocity, squared distance minus squared sum of radii. A
# segment has both ends in columns 0 to 3. Then the time before which nothing can happen.
_EARLIEST = 5
_SAFE = 1.0 - 1e-12
#: Discs that are sorted by that time; all others come later. To sort hundreds would take longer
#: than to pass them over.
_SORTED = 12
#: Discs in lower bounds: those after them seldom are the first.
_FEW = 3


@array_kernel
def list_obstacles(
    agent: Pointer,
    near: Pointer,
    near_count: int,
    walls: Pointer,
    wall_count: int,
    params: Pointer,
    work: Pointer,
    fastest: float,
) -> int:
    """Write everything within range to ``work``; return how many rows that are.

    Uses columns 0 to 5 and the first three entries of row 0; the others are the caller's.

    Args:
        fastest: the largest speed that `first_collision` is going to be asked for, m/s.
    """
    return list_approaching(
        agent, near, near_count, walls, wall_count, params, work, 0.0, 0.0, fastest, math.inf
    )


@array_kernel
def list_approaching(
    agent: Pointer,
    near: Pointer,
    near_count: int,
    walls: Pointer,
    wall_count: int,
    params: Pointer,
    work: Pointer,
    ux: float,
    uy: float,
    spread: float,
    horizon: float,
) -> int:
    """As `list_obstacles`, without the discs that cannot be touched until ``horizon``, s.

    Most of those in a range of 100 m walk away or are too far. Under parity all are written,
    since `first_contact` looks at them.

    Args:
        ux, uy, spread: all velocities that `first_collision` is going to be asked for lie in this
            disc, m/s.
    """
    near, walls, work = near_table(near), wall_table(walls), work_table(work)
    range_, surface, touched, discs = params[RANGE], params[FROM_SURFACE], 0, 0
    most = horizon if agent[PARITY] == 0.0 else math.inf
    for j in range(near_count):
        d2, reach = near[j, D2], near[j, REACH]
        limit = range_ + surface * reach
        if d2 >= limit * limit:
            continue
        gap2 = d2 - reach * reach
        if gap2 <= 0.0:
            touched += 1
            continue
        vx, vy, distance = near[j, NVX], near[j, NVY], math.sqrt(d2)
        # The distance shrinks at most at this speed; the factor is for rounding.
        closing = spread + ((ux - vx) * near[j, RX] + (uy - vy) * near[j, RY]) / distance
        earliest = _SAFE * (distance - reach) / closing if closing > 0.0 else math.inf
        if earliest > most:
            continue
        discs += 1
        row = discs
        if row > _SORTED and work[_SORTED, _EARLIEST] > earliest:  # that one goes to the end
            for column in range(6):
                work[row, column] = work[_SORTED, column]
            row = _SORTED
        while 1 < row <= _SORTED and work[row - 1, _EARLIEST] > earliest:
            for column in range(6):
                work[row, column] = work[row - 1, column]
            row -= 1
        work[row, 0], work[row, 1] = near[j, RX], near[j, RY]
        work[row, 2], work[row, 3], work[row, 4] = vx, vy, gap2
        work[row, _EARLIEST] = earliest
    row = discs
    limit = range_ + surface * agent[RADIUS]
    for s in range(wall_count):
        d2 = walls[s, WALL_D2]
        if d2 > limit * limit:
            continue
        if d2 <= agent[RADIUS] ** 2:
            touched += 1
            continue
        row += 1
        work[row, 0], work[row, 1] = walls[s, AX], walls[s, AY]
        work[row, 2], work[row, 3] = walls[s, BX], walls[s, BY]
        gap, fastest = math.sqrt(d2) - agent[RADIUS], spread + math.hypot(ux, uy)
        work[row, _EARLIEST] = _SAFE * gap / fastest if fastest > 0.0 else math.inf
    work[0, DISCS], work[0, SEGMENTS], work[0, TOUCHED] = discs, row - discs, touched
    return row


@array_kernel
def first_collision(ux: float, uy: float, until: float, agent: Pointer, work: Pointer) -> float:
    """Time until a collision with what `list_obstacles` wrote, s; ``inf`` if there is none.

    What touches already does not count: see `first_contact`.

    Args:
        until: a time below which the exact value does not matter; the search stops there.
    """
    work = work_table(work)
    first, discs = math.inf, int(work[0, DISCS])
    for j in range(1, discs + 1):
        if work[j, _EARLIEST] >= first:
            if j <= _SORTED:
                break
            continue
        t = time_to_disc(work[j, 0], work[j, 1], ux - work[j, 2], uy - work[j, 3], work[j, 4])
        if t < first:
            first = t
            if first < until:
                return first
    for j in range(discs + 1, discs + 1 + int(work[0, SEGMENTS])):
        if work[j, _EARLIEST] >= first:
            continue
        ax, ay, bx, by = work[j, 0], work[j, 1], work[j, 2], work[j, 3]
        if agent[PARITY] != 0.0:
            t = crossing_time(ux, uy, agent[RADIUS], ax, ay, bx, by)
            if t <= 0.0:  # counted from the centre, this may be 0 short of a touch
                continue
        else:
            t = time_to_segment(ux, uy, agent[RADIUS], ax, ay, bx, by)
        first = min(first, t)
    return first


@array_kernel
def soonest_disc(
    count: int,
    ux: Pointer,
    uy: Pointer,
    factor: float,
    vx: float,
    vy: float,
    work: Pointer,
    out: Pointer,
) -> None:
    """One over the time until a disc is touched, 1/s, for many velocities at once.

    Of the few discs that could be first; zero if none of them is touched. Right but for rounding.
    See `time_to_disc`.

    Args:
        count, ux, uy: velocities; ``factor * u - v`` is kept, m/s.
    """
    work = work_table(work)
    for c in range(count):
        out[c] = 0.0
    for j in range(1, min(_FEW, int(work[0, DISCS])) + 1):
        rx, ry, gap2 = work[j, 0], work[j, 1], work[j, 4]
        wx, wy, per_gap2 = work[j, 2], work[j, 3], 1.0 / gap2
        for c in range(count):
            # Rounded as in `first_collision`, so that both agree on who is just missed.
            ox, oy = factor * ux[c] - vx - wx, factor * uy[c] - vy - wy
            approach = rx * ox + ry * oy
            root = approach * approach - (ox * ox + oy * oy) * gap2
            rate = (approach + math.sqrt(max(0.0, root))) * per_gap2
            touches = approach > 0.0 and root > 0.0
            out[c] = max(out[c], rate if touches else 0.0)


@array_kernel
def first_contact(ux: float, uy: float, agent: Pointer, work: Pointer) -> float:
    """As `first_collision`, but 0 where something touches the agent already.

    Under parity also 0 beside somebody with exactly the velocity u: the original takes a
    vanishing discriminant for a touch.
    """
    table = work_table(work)
    if table[0, TOUCHED] > 0.0:
        return 0.0
    if agent[PARITY] != 0.0:
        discs = int(table[0, DISCS])
        for j in range(1, discs + 1):
            if ux == table[j, 2] and uy == table[j, 3]:
                return 0.0
        if ux == 0.0 and uy == 0.0 and table[0, SEGMENTS] > 0.0:
            return 0.0
        for j in range(discs + 1, discs + 1 + int(table[0, SEGMENTS])):
            ax, ay, bx, by = table[j, 0], table[j, 1], table[j, 2], table[j, 3]
            if crossing_time(ux, uy, agent[RADIUS], ax, ay, bx, by) <= 0.0:
                return 0.0
    return first_collision(ux, uy, 0.0, agent, work)
