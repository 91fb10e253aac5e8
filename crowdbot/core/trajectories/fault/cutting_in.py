"""Contacts of people with a robot that cut into their path too late for them to stop."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import people, people_velocities, robot_of
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.person_contacts import PersonContacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask

_STILL = 1e-6  # m/s


def cut_in(run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float) -> Mask:
    """Return a mask of contacts (K,) before which the robot cut in.

    A person who is faster than the robot and keeps walking straight on would have passed beside it,
    had the robot not moved sideways onto the person's way; and it did so later than the person
    needs to react and to slow down to the robot's speed, ``reaction + difference / braking``. A
    robot that only slows down or stops on its way does not cut in; of people who come towards it,
    it is judged by its braking.

    Args:
        run: the run of ``contacts``.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    return np.array(
        [_cuts(run, contacts, k, rule, jump_speed) for k in range(len(contacts))], dtype=bool
    )


def _cuts(
    run: Trajectories, contacts: PersonContacts, k: int, rule: FaultRule, jump: float
) -> bool:
    agent, last = int(contacts.agent[k]), int(contacts.sample[k])
    if agent < 0:
        return False
    robot, crowd = robot_of(run), people(run)
    vx, vy = (v[:, agent] for v in people_velocities(run, jump))
    rx, ry = robot.x - crowd.x[:, agent], robot.y - crowd.y[:, agent]
    walks = float(np.hypot(vx[last], vy[last]))
    if not walks > rule.speed:
        return False
    ux, uy = vx[last] / walks, vy[last] / walks
    along = _along(robot.x, robot.y, run.t, last, ux, uy)
    difference = walks - along
    ahead = rx[last] * ux + ry[last] * uy
    if not (along > -rule.speed and difference > rule.speed and ahead > 0.0):
        return False
    first = int(
        np.searchsorted(run.t, contacts.time[k] - rule.reaction - difference / rule.braking)
    )
    since = np.flatnonzero(np.isfinite(rx[first : last + 1]) & np.isfinite(vx[first : last + 1]))
    if not len(since):
        return False
    return _moved_onto(run, agent, first + int(since[0]), last, (vx, vy), rule)


def _along(x: Array, y: Array, t: Array, last: int, ux: float, uy: float) -> float:
    """Return the robot's speed in a direction before a sample, m/s."""
    before = max(0, last - 1)
    dt = float(t[last] - t[before])
    if dt <= 0.0:
        return 0.0
    return float(((x[last] - x[before]) * ux + (y[last] - y[before]) * uy) / dt)


def _moved_onto(
    run: Trajectories,
    agent: int,
    first: int,
    last: int,
    velocity: tuple[Array, Array],
    rule: FaultRule,
) -> bool:
    """Return True if the robot moved from beside the person's straight way onto it."""
    robot, crowd = robot_of(run), people(run)
    vx, vy = velocity[0][first], velocity[1][first]
    walks = float(np.hypot(vx, vy))
    if walks < _STILL:
        return False
    nx, ny = -vy / walks, vx / walks
    x0, y0 = crowd.x[first, agent], crowd.y[first, agent]

    def aside(x: float, y: float) -> float:
        return abs(float((x - x0) * nx + (y - y0) * ny))

    beside, onto = (aside(robot.x[i], robot.y[i]) for i in (first, last))
    width = float(robot.radius + crowd.radius[agent])
    straight_on = aside(crowd.x[last, agent], crowd.y[last, agent]) < width
    return straight_on and beside > width + rule.margin and onto <= width
