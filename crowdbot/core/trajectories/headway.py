"""Headway: time until the robot would touch a person who does not move.

It measures the robot's behaviour, not people's reactions: the time until a robot with constant
velocity touches a person who stands still. N samples, M people; world frame, SI units.
"""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, robot_velocities, time_to_contact
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: Surfaces closer than this touch, m; slower motion counts as none, m/s.
_TOUCH, _STILL = 1e-9, 1e-6


def headway(run: Trajectories, jump_speed: float) -> Array:
    """Return the robot's headway (N, M) towards each person, s.

    0 in contact; inf if the robot stands or passes without contact, or the person is absent.
    """
    return run.cached(("headway", jump_speed), lambda: _headway(run, jump_speed))


def share_below(run: Trajectories, limit: float, jump_speed: float) -> Array:
    """Return the share (N-1, M) of each step with headway below a limit (s): 0, one half or 1."""
    short = (headway(run, jump_speed) < limit).astype(np.float64)
    return np.asarray((short[1:] + short[:-1]) / 2.0)


def _headway(run: Trajectories, jump_speed: float) -> Array:
    rx, ry = robot_velocities(run, jump_speed)
    pair = encounter(run, jump_speed)
    shape = np.ones(pair.px.shape)
    towards = -rx[:, None] * shape, -ry[:, None] * shape
    return time_to_contact(pair, towards, contact_tol=_TOUCH, rel_speed_tol=_STILL)
