"""Contacts in which the robot keeps pushing, however gently they began."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, people_velocities
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.fault.touch_point import TouchPoint, touch_point
from crowdbot.core.trajectories.person_contacts import PersonContacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices, Mask


def pushed_on(
    run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float
) -> Mask:
    """Return a mask of contacts (K,) in which the robot keeps pushing the person.

    The robot has the reaction time, then it must slow down from its speed at the onset; for a
    contact in the first sample that speed is 0. A robot that approaches faster than that, or moves
    the person by more than the margin, keeps pushing. Samples do not count in which the person
    leaves faster, or in which another person touches the robot from the other side, who may be the
    one that pushes.

    Args:
        run: the run of ``contacts``.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    lasting = [_during(run, contacts, k) for k in range(len(contacts))]
    pushes = np.zeros(len(contacts), dtype=bool)
    for k, sample in enumerate(lasting):
        since = run.t[sample] - contacts.time[k]
        if not (since > rule.reaction).any():
            continue
        there = touch_point(run, sample, np.full(len(sample), contacts.agent[k]), jump_speed)
        others = [
            i for i in range(len(contacts)) if contacts.agent[i] not in (-1, contacts.agent[k])
        ]
        beside = [(int(contacts.agent[i]), lasting[i]) for i in others]
        presses = _presses(run, there, sample, int(contacts.agent[k]), rule, jump_speed)
        presses &= ~_shoved(run, there, sample, beside, jump_speed)
        speed = _speed_before(run, contacts, k, jump_speed)
        lasts = np.diff(run.t, prepend=run.t[0])[sample]
        pushes[k] = _too_much(there.closing, since, lasts, presses, speed, rule)
    return pushes


def _during(run: Trajectories, contacts: PersonContacts, k: int) -> Indices:
    """Return the samples within a contact; none if the person is unknown."""
    if contacts.agent[k] < 0:
        return np.empty(0, dtype=np.intp)
    first = int(np.searchsorted(run.t, contacts.time[k] - 1e-9))
    last = int(np.searchsorted(run.t, contacts.end[k] + 1e-9, side="right"))
    return np.arange(first, last)


def _speed_before(run: Trajectories, contacts: PersonContacts, k: int, jump_speed: float) -> float:
    """Return the speed of the touching point before a contact, m/s; 0 if there is no before."""
    if contacts.time[k] <= run.t[0] + 1e-9:
        return 0.0
    one = slice(k, k + 1)
    return float(touch_point(run, contacts.sample[one], contacts.agent[one], jump_speed).speed[0])


def _too_much(
    closing: Array, since: Array, lengths: Array, presses: Mask, speed: float, rule: FaultRule
) -> bool:
    """Return True if the robot presses faster than the rule allows, or farther than the margin."""
    counts = presses & (since > rule.reaction)
    allowed = np.maximum(0.0, speed - rule.braking * (since - rule.reaction)) + rule.speed
    way = float((closing * lengths)[counts].sum())
    return bool((counts & (closing > allowed)).any()) or (
        way > rule.margin + speed**2 / (2.0 * rule.braking)
    )


def _presses(
    run: Trajectories,
    there: TouchPoint,
    sample: Indices,
    agent: int,
    rule: FaultRule,
    jump_speed: float,
) -> Mask:
    """Return a mask of samples in which the robot comes nearer and the person does not leave."""
    px, py = (v[sample, agent] for v in people_velocities(run, jump_speed))
    leaves = px * there.nx + py * there.ny
    return np.asarray((there.closing > 0.0) & ~(leaves > there.closing + rule.speed))


def _shoved(
    run: Trajectories,
    there: TouchPoint,
    sample: Indices,
    others: list[tuple[int, Indices]],
    jump_speed: float,
) -> Mask:
    """Return a mask of samples in which another person touches the robot from the other side."""
    shoved = np.zeros(len(sample), dtype=bool)
    pair = encounter(run, jump_speed)
    for agent, lasting in others:
        both = np.isin(sample, lasting)
        if both.any():
            px, py = (p[sample, agent] for p in (pair.px, pair.py))
            shoved |= both & (px * there.nx + py * there.ny < 0.0)
    return shoved
