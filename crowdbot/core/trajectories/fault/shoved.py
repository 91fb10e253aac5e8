"""Contacts into which another person pushes a standing robot."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, people_velocities, robot_velocities
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.fault.touch_point import TouchPoint, touch_point
from crowdbot.core.trajectories.person_contacts import PersonContacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Mask


def shoved_into(
    run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float
) -> Mask:
    """Return a mask of contacts (K,) into which another person pushes the robot.

    The robot stood still before the other person touched it; that contact lasts, is on the other
    side, and that person moves at least as fast towards the first one as the robot does. A robot
    that drove before is not excused, nor is one that leaves the person behind it.

    Args:
        run: the run of ``contacts``.
        contacts: its contacts.
        rule: the fault rule.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    shoved = np.zeros(len(contacts), dtype=bool)
    speed = np.hypot(*robot_velocities(run, jump_speed))
    for k in np.flatnonzero(contacts.agent >= 0):
        others = (contacts.agent >= 0) & (contacts.agent != contacts.agent[k])
        others &= (contacts.time < contacts.time[k]) & (contacts.end >= contacts.time[k])
        others &= speed[contacts.sample] <= rule.speed
        if others.any():
            at = contacts.sample[k : k + 1]
            there = touch_point(run, at, contacts.agent[k : k + 1], jump_speed)
            pushes = [_pushes(run, int(a), there, int(at[0]), rule, jump_speed)
                      for a in contacts.agent[others]]  # fmt: skip
            shoved[k] = any(pushes)
    return shoved


def _pushes(
    run: Trajectories, agent: int, there: TouchPoint, sample: int, rule: FaultRule, jump: float
) -> bool:
    """Return True if a person is on the other side, and follows as fast as the robot moves."""
    pair, nx, ny = encounter(run, jump), there.nx[0], there.ny[0]
    vx, vy = (v[sample, agent] for v in people_velocities(run, jump))
    behind = pair.px[sample, agent] * nx + pair.py[sample, agent] * ny < 0.0
    return bool(behind and vx * nx + vy * ny >= there.closing[0] - rule.speed)
