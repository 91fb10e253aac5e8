"""The person of a robot's task over a run, from the tracks of people."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.stance import PersonCircle, together
from crowdbot.core.trajectories.trajectories import AgentTracks
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.person_task import TaskPerson

#: People face where they walk when faster than this, m/s, as in the crowd engine.
_TURNS_ABOVE = 0.1


def members_of(agents: AgentTracks, who: TaskPerson) -> NDArray[np.int64]:
    """Return columns of the people that a task is about; those who are recorded."""
    return np.flatnonzero(np.isin(agents.id, who.id))


def person_over_time(agents: AgentTracks, who: TaskPerson) -> PersonCircle:
    """Return the person, or the circle around the group: arrays (N,), NaN where absent."""
    columns = members_of(agents, who)
    start = {int(i): f for i, f in zip(who.id, who.facing.tolist(), strict=True)}
    first = np.array([start[int(i)] for i in agents.id[columns]])
    facing = facing_over_time(agents.vx[:, columns], agents.vy[:, columns], first)
    return together(agents.x[:, columns], agents.y[:, columns], facing, agents.radius[columns])


def facing_over_time(vx: Array, vy: Array, first: Array) -> Array:
    """Return where people face (N, M), rad: where they walk, or walked last.

    Args:
        vx, vy: (N, M) m/s, NaN where absent.
        first: (M,) at the start, rad.
    """
    walks = np.hypot(vx, vy) > _TURNS_ABOVE
    walks[0] = True
    angle = np.where(walks, np.arctan2(vy, vx), np.nan)
    angle[0] = np.where(np.hypot(vx[0], vy[0]) > _TURNS_ABOVE, angle[0], first)
    latest = np.maximum.accumulate(np.where(walks, np.arange(len(vx))[:, None], 0), axis=0)
    return np.take_along_axis(angle, latest, axis=0)
