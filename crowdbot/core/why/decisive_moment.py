"""The decisive moment of a run: when it was decided, why, and who was involved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crowdbot.core.runs.record_parts import EndedPart
from crowdbot.core.trajectories.encounters import encounter, robot_of, robot_velocities
from crowdbot.core.trajectories.fault.at_fault import at_fault
from crowdbot.core.trajectories.fault.driven_aside import driven_aside
from crowdbot.core.trajectories.person_contacts import PersonContacts, person_contacts
from crowdbot.core.trajectories.preprocess import truncate_at_arrival
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.worst_moment import CONTACT_TOL, JUMP_SPEED, RELEASE_GAP, RULE
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.ending import Ending
from crowdbot.core.why.causes import Cause

#: Defaults of the metric ``safe_efficiency``; J/kg, s, m.
ASIDE = {"push": 0.25, "headway": 0.5, "reach": 2.0}
#: A robot below this speed stands, m/s.
STANDING = 0.05
#: Share of the run that a robot stands, from which standing is why time ran out.
_BLOCKED = 0.2
#: A person who touched the robot so long before the run ended is named, s.
_BEFORE_ENDING = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DecisiveMoment:
    """The moment at which a run was decided.

    Attributes:
        cause: what it was: the ending itself, if that says it.
        t: when, on the run's clock, s.
        agent: column of the person who was involved; None: no person.
        stood: how long the robot stood from then on, s, where that is the cause.
    """

    cause: Ending | Cause
    t: float
    agent: int | None = None
    stood: float = 0.0


def decisive_moment(run: Trajectories, ended: EndedPart) -> DecisiveMoment:
    """Return the moment that decided a run with a robot.

    Args:
        run: as recorded.
        ended: ending of the run, or of this robot.
    """
    run = truncate_at_arrival(run)
    contacts = person_contacts(run, JUMP_SPEED, CONTACT_TOL, RELEASE_GAP)
    last = float(run.t[-1])
    if ended.status.happened:
        t = last if ended.toppled_time is None else ended.toppled_time
        agent = None if ended.status.failed else _last_touch(contacts, t)
        return DecisiveMoment(cause=ended.status, t=t, agent=agent)
    return (
        _first(contacts, at_fault(run, contacts, RULE, JUMP_SPEED), Cause.RAN_INTO)
        or _wall(run)
        or (late_moment(run) if ended.status == Ending.TIMEOUT else None)
        or _aside(run)
        or _first(contacts, np.ones(len(contacts), dtype=bool), Cause.STRUCK)
        or _closest(run)
    )


def _first(contacts: PersonContacts, which: Mask, cause: Cause) -> DecisiveMoment | None:
    """Return the first of some contacts with people."""
    if not which.any():
        return None
    k = int(np.argmin(np.where(which, contacts.time, np.inf)))
    agent = int(contacts.agent[k])
    return DecisiveMoment(
        cause=cause, t=float(contacts.time[k]), agent=agent if agent >= 0 else None
    )


def _wall(run: Trajectories) -> DecisiveMoment | None:
    found = run.contacts
    walls = np.zeros(0, bool) if found is None else found.agent == -1
    if found is None or not walls.any():
        return None
    return DecisiveMoment(cause=Cause.WALL, t=float(found.t0[walls].min()))


def _aside(run: Trajectories) -> DecisiveMoment | None:
    times = driven_aside(run, jump_speed=JUMP_SPEED, **ASIDE)
    if not np.isfinite(times).any():
        return None
    agent = int(np.argmin(times))
    return DecisiveMoment(cause=Cause.ASIDE, t=float(times[agent]), agent=agent)


def late_moment(run: Trajectories) -> DecisiveMoment:
    """Return the start of the longest stand if the robot stood long, else the slowest moment."""
    robot, t = robot_of(run), run.t
    speed = np.hypot(*robot_velocities(run, JUMP_SPEED))
    still = (speed < STANDING) & (np.abs(robot.w) < STANDING)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]])))
    starts, ends = edges[::2], np.minimum(edges[1::2], len(t) - 1)
    spans = t[ends] - t[starts]
    total = float(t[-1] - t[0])
    if len(spans) and float(spans.sum()) > _BLOCKED * total:
        k = int(np.argmax(spans))
        first = int(starts[k])
        agent = _nearest(run, first)
        return DecisiveMoment(
            cause=Cause.BLOCKED, t=float(t[first]), agent=agent, stood=float(spans[k])
        )
    return DecisiveMoment(cause=Cause.SLOW, t=float(t[-1]), agent=_nearest(run, len(t) - 1))


def _closest(run: Trajectories) -> DecisiveMoment:
    gaps = _gaps(run)
    if not np.isfinite(gaps).any():
        return DecisiveMoment(cause=Cause.ALONE, t=float(run.t[-1]))
    sample, agent = divmod(int(np.nanargmin(gaps)), gaps.shape[1])
    return DecisiveMoment(cause=Cause.CLOSE, t=float(run.t[sample]), agent=agent)


def _last_touch(contacts: PersonContacts, t: float) -> int | None:
    """Return the person who touched the robot last before a time, if it was shortly before."""
    before = (contacts.time <= t) & (contacts.time >= t - _BEFORE_ENDING)
    before &= contacts.agent >= 0
    return int(contacts.agent[np.flatnonzero(before)[-1]]) if before.any() else None


def _nearest(run: Trajectories, sample: int) -> int | None:
    row = _gaps(run)[sample]
    return int(np.nanargmin(row)) if np.isfinite(row).any() else None


def _gaps(run: Trajectories) -> Array:
    return encounter(run, JUMP_SPEED).gap
