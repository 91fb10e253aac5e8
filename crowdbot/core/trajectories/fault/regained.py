"""People who regain the velocity that they had before they bounced off something else."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import people_velocities
from crowdbot.core.trajectories.evasion import Evasion
from crowdbot.core.trajectories.touched import touched_by_others
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices


def regained(
    run: Trajectories, evasion: Evasion, agents: Indices, within: float, jump_speed: float
) -> Array:
    """Return the part of accelerations away from the robot that only regains speed (N-1, M), m/s².

    Another person or a wall has slowed or deflected the person; in the time after it they regain
    the velocity of the last sample before it. What they do beyond that counts as before.

    Args:
        run: with a robot.
        evasion: accelerations of the same run.
        agents: (K,) columns of the people who are asked for; 0 elsewhere.
        within: this long after the touch, s.
        jump_speed: a faster step is a teleport where none are recorded, m/s.
    """
    selected = np.zeros(evasion.near.shape, dtype=bool)
    selected[:, agents] = True
    struck = touched_by_others(run, selected)
    vx, vy = people_velocities(run, jump_speed)
    back = np.zeros(evasion.away.shape)
    for m in agents.tolist():
        before, until = np.full(2, np.nan), -np.inf
        for k in range(len(evasion.dt)):
            if struck[k, m]:
                if run.t[k] > until or np.isnan(before).any():
                    at = max(0, k - 1)
                    before = np.array([vx[at, m], vy[at, m]])
                until = run.t[k + 1] + within
            elif run.t[k] < until and evasion.away[k, m] > 0.0:
                nx, ny = evasion.nx[k, m], evasion.ny[k, m]
                missing = (before[0] - vx[k, m]) * nx + (before[1] - vy[k, m]) * ny
                back[k, m] = min(evasion.away[k, m], max(0.0, missing) / evasion.dt[k])
    return back
