"""Forces that hold groups together: gaze, cohesion and repulsion, on top of any policy.

Source: Moussaïd, Perozo, Garnier, Helbing, Theraulaz, "The walking behaviour of pedestrian social
groups and its impact on crowd dynamics", PLoS ONE 5(4), 2010, e10047, equations 5 to 7.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.state import (
    PRESENT,
    People,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, record_type, record_values, rows_in
from crowdbot.core.types.arrays import Array, Indices
from crowdbot.dsl.scenario.group_forces import GroupForces

#: Members farther away are out of sight and ignored; our value, m.
SIGHT = 8.0


class GroupForcesRecord:
    """Parameters of `hold_together`, see `GroupForces`; half_view: half the field of view, rad."""

    gaze: float
    cohesion: float
    repulsion: float
    half_view: float
    distance: float
    limit: float


_FORCES = record_type(GroupForcesRecord)


def forces_of(spec: GroupForces) -> Rows[GroupForcesRecord]:
    """Return the parameters (1,) for `hold_together`."""
    numbers = record_values(_FORCES, spec, half_view=0.5 * spec.field_of_view)
    return rows_in(numbers, _FORCES)


def groups_of(agents: Agents) -> tuple[Indices, Indices]:
    """Return the rows of all group members by group, and the start of each group.

    Returns:
        (M,) rows in the order of their ids, and (G + 1,) places; without people who are alone.
    """
    found: list[np.ndarray[tuple[int], np.dtype[np.int64]]] = []
    for number in np.unique(agents.group[agents.group >= 0]):
        rows = np.flatnonzero(agents.group == number)
        if len(rows) > 1:
            found.append(rows[np.argsort(agents.id[rows])].astype(np.int64))
    ends = np.cumsum([0, *(len(rows) for rows in found)], dtype=np.int64)
    return (np.concatenate(found) if found else np.zeros(0, np.int64)), ends


@kernel
def hold_together(
    agents: People,
    members: Indices,
    ends: Indices,
    most: Array,
    boundary: Array,
    parameters: Rows[GroupForcesRecord],
) -> None:
    """Add group forces to the desired acceleration of each member on its way.

    Args:
        agents: of the crowd's state, changed in place.
        members, ends: see `groups_of`.
        most: (N,) largest acceleration by own will, m/s^2.
        boundary: (4,) x0, x1, y0, y1 of a torus, m; infinite elsewhere.
        parameters: see `forces_of`.
    """
    forces = parameters[0]
    for g in range(ends.shape[0] - 1):
        for a in range(ends[g], ends[g + 1]):
            i = members[a]
            if agents[i].waiting != PRESENT or agents[i].on_trip == 0.0:
                continue
            ax, ay = _pull(agents, i, members, ends[g], ends[g + 1], boundary, forces)
            scale = _within(ax, ay, forces.limit)
            ax, ay = agents[i].ax + scale * ax, agents[i].ay + scale * ay
            scale = _within(ax, ay, most[i])
            agents[i].ax, agents[i].ay = scale * ax, scale * ay


@kernel
def _pull(
    agents: People,
    i: int,
    members: Indices,
    begin: int,
    end: int,
    boundary: Array,
    forces: GroupForcesRecord,
) -> tuple[float, float]:
    """Return agent i's acceleration by the others of its group, m/s^2."""
    count, mx, my, ax, ay = 1, 0.0, 0.0, 0.0, 0.0
    for b in range(begin, end):
        j = members[b]
        if j == i or agents[j].waiting != PRESENT:
            continue
        dx = _nearest(agents[j].x - agents[i].x, boundary[1] - boundary[0])
        dy = _nearest(agents[j].y - agents[i].y, boundary[3] - boundary[2])
        distance = math.hypot(dx, dy)
        if distance > SIGHT:
            continue
        count += 1
        mx += dx
        my += dy
        if 0.0 < distance < forces.distance:
            ax -= forces.repulsion * dx / distance
            ay -= forces.repulsion * dy / distance
    away = math.hypot(mx, my) / count  # to the centre of all members, including the agent
    if count == 1 or away == 0.0:
        return ax, ay
    ux, uy = mx / count / away, my / count / away
    if away > 0.5 * (count - 1):
        ax += forces.cohesion * ux
        ay += forces.cohesion * uy
    cosine = min(1.0, max(-1.0, agents[i].dir_x * ux + agents[i].dir_y * uy))
    turn = max(0.0, math.acos(cosine) - forces.half_view)
    return ax - forces.gaze * turn * agents[i].vx, ay - forces.gaze * turn * agents[i].vy


@kernel
def _nearest(step: float, width: float) -> float:
    """Return a difference of coordinates, m, to the nearest image on a torus of this width."""
    if math.isinf(width):
        return step
    return step - width * math.floor(step / width + 0.5)


@kernel
def _within(x: float, y: float, limit: float) -> float:
    """Return the factor that shortens a vector to a limit; 1 if it is not longer."""
    norm = math.hypot(x, y)
    return limit / norm if norm > limit else 1.0
