"""The nearest points of all walls around an agent, for cost functions that sum over them."""

from __future__ import annotations

import math

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.velocity_search.cost import Pointer
from crowdbot.core.crowd.velocity_search.point_grid import SAME_POINT
from crowdbot.core.crowd.velocity_search.records import FLOOR, WALL_ENDS, AgentRecord
from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.support.records import integers_at, record_type, rows_at


class _Count:
    """An entry of ``beyond`` of a `PointGrid`."""

    walls: float


_COUNT = record_type(_Count)


@array_kernel
def write_nearest_points(agent: AgentRecord, work: Pointer) -> tuple[int, float, float]:
    """Write the nearest points of n walls around an agent to ``work``, in the order of the walls.

    In entries k, n + k and 2 n + k: x and y relative to the agent, m; 1, or 0 if an earlier wall
    has the same point.

    Returns:
        n; distance within which all points are there, m; number of other walls, in
        which one at the distance plus d counts exp(-d / fading) at least, see
        `CompiledCost.points`.
    """
    floor, cell, within = rows_at(agent.floor, FLOOR)[0], 0, math.inf
    if floor.points_per_metre != 0.0:
        i = math.floor((agent.px - floor.points_left) * floor.points_per_metre)
        j = math.floor((agent.py - floor.points_bottom) * floor.points_per_metre)
        if i < 0.0 or j < 0.0 or i >= floor.points_columns or j >= floor.points_rows:
            return 0, floor.points_reach, floor.number
        cell = int(j * floor.points_columns + i)
        dx = agent.px - floor.points_left - (i + 0.5) / floor.points_per_metre
        dy = agent.py - floor.points_bottom - (j + 0.5) / floor.points_per_metre
        within = floor.points_reach + 0.5 / floor.points_per_metre - math.sqrt(dx * dx + dy * dy)
    first = integers_at(floor.points_first)
    begin, count = first[cell], first[cell + 1] - first[cell]
    walls, px, py = rows_at(floor.points_walls, WALL_ENDS), agent.px, agent.py
    for k in range(count):  # without branches, so that it vectorises
        wall = walls[begin + k]
        ax, ay, bx, by = wall.ax - px, wall.ay - py, wall.bx - px, wall.by - py
        work[k], work[count + k] = nearest_on_segment(0.0, 0.0, ax, ay, bx, by)
    for k in range(count):
        work[2 * count + k] = 1.0
    begins, pairs = integers_at(floor.points_first_pair), integers_at(floor.points_pairs)
    for p in range(begins[cell], begins[cell + 1]):
        k, other = pairs[2 * p], pairs[2 * p + 1]
        dx, dy = work[k] - work[other], work[count + k] - work[count + other]
        if (abs(dx) <= SAME_POINT) & (abs(dy) <= SAME_POINT):
            work[2 * count + k] = 0.0
    return int(count), within, rows_at(floor.points_beyond, _COUNT)[cell].walls
