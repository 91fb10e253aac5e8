"""Robots that topple without fault: a faster person strikes them from behind as they drive on."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crowdbot.core.trajectories.encounters import (
    people,
    people_velocities,
    robot_of,
    robot_velocities,
)
from crowdbot.core.trajectories.fault.at_fault import at_fault
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.person_contacts import PersonContacts, person_contacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: The rule of fault with the values that metrics have by default.
USUAL_RULE = FaultRule(speed=0.05 + 1e-9, reaction=0.3, braking=1.0, margin=0.1)
#: As metrics find contacts: a teleport is faster, m/s; surfaces touch; a contact has ended, m.
_JUMP, _TOUCH, _RELEASE = 10.0, 1e-9, 0.05
#: The robot topples within this time of the touch, s.
_SOON = 2.0
#: So long before the touch it drove steadily, s: at least this fast, m/s, without braking harder,
#: m/s^2, over this time, s, and without turning further, rad.
_BEFORE, _DRIVES, _BRAKING, _WINDOW, _TURN = 2.0, 0.1, 0.5, 0.5, 0.35


@dataclass(frozen=True, slots=True)
class TopplingContact:
    """The contact by which a robot toppled.

    Attributes:
        agent: column of the person.
        t: onset, s.
    """

    agent: int
    t: float


def struck_over(run: Trajectories, toppled_time: float) -> TopplingContact | None:
    """Return the contact that excuses a toppled robot; None if none does.

    No contact of the run is its fault; the first contact in the last two seconds is by a faster
    person from behind; and in the two seconds before, the robot drove on, neither braking harder
    than 0.5 m/s^2 nor turning by more than 20 degrees. So a planner cannot provoke it: a robot that
    stands, brakes in front of people or turns in is not excused.

    Args:
        run: a run with a robot, to the end.
        toppled_time: when the robot lay, s.
    """
    found = person_contacts(run, _JUMP, _TOUCH, _RELEASE)
    if at_fault(run, found, USUAL_RULE, _JUMP).any():
        return None
    last = (found.time <= toppled_time) & (found.time >= toppled_time - _SOON)
    if not last.any():
        return None
    k = int(np.argmin(np.where(last, found.time, np.inf)))
    if not (_steady(run, float(found.time[k])) and _from_behind(run, found, k)):
        return None
    return TopplingContact(int(found.agent[k]), float(found.time[k]))


def _steady(run: Trajectories, onset: float) -> bool:
    """Return True if the robot drove on without braking or turning before a time, s."""
    before = (run.t <= onset) & (run.t >= onset - _BEFORE)
    vx, vy = (v[before] for v in robot_velocities(run, _JUMP))
    known = np.isfinite(vx) & np.isfinite(vy)
    if onset - run.t[0] < _BEFORE or not known.all():
        return False
    speed, t = np.hypot(vx, vy), run.t[before]
    if not len(speed) or speed.min() < _DRIVES:
        return False
    way = np.unwrap(np.arctan2(vy, vx))
    return bool(np.ptp(way) <= _TURN) and _largest_drop(t, speed) <= _BRAKING * _WINDOW


def _largest_drop(t: Array, speed: Array) -> float:
    """Return by how much the speed falls at most within the window, m/s."""
    later = (t[np.newaxis] >= t[:, np.newaxis]) & (t[np.newaxis] <= t[:, np.newaxis] + _WINDOW)
    return float(np.where(later, speed[:, np.newaxis] - speed[np.newaxis], 0.0).max())


def _from_behind(run: Trajectories, contacts: PersonContacts, k: int) -> bool:
    """Return True if a faster person came from behind the robot's motion."""
    agent, n = int(contacts.agent[k]), int(contacts.sample[k])
    if agent < 0:
        return False
    robot, crowd = robot_of(run), people(run)
    vx, vy = (float(v[n]) for v in robot_velocities(run, _JUMP))
    px, py = (float(v[n, agent]) for v in people_velocities(run, _JUMP))
    dx, dy = float(crowd.x[n, agent] - robot.x[n]), float(crowd.y[n, agent] - robot.y[n])
    speed = math.hypot(vx, vy)
    return dx * vx + dy * vy < 0.0 and px * vx + py * vy > speed * speed > 0.0
