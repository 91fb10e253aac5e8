"""Contacts caused only by a change of the robot's motion, even if foreseeable too late."""

from __future__ import annotations

import numpy as np

from crowdbot.core.geometry.footprint import into_frame
from crowdbot.core.trajectories.encounters import (
    Encounter,
    encounter,
    people,
    people_velocities,
    robot_of,
    robot_velocities,
)
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.fault.touch_point import touch_point
from crowdbot.core.trajectories.person_contacts import PersonContacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask

#: The motion before is that of this many reaction times before the contact.
_BEFORE = 2.0


def swerved(
    run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float
) -> Mask:
    """Return a mask of contacts (K,) that the robot caused by a turn or a start.

    The touching point moves towards the person. Had the robot kept its velocity of two reaction
    times before, it would have passed at more than the margin; had the person kept theirs, the
    robot would still have come within the margin. So the robot's change alone caused it. A robot
    that slows down is not counted.

    Args:
        run: the run of ``contacts``.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    moves = (contacts.closing > rule.speed) & (contacts.agent >= 0)
    made = [bool(m) and _came_over(run, contacts, k, rule, jump_speed) for k, m in enumerate(moves)]
    return np.array(made, dtype=bool)


def _came_over(
    run: Trajectories, contacts: PersonContacts, k: int, rule: FaultRule, jump: float
) -> bool:
    agent, last = int(contacts.agent[k]), int(contacts.sample[k])
    robot, crowd, pair = robot_of(run), people(run), encounter(run, jump)
    first = int(np.searchsorted(run.t, contacts.time[k] - _BEFORE * rule.reaction - 1e-9))
    span = np.arange(first, min(last + 2, len(run.t)))
    span = span[np.isfinite(pair.gap[span, agent])]
    if not len(span):
        return False
    since = run.t[span] - run.t[span[0]]
    straight = [
        p[span[0]] + v[span[0]] * since
        for p, v in zip((robot.x, robot.y), robot_velocities(run, jump), strict=True)
    ]
    there = touch_point(run, np.array([last]), np.array([agent]), jump)
    over = (robot.x[last] - np.interp(run.t[last] - run.t[span[0]], since, straight[0])) * there.nx
    over += (robot.y[last] - np.interp(run.t[last] - run.t[span[0]], since, straight[1])) * there.ny
    px, py = crowd.x[span, agent], crowd.y[span, agent]
    theta = np.full(len(span), pair.theta[span[0]])
    passed = _gap(pair, agent, px - straight[0], py - straight[1], theta)
    walks = [v[span[0], agent] * since for v in people_velocities(run, jump)]
    met = _gap(
        pair, agent, px[0] + walks[0] - robot.x[span], py[0] + walks[1] - robot.y[span],
        pair.theta[span],
    )  # fmt: skip
    turned = pair.footprint is not None or bool(over > 0.0)
    return turned and passed > rule.margin and met <= rule.margin


def _gap(pair: Encounter, agent: int, x: Array, y: Array, theta: Array) -> float:
    """Return the smallest gap to a person at places (N,) from the robot, m; NaN: unknown."""
    if pair.footprint is None:
        return float(np.min(np.hypot(x, y) - pair.reach[agent]))
    return float(np.min(pair.footprint.gap(*into_frame(theta, x, y)) - pair.reach[agent]))
