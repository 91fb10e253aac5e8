"""People whom the robot drives aside: only a strong evasion of the person avoids contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crowdbot.core.trajectories.evasion import evasion, own_legs
from crowdbot.core.trajectories.fault.regained import regained
from crowdbot.core.trajectories.headway import share_below
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array


def driven_aside(
    run: Trajectories,
    *,
    push: float,
    headway: float,
    reach: float,
    jump_speed: float,
    rebound: float = 0.0,
) -> Array:
    """Return when each person was driven aside (M,), s on the run's clock; infinite: never.

    Args:
        run: with a robot.
        push: work of the robot per mass above which it drives a person aside, J/kg.
        headway: only steps count on which the robot would reach a person who stood still within
            this time, s.
        reach: people farther off do not evade, m, centre to centre.
        jump_speed: a faster step is a teleport where none are recorded, m/s.
        rebound: this long after another person or a wall has touched a person it does not count
            that the person regains the velocity from before, s.
    """
    found = evasion(run, reach, jump_speed)
    counts = share_below(run, headway, jump_speed) * own_legs(run, reach, jump_speed)
    aside = found.push(counts) > push
    if rebound > 0.0 and aside.any():
        back = regained(run, found, np.flatnonzero(aside), rebound, jump_speed)
        found = replace(found, away=found.away - back)
        aside = found.push(counts) > push
    so_far = np.cumsum(found.dt[:, np.newaxis] * found.away * found.approach * counts, axis=0)
    step = (so_far < np.minimum(push, so_far[-1:])).sum(axis=0)
    return np.where(aside, run.t[np.minimum(step + 1, len(run.t) - 1)], np.inf)
