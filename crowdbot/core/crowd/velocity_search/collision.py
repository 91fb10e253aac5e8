"""First collision of an agent with constant velocity, shared by many costs."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import crossing_time, time_to_disc, time_to_segment
from crowdbot.core.crowd.velocity_search.collision_rows import (
    DISC_ROW,
    HEADER,
    SAFE,
    SEGMENT_ROW,
    DiscRow,
    SegmentRow,
)
from crowdbot.core.crowd.velocity_search.collision_walls import (
    SORTED_SEGMENTS,
    is_behind,
    is_passed,
    list_segments,
    swept_width,
)
from crowdbot.core.crowd.velocity_search.cost import Pointer
from crowdbot.core.crowd.velocity_search.farther_walls import first_farther
from crowdbot.core.crowd.velocity_search.records import (
    COST_PARAMS,
    AgentRecord,
    NeighbourRecord,
    WallRecord,
)
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.support.records import Rows, as_record, as_rows

#: Number of discs sorted by that time; all others come later. Sorting hundreds would take longer
#: than skipping them.
_SORTED = 12
#: Number of discs in lower bounds: later ones are seldom the first.
_FEW = 3


@array_kernel
def list_obstacles(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
    fastest: float,
) -> int:
    """Write everything within range to ``work``; return the number of rows.

    The number is one higher if walls beyond those given may matter. Row 0 is a `CollisionHeader`;
    of the other rows the first six columns are written, the rest is free for the caller.

    Args:
        fastest: largest speed in later calls of `first_collision`, m/s.
    """
    return list_approaching(
        agent, near, near_count, walls, wall_count, params, work, 0.0, 0.0, fastest, math.inf
    )


@array_kernel
def list_approaching(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
    ux: float,
    uy: float,
    spread: float,
    horizon: float,
) -> int:
    """Write the discs and walls that can be touched within ``horizon`` (s) to ``work``.

    As `list_obstacles`. Most discs in a range of 100 m move away or are too far. With parity all
    are written, since `first_contact` uses them.

    Args:
        ux, uy, spread: disc with all velocities in later calls of `first_collision`, m/s.
    """
    own, header = as_record(params, COST_PARAMS), as_record(work, HEADER)
    rows = as_rows(work, DISC_ROW)
    range_, surface, touched, discs = own.range, own.from_surface, 0, 0
    most = horizon if agent.parity == 0.0 else math.inf
    every = most == math.inf
    for j in range(near_count):
        d2, reach = near[j].d2, near[j].reach
        limit, gap2, distance = range_ + surface * reach, d2 - reach * reach, math.sqrt(d2)
        # The distance decreases at most at this speed; the factor covers rounding.
        x, y = near[j].rx, near[j].ry
        closing = spread + ((ux - near[j].nvx) * x + (uy - near[j].nvy) * y) / distance
        earliest, closes = SAFE * (distance - reach) / closing, closing > 0.0
        # Computed and written always, and kept if it counts: branches would be mispredicted.
        rows[discs + 1].earliest, rows[discs + 1].gap2 = earliest, j  # which neighbour: see below
        if every and not closes:
            rows[discs + 1].earliest = math.inf
        within = d2 < limit * limit
        touched += int(within & (gap2 <= 0.0))
        counts = every | (closes & (not earliest > most))
        discs += int(within & (gap2 > 0.0) & counts)
    header.later = _sort_first(rows, discs)
    for row in range(1, discs + 1):
        disc, other = rows[row], near[int(rows[row].gap2)]
        disc.x, disc.y, disc.vx, disc.vy = other.rx, other.ry, other.nvx, other.nvy
        disc.gap2 = other.d2 - other.reach * other.reach
    limit, fastest = range_ + surface * agent.radius, spread + math.hypot(ux, uy)
    count, touching = list_segments(discs, agent, walls, wall_count, limit, fastest, most, work)
    header.discs, header.segments, header.touched = discs, count, touched + touching
    return discs + count + int(header.unlisted > 0.0)


@array_kernel
def _sort_first(rows: Rows[DiscRow], discs: int) -> float:
    """Sort the first of the discs by time.

    Moves ``earliest``, and ``gap2``, which holds the index of the neighbour until rows are filled.

    Returns:
        the least ``earliest`` of the discs after those, s.
    """
    later = math.inf
    for k in range(2, discs + 1):
        earliest, index, row = rows[k].earliest, rows[k].gap2, k
        if row > _SORTED:
            later = min(later, max(earliest, rows[_SORTED].earliest))
            if rows[_SORTED].earliest > earliest:  # that one goes to the end
                rows[row].earliest, rows[row].gap2 = rows[_SORTED].earliest, rows[_SORTED].gap2
                row = _SORTED
        while 1 < row <= _SORTED and rows[row - 1].earliest > earliest:
            rows[row].earliest, rows[row].gap2 = rows[row - 1].earliest, rows[row - 1].gap2
            row -= 1
        rows[row].earliest, rows[row].gap2 = earliest, index
    return later


@array_kernel
def first_collision(ux: float, uy: float, until: float, agent: AgentRecord, work: Pointer) -> float:
    """Return the time until a collision with a row of `list_obstacles`, s; ``inf`` if none.

    Existing contacts do not count, see `first_contact`. Walls that were not given are looked up
    where one of them may be the first.

    Args:
        until: a time below which any value is accepted; the search stops there.
    """
    header, first = as_record(work, HEADER), _first_segment(ux, uy, until, agent, work)
    # Many walls are near, and then few discs come before.
    if not first < until:
        first = _first_disc(ux, uy, until, first, work)
    if header.unlisted > 0.0 and not first < until:
        first = first_farther(ux, uy, until, first, header.unlisted, agent)
    return first


@array_kernel
def _first_disc(ux: float, uy: float, until: float, first: float, work: Pointer) -> float:
    """Return the time until a disc is touched, s, or any below ``until``; or ``first``."""
    header, rows = as_record(work, HEADER), as_rows(work, DISC_ROW)
    for j in range(1, int(header.discs) + 1):
        disc = rows[j]
        if disc.earliest >= first:
            if j <= _SORTED:
                break
            continue
        t = time_to_disc(disc.x, disc.y, ux - disc.vx, uy - disc.vy, disc.gap2)
        first = min(first, t)
        if first < until or (j == _SORTED and header.later >= first):
            break
    return first


@array_kernel
def _first_segment(ux: float, uy: float, until: float, agent: AgentRecord, work: Pointer) -> float:
    """Return the time until a listed segment is touched, s, or any below ``until``.

    The one that came first at the last velocity is tried first: often it is soon enough again.
    """
    header, segments, first = as_record(work, HEADER), as_rows(work, SEGMENT_ROW), math.inf
    if header.segments == 0.0:
        return first
    discs, width = int(header.discs), swept_width(ux, uy, agent.radius)
    last, known = discs + SORTED_SEGMENTS, int(segments[discs + 1].later)
    if known > 0:
        first = _touched(segments[known], ux, uy, width, agent)
        if first < until:
            return first
    # The original counts a wall's line as touched, which may be before the wall itself is.
    speed2 = ux * ux + uy * uy if agent.parity == 0.0 else math.inf
    soonest = known
    for j in range(discs + 1, discs + 1 + int(header.segments)):
        segment = segments[j]
        if segment.earliest >= first:
            if j <= last:
                break
            continue
        ax, ay, bx, by = segment.ax, segment.ay, segment.bx, segment.by
        if not is_behind(ux, uy, first * speed2, width, ax, ay, bx, by):
            t = _touched(segment, ux, uy, width, agent)
            if t < first:
                first, soonest = t, j
        if first < until or (j == last and segment.later >= first):
            break
    segments[discs + 1].later = soonest
    return first


@array_kernel
def _touched(segment: SegmentRow, ux: float, uy: float, width: float, agent: AgentRecord) -> float:
    """Return the time until a segment is touched, s; ``inf`` if never.

    Args:
        width: from `swept_width`.
    """
    ax, ay, bx, by = segment.ax, segment.ay, segment.bx, segment.by
    if is_passed(ux, uy, width, ax, ay, bx, by):
        return math.inf
    if agent.parity == 0.0:
        return float(time_to_segment(ux, uy, agent.radius, ax, ay, bx, by))
    t = crossing_time(ux, uy, agent.radius, ax, ay, bx, by)
    return float(t) if t > 0.0 else math.inf  # from the centre, this may be 0 just before contact


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
    """Write the inverse time to the first contact with a disc, 1/s, for many velocities at once.

    Only the few discs that could be first are tried; zero without contact. Exact up to rounding.
    See `time_to_disc`.

    Args:
        count, ux, uy: velocities; ``factor * u - v`` is kept, m/s.
    """
    header, rows = as_record(work, HEADER), as_rows(work, DISC_ROW)
    for c in range(count):
        out[c] = 0.0
    for j in range(1, min(_FEW, int(header.discs)) + 1):
        rx, ry, gap2 = rows[j].x, rows[j].y, rows[j].gap2
        wx, wy, per_gap2 = rows[j].vx, rows[j].vy, 1.0 / gap2
        for c in range(count):
            # Rounded as in `first_collision`, so that both agree on near misses.
            ox, oy = factor * ux[c] - vx - wx, factor * uy[c] - vy - wy
            approach = rx * ox + ry * oy
            root = approach * approach - (ox * ox + oy * oy) * gap2
            rate = (approach + math.sqrt(max(0.0, root))) * per_gap2
            touches = approach > 0.0 and root > 0.0
            out[c] = max(out[c], rate if touches else 0.0)


@array_kernel
def first_contact(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, until: float = 0.0
) -> float:
    """Return the time to the first contact, s; 0 if something is already in contact.

    Otherwise as `first_collision`. Under parity also 0 beside a disc with exactly the velocity u:
    the original takes a vanishing discriminant for a touch.
    """
    header, rows = as_record(work, HEADER), as_rows(work, DISC_ROW)
    segments = as_rows(work, SEGMENT_ROW)
    if header.touched > 0.0:
        return 0.0
    if agent.parity != 0.0:
        discs = int(header.discs)
        for j in range(1, discs + 1):
            if ux == rows[j].vx and uy == rows[j].vy:
                return 0.0
        if ux == 0.0 and uy == 0.0 and header.segments > 0.0:
            return 0.0
        for j in range(discs + 1, discs + 1 + int(header.segments)):
            segment = segments[j]
            ax, ay, bx, by = segment.ax, segment.ay, segment.bx, segment.by
            if crossing_time(ux, uy, agent.radius, ax, ay, bx, by) <= 0.0:
                return 0.0
    return first_collision(ux, uy, until, agent, work)
